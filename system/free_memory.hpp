// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace tessera::system {

/// Bytes of memory available without swapping: beyond them the system kills processes instead of refusing memory. The
/// largest number if the system does not report it.
std::uint64_t available_memory();

}  // namespace tessera::system
