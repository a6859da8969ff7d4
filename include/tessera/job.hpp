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

/// What happens if a rank is silent because its process is stopped or its machine hangs.
struct StallSettings {
  std::chrono::milliseconds timeout = std::chrono::seconds(120);  ///< of silence, > 0
  bool ends_run = false;  ///< with an error that names the rank; otherwise the job waits
  /// Called to report a rank that the job waits for, and its return, on a thread of the job. May be empty.
  std::function<void(const std::string& words)> report;
};

/// How a job identifies itself and reports errors.
struct JobReporting {
  std::string program;  ///< prefix of its lines
  std::string remedy;   ///< advice for a run that was terminated from outside
  /// Called to report the run's error, on any thread, on one rank before any rank can end.
  std::function<void(const Error&)> report;
  /// The arguments of this rank. All ranks must have been started with the same: they are compared when the ranks first
  /// communicate, in answer_termination() or agree_instruction_sets(), which throw Error(bad_input) on all ranks if
  /// they differ.
  std::vector<std::string> arguments{};
};

/// The ranks that a launcher (mpirun, srun) started this program as, or this process alone, without MPI. For programs
/// that leave MPI to Tessera: it starts and ends MPI, once per process. Callers that have their own communicator use
/// tessera/mpi.hpp instead.
///
/// All MPI calls are made on one thread of the job. The first error of any rank is the run's error: every rank throws
/// it, and one rank reports it. A rank that cannot end in an orderly way within the next five seconds reports it too
/// and ends its process. Effect on the process: under a launcher SIGPIPE is ignored from the constructor on.
class TESSERA_EXPORT Job {
 public:
  /// Starts MPI under a launcher. Throws Error(system_failure) if MPI cannot start. If MPI itself terminates a rank
  /// during startup, only MPI and the launcher report it.
  explicit Job(JobReporting reporting);
  ~Job();
  Job(const Job&) = delete;
  Job& operator=(const Job&) = delete;

  [[nodiscard]] int rank() const;
  [[nodiscard]] int size() const;
  /// A communicator of all ranks, for data sets and sessions. They share the job's connection, so they must be created
  /// and used one after the other, in the same order on every rank.
  [[nodiscard]] Communicator communicator();

  /// Handles SIGTERM from now on: ranks that are terminated from outside report it, in one line for all ranks, and exit
  /// with ErrorCode::system_failure. A launcher terminates all ranks at once, for example after one has died: then the
  /// first one terminated on rank 0's machine reports it. A rank terminated by anything else ends the run for all, with
  /// an error. If the launcher dies, its ranks end too. Collective; does nothing for one process (Linux).
  void answer_termination();
  /// Watches for ranks that have stopped, from now on until MPI ends. Every rank calls this, with the same settings
  /// except for `report`.
  void watch_stalls(const StallSettings& settings);
  /// Restricts every rank's kernels to the instruction sets that all ranks have: bits differ between sets, and an image
  /// must not depend on which machine rendered a tile. Collective; it must precede the first kernel and applies to the
  /// whole process. It throws Error(system_failure), as does answer_termination(), on a rank whose address space is
  /// limited and which has received nothing from the others for 20 seconds: MPI starts ranks that lack the memory to
  /// send.
  void agree_instruction_sets();
  /// Broadcasts the `bytes` of rank `root` to every rank. Collective. Throws the run's error.
  std::vector<std::byte> broadcast(int root, std::vector<std::byte> bytes);

  /// Throws Error(bad_input) if ranks have so far read different files under one name; the files of a data set are
  /// compared when it is opened. Collective.
  void require_same_files();

  /// Runs `work` on all ranks with a communicator that is valid while it runs, for example to open a data set. An error
  /// of one rank is thrown on all of them and, unlike any other error, leaves the job usable. Collective.
  void attempt(const std::function<void(const Communicator&)>& work);

  /// Ends the run for all ranks with this error, unless there was an earlier one.
  void fail(const Error& error);
  /// Ends every rank's part, also after an error: waits for all ranks and shuts MPI down. Returns the run's error, if
  /// any; it is the same on all ranks, and one rank has reported it.
  std::optional<Error> finish();

  /// Writes a line to stderr unless one was already written: by any rank on this machine since answer_termination(),
  /// before that by this process. May be called from any thread.
  static void print_once(const std::string& line);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace v0_1
}  // namespace tessera
