// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "exchange/transport.hpp"

/// Detects ranks that cannot send. Open MPI starts a rank even if the rank has no memory for sending; its messages then
/// never arrive.
namespace tessera::exchange {

/// The advice that an error message gives for a rank that lacks memory. It names the limit of the address space if
/// there is one.
std::string memory_remedy();

/// Checks that all ranks can communicate. Collective, before all other communication. Returns when rank 0 has received
/// messages from all other ranks and each of them from rank 0, twice. Throws Error(system_failure) on a rank that has
/// not received them within `patience`; 0 waits forever. Throws Error(bad_input) on rank 0 if another rank was started
/// with other `arguments`: ranks that do different things would wait for one another forever.
void make_first_contact(Transport& transport, std::chrono::milliseconds patience,
                        const std::vector<std::string>& arguments = {});

/// The `patience` for a rank with the limits of this process: 0 (forever), unless its address space is limited.
std::chrono::milliseconds first_contact_patience();

}  // namespace tessera::exchange
