// SPDX-License-Identifier: BSD-3-Clause
#include "tessera/program/nearest_name.hpp"

#include <algorithm>
#include <vector>

#include "tessera/program/text.hpp"

namespace tessera {
inline namespace v0_1 {
namespace {

/// Returns the number of edits between two words. Only three rows of the table are stored at a time.
std::size_t changes(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    std::swap(before, last);
    std::swap(last, row);
  }
  return last[b.size()];
}

}  // namespace

std::optional<std::string> nearest_name(std::string_view word, std::span<const std::string> names) {
  constexpr std::size_t longest = 256;  // longest compared name of a file or field, since the time is quadratic
  constexpr std::size_t most = 10'000;
  if (word.empty() || word.size() > longest) return std::nullopt;
  const std::string requested = lower_case(word);
  const std::string* nearest = nullptr;
  const std::string* begun = nullptr;
  std::size_t fewest = std::max<std::size_t>(1, requested.size() / 3) + 1, begins = 0;
  for (const std::string& name : names.first(std::min(names.size(), most))) {
    if (name.empty() || name.size() > longest) continue;
    const std::string known = lower_case(name);
    if (known.starts_with(requested)) {
      begun = &name;
      ++begins;
    }
    for (const std::string& part : {known, known.substr(known.rfind('/') + 1)}) {
      const std::size_t all = std::max(part.size(), requested.size());
      if (all - std::min(part.size(), requested.size()) >= fewest) continue;
      // Every letter is one edit away from a word of one letter, so such a match does not count.
      if (const std::size_t count = changes(requested, part); count < fewest && count < requested.size()) {
        fewest = count;
        nearest = &name;
      }
    }
  }
  if (nearest == nullptr && begins == 1 && requested.size() > 1) nearest = begun;
  return nearest == nullptr ? std::nullopt : std::optional(*nearest);
}

}  // namespace v0_1
}  // namespace tessera
