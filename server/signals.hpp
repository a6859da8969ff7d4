// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>

namespace tessera::server {

/// While it exists, the first SIGINT, SIGTERM or SIGHUP of this process calls `first`, any further one `again` with its
/// number, on its own thread. A SIGHUP that the caller ignores (nohup) stays ignored.
class Signals {
 public:
  Signals(std::function<void()> first, std::function<void(int signal)> again);
  ~Signals();
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tessera::server
