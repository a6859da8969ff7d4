// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "exchange/transport.hpp"

/// A run that fails reports it in one line, whichever of its ranks print it: each asks before it prints.
namespace tessera::exchange {

/// True for the first call: of all ranks on this machine from share_one_line() on, before that of this process. Safe in
/// signal handlers.
bool may_speak();

/// Collective. Returns whether this is the machine of rank 0.
bool share_one_line(Transport& transport);

}  // namespace tessera::exchange
