// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tessera::server {

/// The headers and the query, as received, that determine whether a request is allowed.
struct Credentials {
  std::string_view host, origin, authorization, protocols, query;  ///< protocols: Sec-WebSocket-Protocol
  std::string_view token{};                                        ///< X-Tessera-Token
};

/// The subprotocol of the WebSocket. A page offers this name together with the token, since it cannot send the token in
/// another header.
constexpr std::string_view socket_protocol = "tessera";

/// Access control: a request must contain the token of this run and must come from a page of this server.
///
/// Token   The token T is 128 random bits as hex. It is sent as `Authorization: Bearer T`, as `X-Tessera-Token: T` if a
///         proxy uses Authorization itself, as `?token=T` in the query, or, for a WebSocket, as the subprotocol
///         `token.T`. It is not a cookie, because browsers send cookies to every port of a machine.
/// Host    The host must be a loopback name with any port (as behind an SSH tunnel), the bound address, or an allowed
///         name. Otherwise a page of another site, whose name resolves to this machine, could send requests as if the
///         page came from this server.
/// Origin  If present, it must be that of the Host or of an allowed name.
class Access {
 public:
  /// Access control for a new run, with a random token. `bound` is the address on which the server listens.
  Access(const std::string& bound, const std::vector<std::string>& allowed_hosts);
  /// Access control with the given token.
  Access(std::string token, const std::string& bound, const std::vector<std::string>& allowed_hosts);

  [[nodiscard]] const std::string& token() const { return token_; }

  /// Returns one sentence with the reason for refusing the request; none if the request is allowed.
  [[nodiscard]] std::optional<std::string> refusal(const Credentials& credentials) const;
  /// Returns the reason for refusing a file of the page; none if it is allowed. These files do not require the token:
  /// the page must load before it can send the token, and it explains a refusal itself.
  [[nodiscard]] std::optional<std::string> page_refusal(std::string_view host) const;

 private:
  [[nodiscard]] bool allowed(std::string_view name) const;
  [[nodiscard]] bool has_token(const Credentials& credentials) const;

  std::string token_, bound_;
  std::vector<std::string> allowed_;
};

/// Whether the comma-separated list in a header contains this word.
bool lists_word(std::string_view list, std::string_view word);

/// Returns, in lower case, the name in `name:port`, in `[::1]:port` or in a name without a port; empty for any other
/// text.
std::string host_name(std::string_view host);

/// Returns `count` random bytes from the system, as hex. Throws Error(system_failure).
std::string random_hex(std::size_t count);

/// The decoded value of `name` in a query; none if it is missing or its escapes are invalid.
std::optional<std::string> query_value(std::string_view query, std::string_view name);
/// Decodes the escapes of an address. Returns none if they are invalid. If `plus`, a plus sign is decoded as a blank.
std::optional<std::string> decoded(std::string_view text, bool plus);

}  // namespace tessera::server
