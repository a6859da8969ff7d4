// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>

#include "api/state_access.hpp"
#include "exchange/transport.hpp"
#include "tessera/communicator.hpp"

namespace tessera {
inline namespace v0_1 {

/// How a Communicator becomes messages.
struct TESSERA_HIDDEN Communicator::State {
  int rank = 0, size = 1;
  /// A transport for one data set or session alone. Collective.
  std::function<std::shared_ptr<exchange::Transport>()> connect;
};

}  // namespace v0_1

namespace api {

/// Ranks of a transport that somebody else has: everything made with it shares it, one after the other. It must outlive
/// them.
Communicator communicator_over(exchange::Transport& transport);

}  // namespace api
}  // namespace tessera
