// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "exchange/transport.hpp"

namespace tessera::exchange {

/// Runs `work` on every rank with a transport whose errors are separate from those of `beneath`: if one rank throws an
/// error or passes it to fail(), attempt() throws this error on all ranks. Afterwards `beneath` works as if nothing had
/// been sent. Errors of `beneath` itself remain the run's errors. Collective.
///
/// How  A rank that has finished or failed sends an end message to all ranks on every channel, after all its other
///      messages, and receives until it has the end messages of all ranks. Then all ranks leave together.
void attempt(Transport& beneath, const std::function<void(Transport&)>& work);

}  // namespace tessera::exchange
