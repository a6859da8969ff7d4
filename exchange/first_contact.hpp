// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "exchange/transport.hpp"

/// Open MPI starts a rank even if it has no memory for sending; its messages then never arrive.
namespace tessera::exchange {

/// The remedy for a rank that lacks memory: names the limit of its address space if there is one.
std::string memory_remedy();

/// Collective, before all other communication. Returns when rank 0 has received messages from all other ranks and each
/// of them from rank 0, twice. Throws Error(system_failure) on a rank that has not received them within `patience`; 0
/// waits forever. Throws Error(bad_input) on rank 0 if another rank was started with other `arguments`: ranks that do
/// different things would wait for one another forever.
void make_first_contact(Transport& transport, std::chrono::milliseconds patience,
                        const std::vector<std::string>& arguments = {});

/// How long a rank with the limits of this process should wait: forever, unless its address space is limited.
std::chrono::milliseconds first_contact_patience();

}  // namespace tessera::exchange
