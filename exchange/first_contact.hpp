// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "exchange/transport.hpp"

/// Open MPI starts a rank even where it has found no memory for what it sends by, and then messages never arrive.
namespace tessera::exchange {

/// What to do where a rank lacks memory: names the limit of address space if there is one.
std::string memory_remedy();

/// Collective, before all else. Returns when rank 0 has heard of all others and each of them of rank 0, twice. Throws
/// Error(system_failure) on a rank that has not within `patience`; 0 waits for ever. Throws Error(bad_input) on rank 0
/// if another was started with other `arguments`: ranks that do different things would wait for one another for ever.
void make_first_contact(Transport& transport, std::chrono::milliseconds patience,
                        const std::vector<std::string>& arguments = {});

/// How long a rank of this process's limits should wait: for ever, unless its address space is limited.
std::chrono::milliseconds first_contact_patience();

}  // namespace tessera::exchange
