// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace tessera::system {

/// Bytes of memory available without swapping. If more is used, the system kills processes instead of refusing memory.
/// The result is the largest possible number if the system does not report the value.
std::uint64_t available_memory();

}  // namespace tessera::system
