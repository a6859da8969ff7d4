// SPDX-License-Identifier: BSD-3-Clause
#include "server/access.hpp"

#include <fmt/format.h>
#include <sys/random.h>

#include <algorithm>

#include "tessera/error.hpp"
#include "tessera/program/text.hpp"

namespace tessera::server {
namespace {

/// Compares two texts in a time that does not depend on how many characters match.
bool same(std::string_view given, std::string_view token) {
  if (given.size() != token.size()) return false;
  unsigned char differ = 0;
  for (std::size_t i = 0; i < token.size(); ++i) differ |= static_cast<unsigned char>(given[i] ^ token[i]);
  return differ == 0;
}

/// Whether the name is an address of 127.0.0.0/8 as four numbers, and not a name that only begins like such an address.
bool is_loopback_v4(std::string_view name) {
  if (!name.starts_with("127.") || std::ranges::count(name, '.') != 3) return false;
  return std::ranges::all_of(name, [](char c) { return c == '.' || is_digit(c); });
}

bool is_loopback(std::string_view name) { return name == "localhost" || name == "::1" || is_loopback_v4(name); }

/// Returns `host:port`, without the port if it is the default port of its scheme.
std::string plain_authority(std::string_view authority, std::string_view port) {
  std::string result = lower_case(authority);
  if (result.ends_with(port)) result.resize(result.size() - port.size());
  return result;
}

}  // namespace

std::string host_name(std::string_view host) {
  std::string_view name = host;
  if (host.starts_with('[')) {
    const std::size_t close = host.find(']');
    if (close == std::string_view::npos) return {};
    name = host.substr(1, close - 1);
    host.remove_prefix(close + 1);
  } else {
    name = host.substr(0, host.find(':'));
    host.remove_prefix(name.size());
  }
  const bool port_is_right =
      host.empty() || (host.size() <= 6 && host.front() == ':' && std::ranges::all_of(host.substr(1), is_digit));
  return port_is_right ? lower_case(name) : std::string();
}

std::string random_hex(std::size_t count) {
  std::string bytes(count, '\0');
  if (::getrandom(bytes.data(), count, 0) != static_cast<ssize_t>(count))
    throw Error(ErrorCode::system_failure, "server", "the system has no random numbers for a token", "try again");
  std::string hex;
  for (const char byte : bytes) hex += fmt::format("{:02x}", static_cast<unsigned char>(byte));
  return hex;
}

std::optional<std::string> decoded(std::string_view text, bool plus) {
  std::string result;
  result.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      result += plus && text[i] == '+' ? ' ' : text[i];
      continue;
    }
    if (i + 2 >= text.size()) return std::nullopt;
    const int high = hex_digit(text[i + 1]), low = hex_digit(text[i + 2]);
    if (high < 0 || low < 0) return std::nullopt;
    result += static_cast<char>(16 * high + low);
    i += 2;
  }
  return result;
}

std::optional<std::string> query_value(std::string_view query, std::string_view name) {
  while (!query.empty()) {
    const std::string_view pair = query.substr(0, query.find('&'));
    query.remove_prefix(std::min(pair.size() + 1, query.size()));
    const std::size_t equals = pair.find('=');
    if (equals != std::string_view::npos && pair.substr(0, equals) == name)
      return decoded(pair.substr(equals + 1), true);
  }
  return std::nullopt;
}

bool lists_word(std::string_view list, std::string_view word) {
  while (!list.empty()) {
    std::string_view item = list.substr(0, list.find(','));
    list.remove_prefix(std::min(item.size() + 1, list.size()));
    while (item.starts_with(' ')) item.remove_prefix(1);
    while (item.ends_with(' ')) item.remove_suffix(1);
    if (same(item, word)) return true;
  }
  return false;
}

Access::Access(const std::string& bound, const std::vector<std::string>& allowed_hosts)
    : Access(random_hex(16), bound, allowed_hosts) {}

Access::Access(std::string token, const std::string& bound, const std::vector<std::string>& allowed_hosts)
    : token_(std::move(token)), bound_(lower_case(bound)) {
  for (const std::string& host : allowed_hosts) allowed_.push_back(lower_case(host));
}

bool Access::allowed(std::string_view name) const {
  return is_loopback(name) || name == bound_ || std::ranges::find(allowed_, name) != allowed_.end();
}

bool Access::has_token(const Credentials& credentials) const {
  if (const auto given = query_value(credentials.query, "token"); given && same(*given, token_)) return true;
  constexpr std::string_view bearer = "bearer ";  // RFC 9110, 11.1: case-insensitive
  if (lower_case(std::string(credentials.authorization.substr(0, bearer.size()))) == bearer &&
      same(credentials.authorization.substr(bearer.size()), token_))
    return true;
  if (same(credentials.token, token_)) return true;
  return lists_word(credentials.protocols, "token." + token_);
}

std::optional<std::string> Access::page_refusal(std::string_view host) const {
  const std::string name = host_name(host);
  if (name.empty()) return "The request names no host; open the address that `tessera serve` printed.";
  if (allowed(name)) return std::nullopt;
  return fmt::format("This server does not answer to the name {0}; start it with --allow-host {0} to allow it.", name);
}

std::optional<std::string> Access::refusal(const Credentials& credentials) const {
  if (auto refusal = page_refusal(credentials.host)) return refusal;
  if (!credentials.origin.empty()) {
    const std::size_t scheme = credentials.origin.find("://");
    const std::string_view authority =
        scheme == std::string_view::npos ? std::string_view() : credentials.origin.substr(scheme + 3);
    const std::string_view port = credentials.origin.starts_with("https:") ? ":443" : ":80";
    const bool own = !authority.empty() && plain_authority(authority, port) == plain_authority(credentials.host, port);
    const std::string name = host_name(authority);
    const bool named = !name.empty() && std::ranges::find(allowed_, name) != allowed_.end();
    if (!own && !named && name.empty())
      return "The request comes from a page without an address; requests from such pages are refused.";
    if (!own && !named)
      return fmt::format(
          "The page's address, {}, is not this server's, {}; if a proxy leads from one to the other, start the server "
          "with --allow-host {}.",
          authority, credentials.host, name);
  }
  if (!has_token(credentials))
    return "The token is missing or belongs to another run; open the whole address that `tessera serve` printed.";
  return std::nullopt;
}

}  // namespace tessera::server
