// SPDX-License-Identifier: BSD-3-Clause
#include "server/signals.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <csignal>
#include <thread>
#include <utility>

namespace tessera::server {

struct Signals::State {
  State(std::function<void()> first_, std::function<void(int)> again_)
      : first(std::move(first_)), again(std::move(again_)) {
    struct sigaction present {};
    if (::sigaction(SIGHUP, nullptr, &present) == 0 && present.sa_handler != SIG_IGN) signals.add(SIGHUP);
    signals.async_wait([this](const boost::system::error_code& error, int /*signal*/) {
      if (error) return;
      wait_for_another();
      first();
    });
    thread = std::thread([this] { io.run(); });
  }
  ~State() {
    io.stop();
    thread.join();
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  void wait_for_another() {
    signals.async_wait([this](const boost::system::error_code& error, int signal) {
      if (error) return;
      wait_for_another();
      again(signal);
    });
  }

  std::function<void()> first;
  std::function<void(int)> again;
  boost::asio::io_context io{1};
  boost::asio::signal_set signals{io, SIGINT, SIGTERM};
  std::thread thread;
};

Signals::Signals(std::function<void()> first, std::function<void(int)> again)
    : state_(std::make_unique<State>(std::move(first), std::move(again))) {}
Signals::~Signals() = default;

}  // namespace tessera::server
