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
  /// Returns a transport that only one data set or session uses. Collective.
  std::function<std::shared_ptr<exchange::Transport>()> connect;
};

}  // namespace v0_1

namespace api {

/// Returns a communicator that uses a transport owned by the caller. All objects made with the communicator share the
/// transport, so they must be used one after the other. The transport must outlive all of them.
Communicator communicator_over(exchange::Transport& transport);

}  // namespace api
}  // namespace tessera
