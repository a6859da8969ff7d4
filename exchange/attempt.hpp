// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "exchange/transport.hpp"

namespace tessera::exchange {

/// Runs `work` on every rank with a transport whose errors are its own: what one rank throws or fail()s with is thrown
/// here on all of them, the same everywhere, and the transport beneath can be used on, as if nothing had been sent. An
/// error of the transport beneath stays the run's. Collective.
///
/// How  a rank that is through, well or not, says so to all on every channel, behind all that it has sent, and takes
///      what there is until all have said so; then they leave together.
void attempt(Transport& beneath, const std::function<void(Transport&)>& work);

}  // namespace tessera::exchange
