// SPDX-License-Identifier: BSD-3-Clause
#include "server/connection.hpp"

#include <algorithm>
#include <array>
#include <boost/asio/bind_executor.hpp>
#include <boost/asio/dispatch.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <cstring>
#include <deque>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "server/byte_stream.hpp"
#include "server/web_page.hpp"

namespace tessera::server {
namespace {

namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using beast::error_code;
using boost::asio::ip::tcp;

std::string_view view_of(beast::string_view text) { return {text.data(), text.size()}; }

using HttpRequest = http::request<http::string_body>;

/// A shared body of a response.
struct SharedBody {
  using value_type = SharedBytes;
  static std::uint64_t size(const value_type& body) { return body->size(); }
  class writer {
   public:
    using const_buffers_type = boost::asio::const_buffer;
    template <bool is_request, class Fields>
    writer(const http::header<is_request, Fields>& /*header*/, const value_type& body) : body_(body) {}
    void init(error_code& error) { error = {}; }
    boost::optional<std::pair<const_buffers_type, bool>> get(error_code& error) {
      error = {};
      return {{const_buffers_type(body_->data(), body_->size()), false}};
    }

   private:
    const value_type& body_;
  };
};
using HttpResponse = http::response<SharedBody>;

Credentials credentials_of(const HttpRequest& request, std::string_view query) {
  return {view_of(request[http::field::host]),
          view_of(request[http::field::origin]),
          view_of(request[http::field::authorization]),
          view_of(request[http::field::sec_websocket_protocol]),
          query,
          view_of(request["X-Tessera-Token"])};
}

/// Splits a target into path and query.
std::pair<std::string_view, std::string_view> split_target(std::string_view target) {
  const std::size_t mark = target.find('?');
  if (mark == std::string_view::npos) return {target, {}};
  return {target.substr(0, mark), target.substr(mark + 1)};
}

/// Whether a request for the path is answered with JSON instead of a page.
bool is_api(std::string_view path) {
  return path.starts_with("api/") || path == "picture" || path == "film" || path == "socket";
}

HttpResponse make_response(const HttpRequest& request, const Response& answer) {
  HttpResponse response{static_cast<http::status>(answer.status), request.version()};
  response.set(http::field::content_type, answer.type);
  response.set(http::field::cache_control, "no-store");
  response.set("Content-Security-Policy",
               "default-src 'self'; img-src 'self' blob: data:; connect-src 'self'; frame-ancestors 'self'; "
               "base-uri 'none'; form-action 'none'");
  response.set("X-Content-Type-Options", "nosniff");
  response.set("Referrer-Policy", "no-referrer");
  if (!answer.file_name.empty())
    response.set(http::field::content_disposition, "attachment; filename=\"" + answer.file_name + "\"");
  response.keep_alive(request.keep_alive());
  response.body() = answer.body ? answer.body : std::make_shared<const std::string>();
  response.prepare_payload();
  return response;
}

Response page_response(int status, std::string text) {
  return {status, "text/html; charset=utf-8", std::make_shared<const std::string>(std::move(text))};
}

/// A client's WebSocket: passes the client's messages to the service, and queues the messages that the service sends.
class Socket final : public std::enable_shared_from_this<Socket> {
 public:
  Socket(ByteStream stream, Network& network) : stream_(std::move(stream)), network_(network) {}
  ~Socket() {
    if (client_) network_.service.leave(*client_);
    --network_.connections;
  }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  void start(HttpRequest request) {
    stream_.next_layer().tcp().expires_never();  // from now on, the WebSocket's own limits apply
    websocket::stream_base::timeout limits = websocket::stream_base::timeout::suggested(beast::role_type::server);
    limits.handshake_timeout = network_.limits.request;
    stream_.set_option(limits);
    stream_.read_message_max(network_.limits.message_bytes);
    stream_.auto_fragment(false);
    request_ = std::move(request);
    if (lists_word(view_of(request_[http::field::sec_websocket_protocol]), socket_protocol))
      stream_.set_option(websocket::stream_base::decorator([](websocket::response_type& response) {
        response.set(http::field::sec_websocket_protocol, socket_protocol.data());
      }));
    stream_.async_accept(request_, [self = shared_from_this()](error_code error) {
      if (!error) self->open();
    });
  }

