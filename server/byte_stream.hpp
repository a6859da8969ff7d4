// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <boost/asio/async_result.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/role.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/system/error_code.hpp>
#include <cstddef>
#include <functional>
#include <memory>
#include <utility>

namespace boost::asio::ssl {
class context;
}

namespace tessera::server {

/// The stream of bytes of a connection, plain or encrypted by TLS. All operations take handlers of one type, so that
/// ByteStream instantiates the large templates of Boost.Beast (HTTP, WebSocket) only once for plain and encrypted
/// streams.
///
/// Threads  The stream is only used on the network's thread. `done` is called on that thread, after the function has
///          returned.
/// Limits   tcp() contains the timer for the pending operations.
class Bytes {
 public:
  using Done = std::function<void(boost::system::error_code, std::size_t)>;
  /// Largest number of memory ranges in one operation; unused ranges are empty.
  static constexpr std::size_t most_pieces = 8;
  using ReadPieces = std::array<boost::asio::mutable_buffer, most_pieces>;
  using WritePieces = std::array<boost::asio::const_buffer, most_pieces>;

  Bytes() = default;
  Bytes(const Bytes&) = delete;
  Bytes& operator=(const Bytes&) = delete;
  virtual ~Bytes() = default;

  virtual boost::beast::tcp_stream& tcp() = 0;
  /// Must be the first operation. For a plain connection it completes at once.
  virtual void handshake(std::function<void(boost::system::error_code)> done) = 0;
  virtual void read_some(const ReadPieces& pieces, Done done) = 0;
  virtual void write_some(const WritePieces& pieces, Done done) = 0;
  /// Ends sending on this side, as a WebSocket does after its last frame.
  virtual void shut_down(std::function<void(boost::system::error_code)> done) = 0;
};

std::unique_ptr<Bytes> plain_bytes(boost::asio::ip::tcp::socket socket);
std::unique_ptr<Bytes> tls_bytes(boost::asio::ip::tcp::socket socket, boost::asio::ssl::context& tls);

/// Adapts Bytes to the AsyncReadStream and AsyncWriteStream of Boost.Asio.
class ByteStream {
 public:
  using executor_type = boost::asio::any_io_executor;
  explicit ByteStream(std::unique_ptr<Bytes> bytes) : bytes_(std::move(bytes)) {}

  executor_type get_executor() { return bytes_->tcp().get_executor(); }
  Bytes& bytes() { return *bytes_; }
  boost::beast::tcp_stream& tcp() { return bytes_->tcp(); }

  template <class Buffers, class Handler>
  auto async_read_some(const Buffers& buffers, Handler&& handler) {
    return boost::asio::async_initiate<Handler, void(boost::system::error_code, std::size_t)>(
        [](auto own, Bytes* bytes, const Bytes::ReadPieces& pieces) { bytes->read_some(pieces, held(std::move(own))); },
        handler, bytes_.get(), pieces_of<Bytes::ReadPieces>(buffers));
  }

  template <class Buffers, class Handler>
  auto async_write_some(const Buffers& buffers, Handler&& handler) {
    return boost::asio::async_initiate<Handler, void(boost::system::error_code, std::size_t)>(
        [](auto own, Bytes* bytes, const Bytes::WritePieces& pieces) {
          bytes->write_some(pieces, held(std::move(own)));
        },
        handler, bytes_.get(), pieces_of<Bytes::WritePieces>(buffers));
  }

 private:
  /// std::function copies its target, but Beast's handlers can only be moved.
  template <class Handler>
  static Bytes::Done held(Handler handler) {
    return [shared = std::make_shared<Handler>(std::move(handler))](boost::system::error_code error,
                                                                    std::size_t count) { (*shared)(error, count); };
  }

  template <class Pieces, class Buffers>
  static Pieces pieces_of(const Buffers& buffers) {
    Pieces pieces{};
    auto piece = boost::asio::buffer_sequence_begin(buffers);
    for (auto& to : pieces) {
      if (piece == boost::asio::buffer_sequence_end(buffers)) break;
      to = *piece++;
    }
    return pieces;
  }

  std::unique_ptr<Bytes> bytes_;
};

/// Called by Beast's WebSocket to end a connection in an orderly way, or when a time limit is exceeded.
template <class Handler>
void async_teardown(boost::beast::role_type /*role*/, ByteStream& stream, Handler&& handler) {
  stream.bytes().shut_down([shared = std::make_shared<std::decay_t<Handler>>(std::forward<Handler>(handler))](
                               boost::system::error_code error) { (*shared)(error); });
}
inline void beast_close_socket(ByteStream& stream) { stream.tcp().close(); }

}  // namespace tessera::server
