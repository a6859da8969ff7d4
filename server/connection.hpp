// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <list>
#include <memory>

#include "server/access.hpp"
#include "server/listener.hpp"
#include "server/service.hpp"

namespace boost::asio {
class thread_pool;
}

namespace tessera::server {

class Bytes;

/// A connection that has not sent the token yet.
class Stranger {
 public:
  Stranger() = default;
  Stranger(const Stranger&) = delete;
  Stranger& operator=(const Stranger&) = delete;
  virtual ~Stranger() = default;
  /// Closes the connection without an answer and removes it from Network::strangers.
  virtual void turn_away() = 0;
};

/// State shared by all connections. Used only on the network's thread.
struct Network {
  const Access& access;
  Service& service;
  NetworkLimits limits;
  boost::asio::thread_pool& parsing;  ///< handles messages of sockets, since parsing a long message takes time
  std::size_t connections = 0;        ///< number of connections of clients that have sent the token
  std::list<Stranger*> strangers{};   ///< connections without the token, the oldest first
  std::size_t writing = 0;            ///< number of responses and messages in progress
};

/// Handles a connection until it ends: HTTP requests, one after the other, or a WebSocket.
void start_connection(std::unique_ptr<Bytes> bytes, Network& network);

}  // namespace tessera::server
