// SPDX-License-Identifier: BSD-3-Clause
#include <boost/asio/ssl/stream.hpp>

#include "server/byte_stream.hpp"

namespace tessera::server {
namespace {

using boost::asio::ip::tcp;
using boost::system::error_code;

class TlsBytes final : public Bytes {
 public:
  TlsBytes(tcp::socket socket, boost::asio::ssl::context& tls)
      : stream_(boost::beast::tcp_stream(std::move(socket)), tls) {}
  boost::beast::tcp_stream& tcp() override { return stream_.next_layer(); }
  void handshake(std::function<void(error_code)> done) override {
    stream_.async_handshake(boost::asio::ssl::stream_base::server, std::move(done));
  }
  void read_some(const ReadPieces& pieces, Done done) override { stream_.async_read_some(pieces, std::move(done)); }
  void write_some(const WritePieces& pieces, Done done) override { stream_.async_write_some(pieces, std::move(done)); }
  void shut_down(std::function<void(error_code)> done) override { stream_.async_shutdown(std::move(done)); }

 private:
  boost::asio::ssl::stream<boost::beast::tcp_stream> stream_;
};

}  // namespace

std::unique_ptr<Bytes> tls_bytes(tcp::socket socket, boost::asio::ssl::context& tls) {
  return std::make_unique<TlsBytes>(std::move(socket), tls);
}

}  // namespace tessera::server
