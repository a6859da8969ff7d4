#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tessera::server {

/// What of a request decides whether it is answered, as it came.
struct Credentials {
  std::string_view host, origin, cookie, authorization, query;
};

/// Who may speak to the server: who has the token of this run, from a page that this server gave.
///
/// Token   128 random bits as hex. In the query (`?token=`), the cookie, or `Authorization: Bearer`.
/// Host    a loopback name with any port (as behind an SSH tunnel), the address bound to, or an allowed name. Else a
///         page of another site, whose name was made to lead here, could speak to us as its own server.
/// Origin  if there is one, the Host's, or of an allowed name: so that pages of other servers cannot use the cookie.
class Access {
 public:
  /// Of a new run. `bound` is the address listened at.
  Access(const std::string& bound, const std::vector<std::string>& allowed_hosts);
  /// With a token and a run's word of the caller's.
  Access(std::string token, const std::string& run, const std::string& bound,
         const std::vector<std::string>& allowed_hosts);

  [[nodiscard]] const std::string& token() const { return token_; }
  /// `Set-Cookie`'s value. Without a path, so that it holds below whatever prefix a proxy adds.
  [[nodiscard]] std::string cookie(bool secure) const;

  /// Why it is not answered, one sentence; nothing if it is.
  [[nodiscard]] std::optional<std::string> refusal(const Credentials& credentials) const;

 private:
  [[nodiscard]] bool allowed(std::string_view name) const;
  [[nodiscard]] bool has_token(const Credentials& credentials) const;

  std::string token_, cookie_name_, bound_;
  std::vector<std::string> allowed_;
};

/// The name of `name:port`, `[::1]:port` or a name alone, in small letters; empty if it is none of them.
std::string host_name(std::string_view host);

/// `count` random bytes of the system's as hex. Throws Error(system_failure).
std::string random_hex(std::size_t count);

/// The value of `name` in a query, decoded; nothing if it is not there or its escapes are broken.
std::optional<std::string> query_value(std::string_view query, std::string_view name);
/// Escapes of an address decoded; nothing if they are broken. `plus`: a plus stands for a blank.
std::optional<std::string> decoded(std::string_view text, bool plus);

}  // namespace tessera::server