  void send(std::string text, std::string head, SharedBytes image) {
    if (closed_) return;
    // Frames wait for the client's acknowledgement, so only a client that does not read has this many messages queued.
    if (messages_.size() >= network_.limits.waiting_messages) return drop();
    messages_.push_back({std::move(text), std::move(head), std::move(image)});
    if (messages_.size() == 1) write();
  }

  void close_after_writing() {
    closing_ = true;
    if (messages_.empty()) close();
  }

 private:
  struct Message {
    std::string text, head;
    SharedBytes image;
  };

  /// The service's handle of the socket; it contains a weak reference.
  class ClientChannel final : public Channel {
   public:
    explicit ClientChannel(const std::shared_ptr<Socket>& socket)
        : executor_(socket->stream_.get_executor()), socket_(socket) {}
    void send_text(std::string text) override {
      post([text = std::move(text)](Socket& socket) mutable { socket.send(std::move(text), {}, {}); });
    }
    void send_frame(std::string head, SharedBytes image) override {
      post([head = std::move(head), image = std::move(image)](Socket& socket) mutable {
        socket.send({}, std::move(head), std::move(image));
      });
    }
    void close() override {
      post([](Socket& socket) { socket.close_after_writing(); });
    }

   private:
    template <class Work>
    void post(Work work) {
      boost::asio::post(executor_, [weak = socket_, work = std::move(work)]() mutable {
        if (const auto socket = weak.lock()) work(*socket);
      });
    }
    boost::asio::any_io_executor executor_;
    std::weak_ptr<Socket> socket_;
  };

  void open() {
    client_ = network_.service.join(std::make_shared<ClientChannel>(shared_from_this()));
    read();
  }

  void read() {
    stream_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t /*bytes*/) {
      if (error) return self->drop();
      if (!self->stream_.got_text()) return self->read_next();
      // The next message is read after this one has been handled, so that each client has only one message in work.
      boost::asio::post(self->network_.parsing, [self] {
        self->network_.service.message(*self->client_, beast::buffers_to_string(self->buffer_.data()));
        boost::asio::post(self->stream_.get_executor(), [self] { self->read_next(); });
      });
    });
  }

  void read_next() {
    buffer_.consume(buffer_.size());
    if (!closed_) read();
  }

  void write() {
    const Message& message = messages_.front();
    const bool is_text = !message.image;
    stream_.text(is_text);
    ++network_.writing;
    const std::array<boost::asio::const_buffer, 2> buffers = {
        is_text ? boost::asio::buffer(message.text) : boost::asio::buffer(message.head),
        is_text ? boost::asio::const_buffer() : boost::asio::buffer(*message.image)};
    // The WebSocket's idle limit counts received data, not data that the client does not accept.
    stream_.next_layer().tcp().expires_after(2 * network_.limits.write);
    stream_.async_write(buffers, [self = shared_from_this()](error_code error, std::size_t /*bytes*/) {
      --self->network_.writing;
      self->stream_.next_layer().tcp().expires_never();
      if (error) return self->drop();
      if (self->messages_.empty()) return;
      self->messages_.pop_front();
      if (!self->messages_.empty())
        self->write();
      else if (self->closing_)
        self->close();
    });
  }

  void close() {
    if (std::exchange(closed_, true)) return;
    stream_.async_close(websocket::close_code::normal, [self = shared_from_this()](error_code /*error*/) {});
  }

  /// Closes the connection without notice, because the other side is gone or does not read.
  void drop() {
    closed_ = true;
    stream_.next_layer().tcp().close();
  }

  websocket::stream<ByteStream> stream_;
  Network& network_;
  HttpRequest request_;
  std::optional<ClientId> client_;
  beast::flat_buffer buffer_;
  std::deque<Message> messages_;
  bool closing_ = false, closed_ = false;
};

