// SPDX-License-Identifier: BSD-3-Clause
#include "readers/gmsh/gmsh_tags.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <map>
#include <string_view>

#include "io/files/whole_file.hpp"
#include "readers/gmsh/gmsh_types.hpp"
#include "scene/byte_order.hpp"

namespace tessera::readers {
namespace {

using Tags = std::optional<std::vector<GmshElementTags>>;

/// Parses the text of a file sequentially.
class Words {
 public:
  explicit Words(std::string_view text) : rest_(text) {}

  /// Returns the next integer on this line.
  std::optional<std::int64_t> number() {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t"), rest_.size()));
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
    if (error != std::errc()) return std::nullopt;
    rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
    return value;
  }
  std::string_view word() {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\r\n"), rest_.size()));
    const std::string_view found = rest_.substr(0, rest_.find_first_of(" \t\r\n"));
    rest_.remove_prefix(found.size());
    return found;
  }
  void end_line() { rest_.remove_prefix(std::min(rest_.find('\n'), rest_.size() - 1) + (rest_.empty() ? 0 : 1)); }
  [[nodiscard]] std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
};

/// Stores a number that follows an element's type; its meaning depends on the version and on its place.
void take_tag(double version, std::size_t place, std::size_t count, std::int64_t tag, GmshElementTags& tags) {
  const bool is_partition = version < 2.2 ? place == 2 : place == 3 && count > 3;
  if (place == 0) tags.group = static_cast<int>(tag);
  if (is_partition) tags.partition = static_cast<int>(tag);
}

Tags text_tags(Words words, double version) {
  const std::optional<std::int64_t> count = words.number();
  if (!count) return std::nullopt;
  std::vector<GmshElementTags> all;
  for (std::int64_t k = 0; k < *count; ++k) {
    words.end_line();
    const auto element = words.number(), type = words.number(), first = words.number();
    if (!element || !type || !first || *element < 0) return std::nullopt;
    GmshElementTags tags;
    tags.element = static_cast<std::size_t>(*element);
    if (version < 2) tags.group = static_cast<int>(*first);
    for (std::int64_t t = 0; version >= 2 && t < *first; ++t) {
      const auto tag = words.number();
      if (!tag) return std::nullopt;
      take_tag(version, static_cast<std::size_t>(t), static_cast<std::size_t>(*first), *tag, tags);
    }
    all.push_back(tags);
  }
  return all;
}

/// The list of elements of an MSH 2 file, starting at the line with their count.
struct ElementList {
  std::string_view elements;
  double version;
  bool is_binary, is_swapped;
};

/// Parses runs of elements of one type: 32-bit numbers in the byte order of the number 1 at the end of $MeshFormat. For
/// each element, calls `use(bytes of the element's numbers, beginning with its own, number of tags, number_at)`.
/// Returns whether the list was parsed to its end.
template <class Use>
bool each_binary_element(const ElementList& list, const Use& use) {
  Words words(list.elements);
  const std::optional<std::int64_t> count = words.number();
  if (!count) return false;
  words.end_line();
  const std::string_view bytes = words.rest();
  std::map<int, std::size_t> node_counts;
  std::size_t at = 0;
  const auto number_at = [&](std::size_t place) {
    return scene::load<std::int32_t>(bytes.data() + 4 * place, list.is_swapped);
  };
  const std::size_t numbers = bytes.size() / 4;
  for (std::int64_t done = 0; done < *count;) {
    if (at + 3 > numbers) return false;
    const int type = number_at(at), run = number_at(at + 1), tag_count = number_at(at + 2);
    const auto [nodes, is_new] = node_counts.try_emplace(type, 0);
    if (is_new) nodes->second = gmsh_element_type(type).nodes;
    if (nodes->second == 0 || run < 1 || tag_count < 0) return false;
    const auto tags = static_cast<std::size_t>(tag_count);
    const std::size_t each = 1 + tags + nodes->second;
    at += 3;
    if (static_cast<std::size_t>(run) > (numbers - at) / each) return false;
    for (int k = 0; k < run; ++k, ++done, at += each)
      use(bytes.substr(4 * at, 4 * each), tags, [&](std::size_t place) { return number_at(at + place); });
  }
  return true;
}

Tags binary_tags(const ElementList& list) {
  std::vector<GmshElementTags> all;
  const bool followed = each_binary_element(list, [&](std::string_view, std::size_t count, const auto& number_at) {
    GmshElementTags tags;
    tags.element = static_cast<std::size_t>(number_at(0));
    for (std::size_t t = 0; t < count; ++t) take_tag(list.version, t, count, number_at(1 + t), tags);
    all.push_back(tags);
  });
  return followed ? Tags(std::move(all)) : std::nullopt;
}

/// Returns the text after a line that consists of this word.
std::optional<std::string_view> after_line(std::string_view text, std::string_view word) {
  for (std::size_t at = text.find(word); at != std::string_view::npos; at = text.find(word, at + 1)) {
    const std::size_t end = at + word.size(), line = text.find('\n', end);
    if (line == std::string_view::npos) return std::nullopt;
    const bool begins = at == 0 || text[at - 1] == '\n';
    if (begins && text.substr(end, line - end).find_first_not_of(" \t\r") == std::string_view::npos)
      return text.substr(line + 1);
  }
  return std::nullopt;
}

std::optional<ElementList> element_list(std::string_view text) {
  const auto format = after_line(text.substr(0, 4096), "$MeshFormat"), elements = after_line(text, "$Elements");
  if (!format || !elements) return std::nullopt;
  Words words(*format);
  const std::string_view version = words.word();
  if (!version.starts_with("2")) return std::nullopt;
  const double number = version == "2" || version == "2.0" || version == "2.1" ? 2.0 : 2.2;
  if (words.word() != "1") return ElementList{*elements, number, false, false};
  words.word();
  words.end_line();
  return ElementList{*elements, number, true, words.rest().size() > 3 && words.rest()[0] == '\0'};
}

}  // namespace

Tags gmsh_element_tags(const std::filesystem::path& file) {
  const io::WholeFile mapped(file);
  const std::string_view text = mapped.text();
  if (const auto elements = after_line(text, "$ELM")) return text_tags(Words(*elements), 1);
  const std::optional<ElementList> list = element_list(text);
  if (!list) return std::nullopt;
  return list->is_binary ? binary_tags(*list) : text_tags(Words(list->elements), list->version);
}

std::string binary_without_partitions(std::string_view text) {
  const std::optional<ElementList> list = element_list(text);
  if (!list || !list->is_binary) return {};
  std::string copy(text);
  const bool followed = each_binary_element(*list, [&](std::string_view element, std::size_t tags, const auto&) {
    constexpr std::size_t before = 3;  // the element's number, its group and its entity
    const auto at = static_cast<std::size_t>(element.data() - text.data());
    if (tags > 2) std::fill_n(copy.begin() + static_cast<std::ptrdiff_t>(at + 4 * before), 4 * (tags - 2), '\0');
  });
  return followed ? copy : std::string();
}

}  // namespace tessera::readers
