// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>

#include "api/state_access.hpp"
#include "exchange/transport.hpp"
#include "tessera/communicator.hpp"

namespace tessera {
inline namespace v0_1 {

/// How a Communicator exchanges messages.
struct TESSERA_HIDDEN Communicator::State {
  int rank = 0, size = 1;
  /// Returns a transport for one data set or session alone. Collective.
  std::function<std::shared_ptr<exchange::Transport>()> connect;
};

}  // namespace v0_1

namespace api {

/// A communicator over a transport that the caller owns. Everything made with it shares the transport and must be used
/// one after the other. The transport must outlive all of it.
Communicator communicator_over(exchange::Transport& transport);

}  // namespace api
}  // namespace tessera
