// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>

#include "tessera/annotation.hpp"
#include "tessera/error.hpp"
#include "tessera/program/text.hpp"

namespace tessera {
inline namespace v0_1 {

std::string fill_in(const std::string& text, std::span<const AnnotationWord> words) {
  std::string filled;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text[at] == '{' ? text.find('}', at) : std::string::npos;
    const std::string name = end == std::string::npos ? "" : text.substr(at + 1, end - at - 1);
    const bool is_word = !name.empty() && std::ranges::all_of(name, [](char c) { return is_lower(c) || c == '_'; });
    if (!is_word) {
      filled += text[at++];
      continue;
    }
    const auto word = std::ranges::find(words, name, &AnnotationWord::first);
    if (word == words.end()) {
      std::string known;
      for (const auto& [other, value] : words) known += fmt::format("{}{{{}}}", known.empty() ? "" : " ", other);
      throw bad_input(fmt::format("`annotate`: {{{}}} is unknown; use {}", name, known));
    }
    filled += word->second;
    at = end + 1;
  }
  return filled;
}

}  // namespace v0_1
}  // namespace tessera
