// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The only public header that needs MPI (component `mpi` of the package).
#include <mpi.h>

#include "tessera/communicator.hpp"

namespace tessera {
inline namespace v0_1 {

/// The processes of an MPI communicator, which must stay valid for the lifetime of everything made with it. MPI must
/// have been started with MPI_THREAD_MULTIPLE (tessera/communicator.hpp).
inline Communicator communicator(MPI_Comm mpi) { return Communicator::of_handle(static_cast<int>(MPI_Comm_c2f(mpi))); }

}  // namespace v0_1
}  // namespace tessera
