// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "exchange/transport.hpp"

namespace tessera::exchange {

/// Restricts the kernels of every rank to the instruction sets that all ranks have. SSE4 has no fused multiply-add, so
/// results differ in bits between instruction sets, and an image must not depend on which machine rendered a tile.
/// Collective, before the first kernel runs.
void agree_instruction_sets(Transport& transport);

}  // namespace tessera::exchange
