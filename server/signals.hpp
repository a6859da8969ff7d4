#pragma once

#include <functional>
#include <memory>

namespace tessera::server {

/// While it lives the first SIGINT or SIGTERM of this process calls `heard`, on a thread of its own.
class Signals {
 public:
  explicit Signals(std::function<void()> heard);
  ~Signals();
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tessera::server
