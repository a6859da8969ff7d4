// SPDX-License-Identifier: BSD-3-Clause
// No host, origin, subprotocol or query makes a server answer a client without its token.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "server/access.hpp"
#include "support/fuzz_check.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tessera;
  static const server::Access access("0123456789abcdef0123456789abcdef", "127.0.0.1", {"viz.example.org"});
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  server::host_name(text);
  server::decoded(text, true);
  server::query_value(text, "state");
  const bool knows = text.find(access.token()) != std::string_view::npos || text.find('%') != std::string_view::npos;
  for (const server::Credentials& given :
       {server::Credentials{"127.0.0.1", "", text, "", ""}, server::Credentials{"127.0.0.1", "", "", text, ""},
        server::Credentials{"127.0.0.1", "", "", "", text}, server::Credentials{text, text, text, text, text}})
    test::require(access.refusal(given).has_value() || knows);
  // With the token, but from a page of another server.
  const server::Credentials foreign{"127.0.0.1:80", text, "Bearer 0123456789abcdef0123456789abcdef", "", ""};
  test::require(access.refusal(foreign).has_value() || text.empty() ||
                text.find("127.0.0.1") != std::string_view::npos || text.find_first_of("vV") != std::string_view::npos);
  return 0;
}
