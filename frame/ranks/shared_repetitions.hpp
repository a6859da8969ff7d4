// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exchange/transport.hpp"

namespace tessera::frame {

/// Counts the keys of this projector's range that occur several times on all projectors together. The leading bits of a
/// key determine the projector that counts the key, so that each key is counted once. Collective over the projectors;
/// returns when all keys have been received.
std::uint64_t count_shared_repetitions(exchange::Transport& transport, std::vector<std::uint64_t> keys,
                                       std::span<const int> projectors);

}  // namespace tessera::frame
