#pragma once

#include "exchange/transport.hpp"

/// A run that fails says so in one line, whichever of its ranks' processes say it: who is to speak asks first.
namespace tessera::exchange {

/// True for the first that asks, of all ranks on this machine from share_one_line() on. Before that of those that ask
/// while the first still runs, see name_one_line(); of this process if it is alone. For signal handlers too.
bool may_speak();

/// For a rank, before MPI starts: ranks of one launcher know each other by their parent. Who speaks then should last a
/// moment longer, for the others to see: hold_one_line().
void name_one_line();
/// Waits that moment, if no memory is shared yet. For signal handlers too.
void hold_one_line();

/// Collective. Returns whether this is the machine of rank 0.
bool share_one_line(Transport& transport);

}  // namespace tessera::exchange
