// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "exchange/transport.hpp"

namespace tessera::frame {

enum class Reduction { sum, bit_or, minimum };

/// Reduces the values of all ranks element by element and returns the result on every rank. Collective (channel
/// `agreement`). All ranks must pass the same number of values, fewer than 2^27.
std::vector<std::uint64_t> reduce_all(exchange::Transport& transport, std::vector<std::uint64_t> values,
                                      Reduction reduction);

}  // namespace tessera::frame
