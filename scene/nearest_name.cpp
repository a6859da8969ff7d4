#include "scene/nearest_name.hpp"

#include <algorithm>
#include <cctype>
#include <numeric>
#include <utility>
#include <vector>

namespace tessera::scene {
namespace {

constexpr std::size_t most_names = 10'000, most_letters = 64;

std::string lower(std::string_view text) {
  std::string result(text.substr(0, most_letters));
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

/// Damerau, "A technique for computer detection and correction of spelling errors", CACM 1964, in the restricted form
/// in which no letter is changed twice.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before, last(b.size() + 1), row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before = std::exchange(last, row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0u : 1u)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) row[j] = std::min(row[j], before[j - 2] + 1);
    }
  }
  return row.back();
}

}  // namespace

std::optional<std::string> nearest_name(std::string_view wrong, std::span<const std::string> names) {
  const std::string word = lower(wrong);
  std::size_t least = word.size() / 3 + 1;
  std::optional<std::string> nearest;
  for (const std::string& name : names.first(std::min(names.size(), most_names))) {
    const std::size_t part = name.rfind('/');
    std::size_t changes = distance(word, lower(name));
    if (part != std::string::npos)
      changes = std::min(changes, distance(word, lower(std::string_view(name).substr(part + 1))));
    if (changes >= least) continue;
    least = changes;
    nearest = name;
  }
  return nearest;
}

}  // namespace tessera::scene
