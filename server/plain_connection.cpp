#include "server/connection-inl.hpp"

namespace tessera::server {

void start_plain_connection(tcp::socket socket, Network& network) {
  std::make_shared<Connection<beast::tcp_stream>>(beast::tcp_stream(std::move(socket)), network)->start();
}

}  // namespace tessera::server
