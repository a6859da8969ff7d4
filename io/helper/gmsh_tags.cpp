#include "io/helper/gmsh_tags.hpp"

#include <gmsh.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <map>
#include <new>
#include <string_view>

#include "io/mapped_file.hpp"

namespace tessera::io::helper {
namespace {

using Tags = std::optional<std::vector<GmshElementTags>>;

/// Reads along a file's text.
class Words {
 public:
  explicit Words(std::string_view text) : rest_(text) {}

  /// The next whole number on this line.
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

/// The numbers behind an element's type, as versions give them.
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

/// How many nodes elements of a type have; 0 of those that the library does not describe.
class NodeCounts {
 public:
  std::size_t of(int type) {
    const auto [found, is_new] = known_.try_emplace(type, 0);
    if (!is_new) return found->second;
    std::string name;
    int dimension = 0, order = 0, nodes = 0, corners = 0;
    std::vector<double> places;
    try {
      gmsh::model::mesh::getElementProperties(type, name, dimension, order, nodes, places, corners);
      found->second = static_cast<std::size_t>(std::max(nodes, 0));
    } catch (const std::bad_alloc&) {
      throw;
    } catch (...) {  // it does not describe prisms of the third order and above
      const int n = type == 90 || type == 91 ? type - 87 : type >= 106 && type <= 110 ? type - 101 : 0;
      found->second = static_cast<std::size_t>(n == 0 ? 0 : (n + 1) * (n + 1) * (n + 2) / 2);
    }
    return found->second;
  }

 private:
  std::map<int, std::size_t> known_;
};

/// Runs of elements of one type: 32-bit numbers in the byte order of the 1 that ends $MeshFormat.
Tags binary_tags(Words words, double version, bool is_swapped) {
  const std::optional<std::int64_t> count = words.number();
  if (!count) return std::nullopt;
  words.end_line();
  const std::string_view bytes = words.rest();
  NodeCounts nodes;
  std::vector<GmshElementTags> all;
  std::size_t at = 0;
  const auto number_at = [&](std::size_t place) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + 4 * place, sizeof value);
    return static_cast<std::int32_t>(is_swapped ? __builtin_bswap32(value) : value);
  };
  const std::size_t numbers = bytes.size() / 4;
  while (static_cast<std::int64_t>(all.size()) < *count) {
    if (at + 3 > numbers) return std::nullopt;
    const int type = number_at(at), run = number_at(at + 1), tag_count = number_at(at + 2);
    const std::size_t nodes_each = nodes.of(type);
    if (nodes_each == 0 || run < 1 || tag_count < 0) return std::nullopt;
    const std::size_t each = 1 + static_cast<std::size_t>(tag_count) + nodes_each;
    at += 3;
    if (static_cast<std::size_t>(run) > (numbers - at) / each) return std::nullopt;
    for (int k = 0; k < run; ++k, at += each) {
      GmshElementTags tags;
      tags.element = static_cast<std::size_t>(number_at(at));
      const auto n = static_cast<std::size_t>(tag_count);
      for (std::size_t t = 0; t < n; ++t) take_tag(version, t, n, number_at(at + 1 + t), tags);
      all.push_back(tags);
    }
  }
  return all;
}

/// What follows a line that is just this word.
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

}  // namespace

Tags gmsh_element_tags(const std::filesystem::path& file) {
  const MappedFile mapped(file);
  const std::string_view text = mapped.text();
  if (const auto elements = after_line(text, "$ELM")) return text_tags(Words(*elements), 1);
  const auto format = after_line(text.substr(0, 4096), "$MeshFormat"), elements = after_line(text, "$Elements");
  if (!format || !elements) return std::nullopt;
  Words words(*format);
  const std::string_view version = words.word();
  if (!version.starts_with("2")) return std::nullopt;
  const double number = version == "2" || version == "2.0" || version == "2.1" ? 2.0 : 2.2;
  if (words.word() != "1") return text_tags(Words(*elements), number);
  words.word();
  words.end_line();
  return binary_tags(Words(*elements), number, words.rest().size() > 3 && words.rest()[0] == '\0');
}

}  // namespace tessera::io::helper
