// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tessera/communicator.hpp"
#include "tessera/error.hpp"
#include "tessera/export.hpp"

namespace tessera {
inline namespace v0_1 {

/// What is done about a rank that is silent: its process is stopped, or its machine hangs.
struct StallSettings {
  std::chrono::milliseconds timeout = std::chrono::seconds(120);  ///< of silence, more than 0
  bool ends_run = false;  ///< by an error that names the rank; else it is waited for
  /// Tells the user of a rank that is waited for, and of its return; from a thread of the job's own. May be empty.
  std::function<void(const std::string& words)> say;
};

/// What a job says of itself, and where its errors go.
struct JobVoice {
  std::string program;  ///< lines begin with it
  std::string remedy;   ///< of a run that was ended from outside: what to do
  /// Tells the user of the run's error, from any thread, on one rank before any rank can end.
  std::function<void(const Error&)> speak;
  /// All ranks must have been started with the same: compared as they first meet, in answer_termination() or
  /// agree_instruction_sets(), which throw Error(bad_input) on all ranks if they differ.
  std::vector<std::string> arguments{};
};

/// The ranks that a launcher (mpirun, srun) started this program as, or this process alone, without MPI. For programs
/// that leave MPI to Tessera: it starts and ends MPI, once a process. Who has a communicator of its own takes
/// tessera/mpi.hpp instead.
///
/// One thread of the job's own speaks MPI. The first error of a rank is the run's: every rank throws it, and one tells
/// the user. A rank that cannot end in an orderly way within five seconds after that speaks and ends its process. What
/// a job does to its process: under a launcher SIGPIPE is ignored from the beginning.
class TESSERA_EXPORT Job {
 public:
  /// Starts MPI under a launcher. Throws Error(system_failure) if MPI cannot start; a rank that MPI ends as it starts
  /// is reported by MPI and the launcher alone.
  explicit Job(JobVoice voice);
  ~Job();
  Job(const Job&) = delete;
  Job& operator=(const Job&) = delete;

  [[nodiscard]] int rank() const;
  [[nodiscard]] int size() const;
  /// Of all ranks, for data sets and sessions. They share the job's connection, so they are made and used one after the
  /// other, in the same order on every rank.
  [[nodiscard]] Communicator communicator();

  /// From now on SIGTERM is answered: ranks that are ended from outside say so, in one line of all ranks, and end with
  /// the status ErrorCode::system_failure. The launcher ends all ranks at once, as it does when one has died: then the
  /// first that is ended on rank 0's machine speaks. A rank that anybody else ends ends the run for all, by an error. A
  /// launcher that dies takes its ranks with it. Collective; does nothing for one process (Linux).
  void answer_termination();
  /// Looks for ranks that have stopped, from now on until MPI ends. Every rank calls this, with the same settings but
  /// for `say`.
  void watch_stalls(const StallSettings& settings);
  /// Restricts every rank's kernels to the instruction sets that all ranks have, as bits differ between sets and a
  /// picture must not depend on which machine made a tile. Collective, before the first kernel runs; of the process.
  /// Throws Error(system_failure), as does answer_termination(), on a rank whose address space is limited and which has
  /// heard nothing of the others for 20 seconds: MPI starts ranks that lack the memory to send.
  void agree_instruction_sets();
  /// `bytes` of rank `root`, on every rank. Collective. Throws the run's error.
  std::vector<std::byte> broadcast(int root, std::vector<std::byte> bytes);

  /// Throws Error(bad_input) if ranks have read different files under one name so far; a data set's own are compared as
  /// it is opened. Collective.
  void require_same_files();

  /// Runs `work` on all ranks with a communicator that holds for as long as it runs, such as for opening a data set. An
  /// error of one rank is thrown on all of them and, unlike any other, leaves the job usable. Collective.
  void attempt(const std::function<void(const Communicator&)>& work);

  /// Ends the run for all ranks with this error, unless another came first.
  void fail(const Error& error);
  /// The end of every rank's part, after an error too: waits until all ranks are here and shuts MPI down. Returns the
  /// run's error, the same on all ranks, if there is one; one rank has spoken.
  std::optional<Error> finish();

  /// Writes a line to stderr, unless one was written before: by any rank on this machine from answer_termination() on,
  /// before that by this process. From any thread.
  static void say_once(const std::string& line);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace v0_1
}  // namespace tessera
