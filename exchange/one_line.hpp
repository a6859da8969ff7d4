// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "exchange/transport.hpp"

/// Ensures that a run that fails reports its error in one line, on whichever rank: each rank calls may_speak() before
/// it prints.
namespace tessera::exchange {

/// Returns true only for the first call: after share_one_line(), the first on this machine; before, the first in this
/// process. Safe in signal handlers.
bool may_speak();

/// Shares the flag of may_speak() among the ranks of each machine. Collective. Returns whether this is the machine of
/// rank 0.
bool share_one_line(Transport& transport);

}  // namespace tessera::exchange
