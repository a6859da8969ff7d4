#include "server/signals.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <csignal>
#include <thread>
#include <utility>

namespace tessera::server {

struct Signals::State {
  explicit State(std::function<void()> heard_) : heard(std::move(heard_)) {
    signals.async_wait([this](const boost::system::error_code& error, int /*signal*/) {
      if (!error) heard();
    });
    thread = std::thread([this] { io.run(); });
  }
  ~State() {
    io.stop();
    thread.join();
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  std::function<void()> heard;
  boost::asio::io_context io{1};
  boost::asio::signal_set signals{io, SIGINT, SIGTERM};
  std::thread thread;
};

Signals::Signals(std::function<void()> heard) : state_(std::make_unique<State>(std::move(heard))) {}
Signals::~Signals() = default;

}  // namespace tessera::server
