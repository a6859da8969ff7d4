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

/// Limits of a connection. Exceeding one is answered with an error if possible, and the connection is closed.
struct NetworkLimits {
  std::size_t header_bytes = 16u << 10, body_bytes = 1u << 20, message_bytes = 1u << 20;
  std::size_t connections = 256;      ///< largest number of connections of clients with the token; further connections
                                      ///< are refused
  std::size_t strangers = 64;         ///< largest number of connections without the token; a further one causes the
                                      ///< oldest to be closed
  std::size_t waiting_messages = 64;  ///< largest number of messages queued for a client that does not read
  std::chrono::milliseconds request = std::chrono::seconds(10);  ///< largest time for a whole request, including the
                                                                 ///< wait for it
  std::chrono::milliseconds write = std::chrono::seconds(30);    ///< largest time in which the other side does not
                                                                 ///< accept a byte
};

struct NetworkOptions {
  std::string address = "127.0.0.1";
  std::uint16_t port = 0;                  ///< 0: any free port
  std::filesystem::path certificate, key;  ///< files for TLS (PEM); both or none must be given
  NetworkLimits limits;
};

/// Serves HTTP and WebSockets on one port, on its own thread, from construction to destruction.
///
/// The page and its files come from server/web_page.hpp. The path `socket` is the WebSocket. All other paths are passed
/// to the service.
class Listener {
 public:
  /// Throws Error(bad_input) for an address that this machine does not have, a port in use, or a certificate that
  /// cannot be read. `service` must outlive it.
  Listener(const NetworkOptions& options, const Access& access, Service& service);
  ~Listener();
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  [[nodiscard]] std::uint16_t port() const;
  /// Accepts no more connections, and waits briefly for responses in progress.
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tessera::server
