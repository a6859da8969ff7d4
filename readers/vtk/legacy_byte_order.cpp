// SPDX-License-Identifier: BSD-3-Clause
#include "readers/vtk/legacy_byte_order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "io/files/whole_file.hpp"
#include "scene/byte_order.hpp"
#include "scene/error.hpp"

namespace tessera::readers {
namespace {

/// Whether the first few numbers are likely in a byte order.
template <class T, class IsLikely>
bool are_likely(std::string_view bytes, bool is_swapped, const IsLikely& is_likely) {
  constexpr std::size_t most = 3000;
  for (std::size_t k = 0; k < std::min(most, bytes.size() / sizeof(T)); ++k)
    if (!is_likely(scene::load<T>(bytes.data() + k * sizeof(T), is_swapped))) return false;
  return true;
}

/// Whether the numbers are likely only in the byte order that the format does not use.
template <class T, class IsLikely>
bool are_little_endian(std::string_view bytes, const IsLikely& is_likely) {
  constexpr bool is_little = std::endian::native == std::endian::little;
  return bytes.size() >= sizeof(T) && !are_likely<T>(bytes, is_little, is_likely) &&
         are_likely<T>(bytes, !is_little, is_likely);
}

/// Returns the words of the line that begins with `key`; empty if there is none. `rest` is set to the text after the
/// line.
std::vector<std::string> line_of(std::string_view text, std::string_view key, std::string_view& rest) {
  const std::size_t at = text.find(fmt::format("\n{} ", key));
  if (at == std::string_view::npos) return {};
  const std::size_t end = std::min(text.find('\n', at + 1), text.size());
  rest = text.substr(std::min(end + 1, text.size()));
  std::vector<std::string> words;
  std::string_view line = text.substr(at + 1, std::min<std::size_t>(end - at - 1, 400));
  while (!line.empty()) {
    const std::size_t length = std::min(line.find_first_of(" \t\r"), line.size());
    if (length > 0) words.emplace_back(line.substr(0, length));
    line.remove_prefix(std::min(length + 1, line.size()));
  }
  return words;
}

std::size_t count_in(const std::string& word) {
  std::size_t count = 0;
  std::from_chars(word.data(), word.data() + word.size(), count);
  return count;
}

/// Whether floats have usual magnitudes in little-endian order but not in the format's order.
bool has_little_floats(std::string_view bytes, const std::string& type, std::size_t count) {
  const auto is_usual = [](auto x) { return x == 0 || (std::abs(x) > 1e-30F && std::abs(x) < 1e30F); };
  if (type == "float") return are_little_endian<float>(bytes.substr(0, 4 * count), is_usual);
  return type == "double" && are_little_endian<double>(bytes.substr(0, 8 * count), is_usual);
}

/// Whether the first numbers of a field, of `size` bytes each, are mostly different. A constant like 1e-35 usually
/// means that the byte order is wrong.
bool are_various(std::string_view bytes, std::size_t size) {
  const std::size_t count = std::min<std::size_t>(64, bytes.size() / size);
  std::set<std::string_view> different;
  for (std::size_t k = 0; k < count; ++k) different.insert(bytes.substr(k * size, size));
  return 2 * different.size() >= count;
}

bool is_little_endian(std::string_view text) {
  std::string_view rest;
  if (const auto words = line_of(text, "POINTS", rest);
      words.size() > 2 && has_little_floats(rest, words[2], std::min(3 * count_in(words[1]), rest.size() / 8)))
    return true;
  for (const char* key : {"CELLS", "POLYGONS", "LINES", "VERTICES", "TRIANGLE_STRIPS"}) {
    const auto words = line_of(text, key, rest);
    if (words.size() < 3) continue;
    const auto size = static_cast<double>(count_in(words[2]));
    const auto fits = [&](auto count) { return count >= 0 && static_cast<double>(count) <= size; };
    if (!rest.starts_with("OFFSETS")) return are_little_endian<std::int32_t>(rest.substr(0, 4), fits);
    const std::string_view numbers = rest.substr(std::min(rest.find('\n') + 1, rest.size()));
    return rest.starts_with("OFFSETS vtktypeint64") && are_little_endian<std::int64_t>(numbers.substr(0, 16), fits);
  }
  const auto words = line_of(text, "SCALARS", rest);
  if (words.size() < 3 || !rest.starts_with("LOOKUP_TABLE")) return false;
  rest.remove_prefix(std::min(rest.find('\n') + 1, rest.size()));
  std::string_view behind;
  const auto points = line_of(text, "POINT_DATA", behind);
  return are_various(rest, words[2] == "double" ? 8 : 4) &&
         has_little_floats(rest, words[2], points.size() > 1 ? count_in(points[1]) : 1);
}

}  // namespace

void require_big_endian(const std::filesystem::path& file) {
  const io::WholeFile mapped(file);
  const std::string_view text = mapped.text();
  const std::size_t title = text.find('\n'), coding = std::min(text.find('\n', title + 1), text.size() - 1);
  if (title == std::string_view::npos || !text.substr(coding + 1).starts_with("BINARY") || !is_little_endian(text))
    return;
  throw scene::bad_input(
      fmt::format("{}: its binary numbers are little-endian, but legacy VTK files must be big-endian; swap their "
                  "bytes, or export text or .vtu",
                  file.string()));
}

}  // namespace tessera::readers
