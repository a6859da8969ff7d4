// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exchange/transport.hpp"

namespace tessera::frame {

/// How many of the keys that this projector looks at are there several times: of all projectors' those that begin
/// alike, so that each is looked at by one. Collective over the
/// projectors; returns when all keys have come.
std::uint64_t count_shared_repetitions(exchange::Transport& transport, std::vector<std::uint64_t> keys,
                                       std::span<const int> projectors, int threads);

}  // namespace tessera::frame
