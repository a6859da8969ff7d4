// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tessera::server {

/// The headers and the query that decide whether a request is allowed, as received.
struct Credentials {
  std::string_view host, origin, authorization, protocols, query;  ///< protocols: Sec-WebSocket-Protocol
  std::string_view token{};                                        ///< X-Tessera-Token
};

/// The subprotocol of the WebSocket. A page offers it together with the token, which it cannot send in another header.
constexpr std::string_view socket_protocol = "tessera";

/// Access control: requests need the token of this run, and must come from a page of this server.
///
/// Token   128 random bits as hex: `Authorization: Bearer T`, `X-Tessera-Token: T` if a proxy uses Authorization
///         itself, `?token=T` in the query, or for a WebSocket the subprotocol `token.T`. Not a cookie: browsers send
///         cookies to every port of a machine.
/// Host    a loopback name with any port (as behind an SSH tunnel), the bound address, or an allowed name. Otherwise a
///         page of another site, whose name resolves to this machine, could send requests as if it came from this
///         server.
/// Origin  if present, the Host's, or that of an allowed name.
class Access {
 public:
  /// For a new run, with a random token. `bound` is the address on which the server listens.
  Access(const std::string& bound, const std::vector<std::string>& allowed_hosts);
  /// With the given token.
  Access(std::string token, const std::string& bound, const std::vector<std::string>& allowed_hosts);

  [[nodiscard]] const std::string& token() const { return token_; }

  /// The reason for refusing the request, one sentence; none if it is allowed.
  [[nodiscard]] std::optional<std::string> refusal(const Credentials& credentials) const;
  /// The same for the files of the page. They are public: the page must load before it can send the token, and it
  /// explains a refusal itself.
  [[nodiscard]] std::optional<std::string> page_refusal(std::string_view host) const;

 private:
  [[nodiscard]] bool allowed(std::string_view name) const;
  [[nodiscard]] bool has_token(const Credentials& credentials) const;

  std::string token_, bound_;
  std::vector<std::string> allowed_;
};

/// Whether a comma-separated list of a header has this word.
bool lists_word(std::string_view list, std::string_view word);

/// The name in `name:port`, `[::1]:port` or a name alone, in lower case; empty for any other text.
std::string host_name(std::string_view host);

/// `count` random bytes from the system as hex. Throws Error(system_failure).
std::string random_hex(std::size_t count);

/// The decoded value of `name` in a query; none if it is missing or its escapes are invalid.
std::optional<std::string> query_value(std::string_view query, std::string_view name);
/// Decodes the escapes of an address; none if they are invalid. `plus`: a plus means a blank.
std::optional<std::string> decoded(std::string_view text, bool plus);

}  // namespace tessera::server
