#include <boost/beast/ssl.hpp>
#include <boost/beast/websocket/ssl.hpp>

#include "server/connection-inl.hpp"

namespace tessera::server {

void start_tls_connection(tcp::socket socket, Network& network, boost::asio::ssl::context& tls) {
  using Stream = beast::ssl_stream<beast::tcp_stream>;
  std::make_shared<Connection<Stream>>(Stream(beast::tcp_stream(std::move(socket)), tls), network)->start();
}

}  // namespace tessera::server
