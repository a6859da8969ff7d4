// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// No other public header requires MPI. Programs that include it use the package's component `mpi`.
#include <mpi.h>

#include "tessera/communicator.hpp"

namespace tessera {
inline namespace v0_1 {

/// Returns a Communicator of the processes of an MPI communicator. The MPI communicator must stay valid as long as any
/// object made with the result exists. MPI must have been started with MPI_THREAD_MULTIPLE (tessera/communicator.hpp).
inline Communicator communicator(MPI_Comm mpi) { return Communicator::of_handle(static_cast<int>(MPI_Comm_c2f(mpi))); }

}  // namespace v0_1
}  // namespace tessera
