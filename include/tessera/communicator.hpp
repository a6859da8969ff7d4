// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>

#include "tessera/export.hpp"

namespace tessera {
inline namespace v0_1 {

/// The processes (ranks, numbered from 0) that work together on one data set or frame: this process alone, or the
/// processes of an MPI communicator (tessera/mpi.hpp makes a Communicator from an MPI_Comm).
///
/// Sessions and data sets duplicate the communicator they receive, so that their messages are separate from those of
/// the caller and of other sessions. They neither start nor end MPI. They call MPI on a separate thread, possibly while
/// the caller's threads call MPI too. The caller must therefore start MPI with MPI_THREAD_MULTIPLE; a lower level
/// causes an Error. A single process needs no MPI at all.
class TESSERA_EXPORT Communicator {
 public:
  /// This process alone.
  Communicator();
  /// Makes a Communicator from the Fortran handle (MPI_Comm_c2f) of an MPI communicator. Throws Error(bad_input) if MPI
  /// has not been initialised, and Error(system_failure) in a build without MPI. Sessions and data sets of more than
  /// one rank throw Error(bad_input) if MPI was started without MPI_THREAD_MULTIPLE.
  static Communicator of_handle(int fortran_handle);

  [[nodiscard]] int rank() const;
  [[nodiscard]] int size() const;

  struct State;  ///< incomplete for callers

 private:
  friend struct StateAccess;
  explicit Communicator(std::shared_ptr<const State> state) : state_(std::move(state)) {}

  std::shared_ptr<const State> state_;
};

/// Runs a parallel job without MPI: calls `work` once per rank, each on its own thread, with a communicator of these
/// threads, and returns when all calls have returned. An exception on one rank ends the run for all ranks. The function
/// throws the first error.
TESSERA_EXPORT void run_ranks(int ranks, const std::function<void(const Communicator&)>& work);

}  // namespace v0_1
}  // namespace tessera