/// Handles the HTTP requests of one connection, one after the other.
class Connection final : public Stranger, public std::enable_shared_from_this<Connection> {
 public:
  Connection(ByteStream stream, Network& network)
      : stream_(std::move(stream)), network_(network), buffer_(network.limits.header_bytes + (64u << 10)) {
    if (network_.strangers.size() >= network_.limits.strangers) network_.strangers.front()->turn_away();
    stranger_ = network_.strangers.insert(network_.strangers.end(), this);
  }
  ~Connection() override {
    forget_stranger();
    if (is_client_ && !is_socket_) --network_.connections;  // a socket counts the connection itself
    gone_.request_stop();
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void turn_away() override {
    forget_stranger();
    tcp().close();
  }

  void start() {
    tcp().expires_after(network_.limits.request);
    stream_.bytes().handshake([self = shared_from_this()](error_code error) {
      if (!error) self->read();
    });
  }

 private:
  beast::tcp_stream& tcp() { return stream_.tcp(); }

  void forget_stranger() {
    if (stranger_) network_.strangers.erase(*stranger_);
    stranger_.reset();
  }

  /// Counts a connection that has sent the token. Returns false if there are too many.
  bool admit() {
    if (is_client_) return true;
    if (network_.connections >= network_.limits.connections) return false;
    forget_stranger();
    ++network_.connections;
    return is_client_ = true;
  }

  void read() {
    parser_.emplace();
    parser_->header_limit(static_cast<std::uint32_t>(network_.limits.header_bytes));
    parser_->body_limit(network_.limits.body_bytes);
    tcp().expires_after(network_.limits.request);
    http::async_read(stream_, buffer_, *parser_, [self = shared_from_this()](error_code error, std::size_t /*bytes*/) {
      if (!error) return self->answer();
      self->answer_broken(error);
    });
  }

  /// Answers a request that could not be read, if the client is still connected, and ends the connection.
  void answer_broken(const error_code& error) {
    int status = 0;
    if (error == http::error::body_limit)
      status = 413;
    else if (error == http::error::header_limit || error == http::error::buffer_overflow)
      status = 431;
    else if (error.category() == http::make_error_code(http::error::bad_method).category() &&
             error != http::error::end_of_stream && error != http::error::partial_message)
      status = 400;
    if (status == 0) return tcp().close();
    HttpRequest none;
    none.version(11);
    none.keep_alive(false);
    send(make_response(none, error_response(status, status == 413   ? "The message is too long."
                                                    : status == 431 ? "The header is too long."
                                                                    : "This is not HTTP.")));
  }

  void answer() {
    request_ = parser_->release();
    const auto [raw_path, query] = split_target(view_of(request_.target()));
    const auto path = decoded(raw_path.starts_with('/') ? raw_path.substr(1) : raw_path, false);
    if (!path || !raw_path.starts_with('/'))
      return send(make_response(request_, error_response(400, "The address cannot be read.")));
    // With two Host headers, a proxy might use the other one.
    if (request_.count(http::field::host) > 1)
      return send(make_response(request_, error_response(400, "The request has more than one Host header.")));
    const auto refused = [&](int status, const std::string& sentence) {
      send(make_response(
          request_, is_api(*path) ? error_response(status, sentence) : page_response(status, sentence_page(sentence))));
    };
    const Credentials credentials = credentials_of(request_, query);
    const auto refusal = network_.access.refusal(credentials);
    // The files of the page are public.
    if (const auto why = is_api(*path) ? refusal : network_.access.page_refusal(credentials.host))
      return refused(403, *why);
    if (!refusal && !admit()) {
      request_.keep_alive(false);
      return refused(503, "The server has reached its limit of connections; close other pages that it serves.");
    }
    if (*path == "socket" && websocket::is_upgrade(request_)) return become_socket();
    if (is_api(*path))
      return ask_service({std::string(view_of(request_.method_string())), *path, std::string(query), request_.body()});
    const WebFile* file = web_file(path->empty() ? "index.html" : std::string_view(*path));
    if (file == nullptr)
      return send(make_response(request_, page_response(404, sentence_page("There is no such page."))));
    if (request_.method() != http::verb::get && request_.method() != http::verb::head)
      return send(make_response(request_, error_response(405, "Pages are read by GET.")));
    send(make_response(request_,
                       {200, std::string(file->type),
                        std::make_shared<const std::string>(request_.method() == http::verb::head ? "" : file->text)}));
  }

  void become_socket() {
    is_socket_ = true;
    tcp().expires_never();
    std::make_shared<Socket>(std::move(stream_), network_)->start(std::move(request_));
  }

  void ask_service(Request request) {
    tcp().expires_never();
    watch_for_end();
    waiting_ = true;
    const auto executor = stream_.get_executor();
    network_.service.answer(std::move(request), gone_.get_token(),
                            [weak = weak_from_this(), executor, self = shared_from_this()](Response answer) mutable {
                              boost::asio::post(executor, [self = std::move(self), answer = std::move(answer)] {
                                self->waiting_ = false;
                                error_code none;
                                self->tcp().socket().cancel(none);  // ends the operation that detects a closed
                                                                    // connection
                                self->send(make_response(self->request_, answer));
                              });
                            });
  }

  /// Stops the work on an answer if the client disconnects.
  void watch_for_end() {
    tcp().socket().async_wait(tcp::socket::wait_read, [self = shared_from_this()](error_code error) {
      if (error || !self->waiting_) return;
      error_code unknown;
      char byte = 0;
      const std::size_t there =
          self->tcp().socket().receive(boost::asio::buffer(&byte, 1), boost::asio::socket_base::message_peek, unknown);
      if (there == 0 || unknown) self->gone_.request_stop();
    });
  }

  void send(HttpResponse response) {
    response_.emplace(std::move(response));
    serializer_.emplace(*response_);
    ++network_.writing;
    write_some();
  }

  /// Writes the response piece by piece. The time limit applies to each piece, since a long response may take long on a
  /// slow connection.
  void write_some() {
    tcp().expires_after(network_.limits.write);
    http::async_write_some(stream_, *serializer_, [self = shared_from_this()](error_code error, std::size_t /*b*/) {
      if (!error && !self->serializer_->is_done()) return self->write_some();
      --self->network_.writing;
      if (error) return self->tcp().close();
      if (!self->response_->keep_alive()) return self->end();
      self->serializer_.reset();
      self->response_.reset();
      self->read();
    });
  }

  void end() {
    error_code none;
    tcp().socket().shutdown(tcp::socket::shutdown_send, none);
    tcp().expires_after(network_.limits.request);
    pass_over(0);
  }

  /// Discards bytes that arrive after the last answer. If the connection were closed with unread bytes, a client that
  /// is still sending could lose the answer.
  void pass_over(std::size_t passed) {
    constexpr std::size_t most = 64u << 20;
    if (passed > most) return tcp().close();
    buffer_.clear();
    tcp().async_read_some(buffer_.prepare(std::min<std::size_t>(16u << 10, buffer_.max_size())),
                          [self = shared_from_this(), passed](error_code error, std::size_t bytes) {
                            if (!error) self->pass_over(passed + bytes);
                          });
  }

  ByteStream stream_;
  Network& network_;
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::string_body>> parser_;
  HttpRequest request_;
  std::optional<HttpResponse> response_;
  std::optional<http::response_serializer<SharedBody>> serializer_;
  std::stop_source gone_;
  std::optional<std::list<Stranger*>::iterator> stranger_;  ///< position of this connection in Network::strangers
  bool waiting_ = false, is_client_ = false, is_socket_ = false;
};

}  // namespace

void start_connection(std::unique_ptr<Bytes> bytes, Network& network) {
  std::make_shared<Connection>(ByteStream(std::move(bytes)), network)->start();
}

}  // namespace tessera::server
