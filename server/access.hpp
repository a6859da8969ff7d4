// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tessera::server {

/// The headers and the query that decide whether a request is answered, as they came.
struct Credentials {
  std::string_view host, origin, authorization, protocols, query;  ///< protocols: Sec-WebSocket-Protocol
  std::string_view token{};                                        ///< X-Tessera-Token
};

/// The subprotocol of the WebSocket. A page offers it together with the token, which it cannot send in another header.
constexpr std::string_view socket_protocol = "tessera";

/// Who may use the server: who has the token of this run, from a page that this server gave.
///
/// Token   128 random bits as hex: `Authorization: Bearer T`, `X-Tessera-Token: T` where a proxy uses Authorization
///         itself, `?token=T` in the query, or for a WebSocket the subprotocol `token.T`. Not a cookie: browsers send
///         those to every port of the same machine.
/// Host    a loopback name with any port (as behind an SSH tunnel), the address bound to, or an allowed name. Else a
///         page of another site, whose name was made to lead here, could speak to us as its own server.
/// Origin  if there is one, the Host's, or of an allowed name.
class Access {
 public:
  /// Of a new run. `bound` is the address listened at.
  Access(const std::string& bound, const std::vector<std::string>& allowed_hosts);
  /// With the caller's token.
  Access(std::string token, const std::string& bound, const std::vector<std::string>& allowed_hosts);

  [[nodiscard]] const std::string& token() const { return token_; }

  /// Why it is not answered, one sentence; nothing if it is.
  [[nodiscard]] std::optional<std::string> refusal(const Credentials& credentials) const;
  /// The same for the files of the page. They are public: the page loads before it can send the token, and explains
  /// itself what is refused.
  [[nodiscard]] std::optional<std::string> page_refusal(std::string_view host) const;

 private:
  [[nodiscard]] bool allowed(std::string_view name) const;
  [[nodiscard]] bool has_token(const Credentials& credentials) const;

  std::string token_, bound_;
  std::vector<std::string> allowed_;
};

/// Whether a comma-separated list of a header has this word.
bool lists_word(std::string_view list, std::string_view word);

/// The name of `name:port`, `[::1]:port` or a name alone, in small letters; empty if it is none of them.
std::string host_name(std::string_view host);

/// `count` random bytes of the system's as hex. Throws Error(system_failure).
std::string random_hex(std::size_t count);

/// The value of `name` in a query, decoded; nothing if it is not there or its escapes are broken.
std::optional<std::string> query_value(std::string_view query, std::string_view name);
/// Escapes of an address decoded; nothing if they are broken. `plus`: a plus stands for a blank.
std::optional<std::string> decoded(std::string_view text, bool plus);

}  // namespace tessera::server
