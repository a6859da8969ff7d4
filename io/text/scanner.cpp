// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/scanner.hpp"

#include <fmt/format.h>

#include "scene/error.hpp"

namespace tessera::io {

std::size_t line_number(std::string_view text, std::size_t at) {
  return static_cast<std::size_t>(std::ranges::count(text.substr(0, at), '\n')) + 1;
}

void fail_at(std::string_view text, std::size_t at, const std::string& source, const std::string& what) {
  throw scene::bad_input(fmt::format("{}: line {}: {}", source, line_number(text, at), printable_ascii(what)));
}

}  // namespace tessera::io
