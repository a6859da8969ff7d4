// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "exchange/transport.hpp"

/// A run that fails reports its error in one line, on whichever rank: each asks here before it prints.
namespace tessera::exchange {

/// True for the first call: after share_one_line(), among all ranks on this machine; before, in this process. Safe in
/// signal handlers.
bool may_speak();

/// Collective. Returns whether this is the machine of rank 0.
bool share_one_line(Transport& transport);

}  // namespace tessera::exchange
