// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>

/// Between the network and who renders: requests and clients as values, with no word of sockets.
namespace tessera::server {

/// Bytes that several may hold, without copies.
using SharedBytes = std::shared_ptr<const std::string>;

/// An HTTP request that may be answered: who sent it has the token.
struct Request {
  std::string method;  ///< "GET", "POST"
  std::string path;    ///< decoded, without the first slash: "api/data"
  std::string query;   ///< what follows the question mark, as it came
  std::string body;
};

struct Response {
  int status = 200;
  std::string type = "application/json";
  SharedBytes body;
  std::string file_name{};  ///< to be saved under; empty: to be shown
};

/// `{"error": sentence}`
Response error_response(int status, const std::string& sentence);

/// Where what is for one client goes. From any thread; once it has left, into nothing.
class Channel {
 public:
  virtual ~Channel() = default;
  Channel() = default;
  Channel(const Channel&) = delete;
  Channel& operator=(const Channel&) = delete;

  virtual void send_text(std::string text) = 0;
  /// `head` and then `image` in one binary message.
  virtual void send_frame(std::string head, SharedBytes image) = 0;
  /// After what has been sent.
  virtual void close() = 0;
};

using ClientId = std::uint64_t;

/// Who answers. The network calls it from one thread, so every call but message() has to be quick.
class Service {
 public:
  using Reply = std::function<void(Response)>;

  virtual ~Service() = default;
  Service() = default;
  Service(const Service&) = delete;
  Service& operator=(const Service&) = delete;

  /// `reply` may be called from any thread, once. `gone` is asked to stop when nobody waits for it any more.
  virtual void answer(Request request, std::stop_token gone, Reply reply) = 0;

  virtual ClientId join(std::shared_ptr<Channel> channel) = 0;
  /// A text message of a client, as it came. From another thread; a client's messages one after the other.
  virtual void message(ClientId client, const std::string& text) = 0;
  virtual void leave(ClientId client) = 0;
};

}  // namespace tessera::server
