// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>

/// The interface between network and rendering: requests and clients as values, independent of sockets.
namespace tessera::server {

/// Bytes shared without copies.
using SharedBytes = std::shared_ptr<const std::string>;

/// An HTTP request that passed the access checks.
struct Request {
  std::string method;  ///< "GET", "POST"
  std::string path;    ///< decoded, without the first slash: "api/data"
  std::string query;   ///< the text after the question mark, as received
  std::string body;
};

struct Response {
  int status = 200;
  std::string type = "application/json";
  SharedBytes body;
  std::string file_name{};  ///< name for saving the response; empty: the browser displays it
};

/// Makes a response whose body is `{"error": sentence}`.
Response error_response(int status, const std::string& sentence);

/// Sends messages to one client. May be called from any thread. Does nothing after the client has disconnected.
class Channel {
 public:
  virtual ~Channel() = default;
  Channel() = default;
  Channel(const Channel&) = delete;
  Channel& operator=(const Channel&) = delete;

  virtual void send_text(std::string text) = 0;
  /// Sends `head` and then `image` in one binary message.
  virtual void send_frame(std::string head, SharedBytes image) = 0;
  /// Closes the connection after everything has been sent.
  virtual void close() = 0;
};

using ClientId = std::uint64_t;

/// Answers requests. The network calls all functions except message() from one thread, so they must be fast.
class Service {
 public:
  using Reply = std::function<void(Response)>;

  virtual ~Service() = default;
  Service() = default;
  Service(const Service&) = delete;
  Service& operator=(const Service&) = delete;

  /// Answers a request by calling `reply` once, from any thread. `gone` requests a stop when the client no longer
  /// waits.
  virtual void answer(Request request, std::stop_token gone, Reply reply) = 0;

  virtual ClientId join(std::shared_ptr<Channel> channel) = 0;
  /// Receives a text message of a client. Called on another thread than the other functions, one after the other for
  /// the messages of a client.
  virtual void message(ClientId client, const std::string& text) = 0;
  virtual void leave(ClientId client) = 0;
};

}  // namespace tessera::server
