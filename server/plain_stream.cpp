// SPDX-License-Identifier: BSD-3-Clause
#include <boost/asio/post.hpp>
#include <boost/beast/websocket/teardown.hpp>

#include "server/byte_stream.hpp"

namespace tessera::server {
namespace {

using boost::asio::ip::tcp;
using boost::system::error_code;

class PlainBytes final : public Bytes {
 public:
  explicit PlainBytes(tcp::socket socket) : stream_(std::move(socket)) {}
  boost::beast::tcp_stream& tcp() override { return stream_; }
  void handshake(std::function<void(error_code)> done) override {
    boost::asio::post(stream_.get_executor(), [done = std::move(done)] { done({}); });
  }
  void read_some(const ReadPieces& pieces, Done done) override { stream_.async_read_some(pieces, std::move(done)); }
  void write_some(const WritePieces& pieces, Done done) override { stream_.async_write_some(pieces, std::move(done)); }
  void shut_down(std::function<void(error_code)> done) override {
    async_teardown(boost::beast::role_type::server, stream_, std::move(done));
  }

 private:
  boost::beast::tcp_stream stream_;
};

}  // namespace

std::unique_ptr<Bytes> plain_bytes(tcp::socket socket) { return std::make_unique<PlainBytes>(std::move(socket)); }

}  // namespace tessera::server
