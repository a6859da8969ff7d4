// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "exchange/transport.hpp"

namespace tessera::frame {

enum class Reduction { sum, bit_or, minimum };

/// Reduces element by element over all ranks; the result is on every rank. Collective (channel `agreement`); the same
/// length on every rank, fewer than 2^27 numbers.
std::vector<std::uint64_t> reduce_all(exchange::Transport& transport, std::vector<std::uint64_t> values,
                                      Reduction reduction);

}  // namespace tessera::frame
