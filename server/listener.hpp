// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "server/access.hpp"
#include "server/service.hpp"

namespace tessera::server {

/// What a connection may take. Whoever is over a limit is answered with an error where that is possible, and closed.
struct NetworkLimits {
  std::size_t header_bytes = 16u << 10, body_bytes = 1u << 20, message_bytes = 1u << 20;
  std::size_t connections = 256;                                 ///< of clients with the token; more are refused
  std::size_t strangers = 64;                                    ///< without it; for one more the oldest is closed
  std::size_t waiting_messages = 64;                             ///< of a client that does not read
  std::chrono::milliseconds request = std::chrono::seconds(10);  ///< for a whole request, from the first wait for it on
  std::chrono::milliseconds write = std::chrono::seconds(30);    ///< without a byte that the other side takes
};

struct NetworkOptions {
  std::string address = "127.0.0.1";
  std::uint16_t port = 0;                  ///< 0: a free one
  std::filesystem::path certificate, key;  ///< PEM, for TLS; both or none
  NetworkLimits limits;
};

/// HTTP and WebSocket on one port, on one thread of its own, from construction to destruction.
///
/// The page and what it loads come from server/web_page.hpp, `socket` is the WebSocket, all else the service's.
class Listener {
 public:
  /// Throws Error(bad_input) for an address that is none of this machine's, a port that is taken, a certificate that
  /// cannot be read. `service` must outlive it.
  Listener(const NetworkOptions& options, const Access& access, Service& service);
  ~Listener();
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  [[nodiscard]] std::uint16_t port() const;
  /// Takes no more connections, and waits a moment for what is being written.
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tessera::server
