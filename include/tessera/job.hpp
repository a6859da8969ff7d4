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

/// What happens if a rank no longer communicates because its process is stopped or its machine hangs.
struct StallSettings {
  std::chrono::milliseconds timeout = std::chrono::seconds(120);  ///< longest time without communication, > 0
  bool ends_run = false;  ///< true: an error that names the rank ends the run; false: the job waits
  /// Called on a thread of the job to report that the job waits for a rank, and later to report that this rank
  /// communicates again. May be empty.
  std::function<void(const std::string& words)> report;
};

/// How a job identifies itself and reports errors.
struct JobReporting {
  std::string program;  ///< name of the program; prefix of its messages
  std::string remedy;   ///< advice printed if the run was terminated from outside
  /// Called on one rank, on any thread, to report the run's error. It is called before any rank can end.
  std::function<void(const Error&)> report;
  /// The arguments of this rank. All ranks must have been started with the same arguments. They are compared when the
  /// ranks first communicate, in answer_termination() or agree_instruction_sets(); if they differ, these functions
  /// throw Error(bad_input) on all ranks.
  std::vector<std::string> arguments{};
};

/// The ranks of this program if a launcher (mpirun, srun) started it; otherwise this process alone, without MPI. The
/// class is for programs that leave MPI to Tessera: a Job starts and ends MPI, once per process. Callers that have
/// their own communicator use tessera/mpi.hpp instead.
///
/// All MPI calls are made on one thread of the job. The first error of any rank is the run's error: every rank throws
/// it, and one rank reports it. A rank that cannot shut down in an orderly way within the next five seconds reports the
/// error too and ends its process. Under a launcher, the constructor makes the process ignore SIGPIPE.
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
  /// A communicator of all ranks, for data sets and sessions. Data sets and sessions share the job's connection, so
  /// they must be created and used one after the other, in the same order on every rank.
  [[nodiscard]] Communicator communicator();

  /// Handles SIGTERM from now on: ranks that are terminated from outside report this, in one line for all ranks, and
  /// exit with ErrorCode::system_failure. If the launcher terminates all ranks at once, for example after one has died,
  /// the rank on rank 0's machine that receives the signal first reports it. If something else terminates a rank, the
  /// run ends with an error on all ranks. If the launcher dies, its ranks end too. Collective; does nothing for one
  /// process. Linux only.
  void answer_termination();
  /// Watches for ranks that have stopped, from now on until MPI ends. Every rank must call this function, with the same
  /// settings except for `report`.
  void watch_stalls(const StallSettings& settings);
  /// Restricts every rank's kernels to the instruction sets that all ranks support. Results differ in some bits between
  /// instruction sets, and an image must not depend on which machine rendered a tile. Collective. The function must be
  /// called before the first kernel runs and affects the whole process. Like answer_termination(), it throws
  /// Error(system_failure) on a rank whose address space is limited and which has received nothing from the other ranks
  /// for 20 seconds, because MPI also starts ranks that do not have enough memory to send.
  void agree_instruction_sets();
  /// Broadcasts the `bytes` of rank `root` to every rank. Collective. Throws the run's error.
  std::vector<std::byte> broadcast(int root, std::vector<std::byte> bytes);

  /// Throws Error(bad_input) if ranks have read different files under the same name so far. The files of a data set are
  /// compared when the data set is opened. Collective.
  void require_same_files();

  /// Runs `work` on all ranks, for example to open a data set, with a communicator that is valid while `work` runs. An
  /// error on one rank is thrown on all ranks. Unlike any other error, it leaves the job usable. Collective.
  void attempt(const std::function<void(const Communicator&)>& work);

  /// Ends the run for all ranks with this error, unless the run already has an error.
  void fail(const Error& error);
  /// Ends the job, also after an error: waits for all ranks and shuts MPI down. Every rank calls this function. Returns
  /// the run's error, if any, which is the same on all ranks and has been reported by one of them.
  std::optional<Error> finish();

  /// Writes a line to stderr unless this function has already written a line. If answer_termination() has been called,
  /// the lines of all ranks of this machine count, otherwise only those of this process. May be called from any thread.
  static void print_once(const std::string& line);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace v0_1
}  // namespace tessera
