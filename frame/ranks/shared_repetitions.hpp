// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exchange/transport.hpp"

namespace tessera::frame {

/// How many keys of this projector's range occur several times on all projectors together. The leading bits of a key
/// determine its projector, so that each key is counted by one. Collective over the projectors; returns when all keys
/// have been received.
std::uint64_t count_shared_repetitions(exchange::Transport& transport, std::vector<std::uint64_t> keys,
                                       std::span<const int> projectors);

}  // namespace tessera::frame
