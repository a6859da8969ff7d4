// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>

#include "tessera/export.hpp"

namespace tessera {
inline namespace v0_1 {

/// The processes that work on one data set or frame together, numbered from 0: this process alone, or those of an MPI
/// communicator (tessera/mpi.hpp makes one from an MPI_Comm).
///
/// Sessions and data sets duplicate the communicator they receive, so that their messages are separate from those of
/// the caller and of other sessions. They neither start nor end MPI. A thread of their own calls MPI while the caller's
/// threads may do so too, so the caller must start MPI with MPI_THREAD_MULTIPLE; a lower level is an Error. A single
/// process needs no MPI at all.
class TESSERA_EXPORT Communicator {
 public:
  /// This process alone.
  Communicator();
  /// From an MPI communicator, by its Fortran handle (MPI_Comm_c2f). Throws Error(bad_input) if MPI has not been
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

/// Runs `work` once per rank, each on its own thread, with a communicator of these threads, and returns when all have
/// returned: a parallel job without MPI. An exception on one rank ends the run for all ranks; the first error is thrown
/// here.
TESSERA_EXPORT void run_ranks(int ranks, const std::function<void(const Communicator&)>& work);

}  // namespace v0_1
}  // namespace tessera
