// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>

namespace tessera::server {

/// While an object of this class exists, the first SIGINT, SIGTERM or SIGHUP of this process calls `first`, and any
/// further signal calls `again` with its number, both on a separate thread. If the caller ignores SIGHUP (nohup), it
/// remains ignored.
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
