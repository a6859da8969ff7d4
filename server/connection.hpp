#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <set>

#include "server/access.hpp"
#include "server/listener.hpp"
#include "server/service.hpp"

namespace tessera::server {

class Bytes;

/// What all connections share. Of the network's thread alone.
struct Network {
  const Access& access;
  Service& service;
  NetworkLimits limits;
  bool secure = false;
  std::size_t connections = 0;
  std::size_t writing = 0;  ///< responses and messages that are on their way
};

/// Takes care of a connection until it ends: HTTP requests one after the other, or a WebSocket.
void start_connection(std::unique_ptr<Bytes> bytes, Network& network);

}  // namespace tessera::server
