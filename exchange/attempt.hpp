// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "exchange/transport.hpp"

namespace tessera::exchange {

/// Runs `work` on every rank with a transport that has errors of its own: an error that one rank throws or passes to
/// fail() is thrown here on all ranks, the same one everywhere. Afterwards the underlying transport works as if nothing
/// had been sent. Errors of the underlying transport remain the run's errors. Collective.
///
/// How  A rank that has finished or failed sends an end to all ranks on every channel, behind all its other messages,
///      and receives until it has the ends of all ranks. Then all ranks leave together.
void attempt(Transport& beneath, const std::function<void(Transport&)>& work);

}  // namespace tessera::exchange
