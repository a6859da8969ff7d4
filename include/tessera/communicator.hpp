// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>

#include "tessera/export.hpp"

namespace tessera {
inline namespace v0_1 {

/// The processes that work on one data set or picture together, numbered from 0: this process alone, or those of an MPI
/// communicator (tessera/mpi.hpp makes it from an MPI_Comm).
///
/// What is given a communicator duplicates it, so that its messages never meet the caller's or another session's, and
/// leaves MPI itself alone: it neither starts nor ends it. Its own thread speaks MPI while the caller's threads may, so
/// the caller starts MPI with MPI_THREAD_MULTIPLE; anything less is an Error. Of one process no MPI is needed at all.
class TESSERA_EXPORT Communicator {
 public:
  /// This process alone.
  Communicator();
  /// Of an MPI communicator by its Fortran handle (MPI_Comm_c2f). Throws Error(bad_input) if MPI has not been
  /// initialised; Error(system_failure) in a build without MPI. Sessions and data sets of more than one rank throw
  /// Error(bad_input) without MPI_THREAD_MULTIPLE.
  static Communicator of_handle(int fortran_handle);

  [[nodiscard]] int rank() const;
  [[nodiscard]] int size() const;

  struct State;  ///< incomplete for callers

 private:
  friend struct StateAccess;
  explicit Communicator(std::shared_ptr<const State> state) : state_(std::move(state)) {}

  std::shared_ptr<const State> state_;
};

/// Runs `work` once a rank, each on a thread of its own, with a communicator of these threads, and returns when all
/// have: a job's shape without MPI. An exception of one rank ends the run for all; the run's one error is thrown here.
TESSERA_EXPORT void run_ranks(int ranks, const std::function<void(const Communicator&)>& work);

}  // namespace v0_1
}  // namespace tessera
