// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace tessera::system {

/// Bytes of memory that can be had without swapping: past it the system ends processes instead of refusing. The largest
/// number where the system does not say.
std::uint64_t available_memory();

}  // namespace tessera::system
