// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <span>

namespace tessera::system {

/// Receives bytes in order, in pieces of any size.
using ByteSink = std::function<void(std::span<const std::byte>)>;

}  // namespace tessera::system
