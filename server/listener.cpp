// SPDX-License-Identifier: BSD-3-Clause
#include "server/listener.hpp"

#include <fmt/format.h>

#include <atomic>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/thread_pool.hpp>
#include <thread>

#include "server/byte_stream.hpp"
#include "server/connection.hpp"
#include "server/tls.hpp"
#include "tessera/error.hpp"

namespace tessera::server {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

struct Listener::State {
  State(const NetworkOptions& options, const Access& access, Service& service)
      : network{access, service, options.limits, parsing} {
    if (!options.certificate.empty()) tls = tls_context(options.certificate, options.key);
    listen_at(options.address, options.port);
    accept();
    thread = std::thread([this] { io.run(); });
  }

  ~State() {
    io.stop();
    thread.join();
    parsing.stop();
    parsing.join();
  }

  State(const State&) = delete;
  State& operator=(const State&) = delete;

  void listen_at(const std::string& address, std::uint16_t port) {
    error_code error;
    const auto ip = asio::ip::make_address(address, error);
    if (error)
      throw bad_input(fmt::format("--bind: '{}' is not an address; write one like 127.0.0.1 or 0.0.0.0", address));
    const tcp::endpoint endpoint(ip, port);
    acceptor.open(endpoint.protocol(), error);
    if (!error) acceptor.set_option(asio::socket_base::reuse_address(true), error);
    if (!error) acceptor.bind(endpoint, error);
    if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
    if (!error) return;
    if (error == asio::error::address_in_use)
      throw bad_input(
          fmt::format("--port: {} is in use; choose another port, or leave --port out to get a free one", port));
    if (error == asio::error::access_denied)
      throw bad_input(
          fmt::format("--port: {} needs privileges that this process does not have; name one above 1023", port));
    throw bad_input(fmt::format("--bind: {} is not an address to listen at ({}); name one of this machine", address,
                                error.message()));
  }

  void accept() {
    acceptor.async_accept([this](error_code error, tcp::socket socket) {
      if (!acceptor.is_open()) return;
      if (error) {  // probably there are no more file descriptors: try again later
        pause.expires_after(std::chrono::milliseconds(100));
        pause.async_wait([this](error_code stopped) {
          if (!stopped) accept();
        });
        return;
      }
      error_code none;
      socket.set_option(tcp::no_delay(true), none);
      start_connection(tls ? tls_bytes(std::move(socket), *tls) : plain_bytes(std::move(socket)), network);
      accept();
    });
  }

  Network network;  // must outlive the connections, which end with `io`
  asio::io_context io{1};
  asio::thread_pool parsing{1};  // must be destroyed before `io`, because its work uses sockets of `io`
  asio::executor_work_guard<asio::io_context::executor_type> until_stopped{io.get_executor()};
  std::shared_ptr<asio::ssl::context> tls;
  tcp::acceptor acceptor{io};
  asio::steady_timer pause{io};
  std::thread thread;
};

Listener::Listener(const NetworkOptions& options, const Access& access, Service& service)
    : state_(std::make_unique<State>(options, access, service)) {}

Listener::~Listener() = default;

std::uint16_t Listener::port() const { return state_->acceptor.local_endpoint().port(); }

void Listener::finish() {
  asio::post(state_->io, [this] {
    error_code ignored;
    state_->acceptor.close(ignored);
  });
  for (int i = 0; i < 50; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    std::atomic<bool> asked = false, quiet = false;
    asio::post(state_->io, [&] {
      quiet = state_->network.writing == 0;
      asked = true;
      asked.notify_one();
    });
    asked.wait(false);
    if (quiet) return;
  }
}

}  // namespace tessera::server
