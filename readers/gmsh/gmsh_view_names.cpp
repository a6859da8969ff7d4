// SPDX-License-Identifier: BSD-3-Clause
#include "readers/gmsh/gmsh_view_names.hpp"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "io/files/whole_file.hpp"
#include "readers/gmsh/gmsh_tags.hpp"
#include "scene/error.hpp"

namespace tessera::readers {
namespace {

constexpr std::string_view blanks = " \t\r";

/// A line of the text, without its end and surrounding blanks.
struct Line {
  std::size_t first = 0, last = 0, next = 0;
};

Line line_at(std::string_view text, std::size_t at) {
  const std::size_t end = std::min(text.find('\n', at), text.size());
  const std::string_view line = text.substr(at, end - at);
  const std::size_t first = line.find_first_not_of(blanks), last = line.find_last_not_of(blanks);
  const std::size_t next = std::min(end + 1, text.size());
  if (first == std::string_view::npos) return {at, at, next};
  return {at + first, at + last + 1, next};
}

bool begins_view(std::string_view text, std::size_t dollar) {
  if (dollar > 0 && text[dollar - 1] != '\n') return false;
  const Line line = line_at(text, dollar);
  const std::string_view word = text.substr(line.first, line.last - line.first);
  return word == "$NodeData" || word == "$ElementData" || word == "$ElementNodeData";
}

/// Returns the positions where quotes are missing, in pairs.
std::vector<std::size_t> lacking_quotes(std::string_view text) {
  std::vector<std::size_t> places;
  for (std::size_t at = text.find('$'); at != std::string_view::npos; at = text.find('$', at + 1)) {
    if (!begins_view(text, at)) continue;
    const Line count_line = line_at(text, line_at(text, at).next);
    int names = 0;
    std::from_chars(text.data() + count_line.first, text.data() + count_line.last, names);
    Line line = line_at(text, count_line.next);
    for (int k = 0; k < std::min(names, 16) && line.first < text.size(); ++k, line = line_at(text, line.next)) {
      const std::string_view name = text.substr(line.first, line.last - line.first);
      if (name.find('"') == std::string_view::npos) places.push_back(line.first), places.push_back(line.last);
    }
  }
  return places;
}

void write_all(int file, std::string_view text, const std::string& source) {
  while (!text.empty()) {
    const ssize_t written = ::write(file, text.data(), std::min<std::size_t>(text.size(), 1 << 30));
    if (written <= 0)
      throw scene::Error(scene::ErrorCode::system_failure, source, "no memory is left for a copy of it",
                         "use a larger machine");
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

/// Returns the line of an element with only its first two tags, the physical group and the entity.
std::string with_two_tags(std::string_view line) {
  std::istringstream words{std::string(line)};
  std::string number, type, group, entity, dropped;
  int tags = 0;
  words >> number >> type >> tags >> group >> entity;
  for (int k = 2; k < tags; ++k) words >> dropped;
  if (!words || tags <= 2) return std::string(line);
  std::string nodes;
  std::getline(words, nodes);
  return number + ' ' + type + " 2 " + group + ' ' + entity + nodes;
}

}  // namespace

system::Descriptor with_quoted_view_names(const std::filesystem::path& file) {
  const io::WholeFile mapped(file);
  const std::string_view text = mapped.text();
  const std::vector<std::size_t> places = lacking_quotes(text);
  if (places.empty()) return {};
  system::Descriptor copy(::memfd_create("tessera", MFD_CLOEXEC));
  std::size_t done = 0;
  for (const std::size_t place : places) {
    write_all(copy.get(), text.substr(done, place - done), file.string());
    write_all(copy.get(), "\"", file.string());
    done = place;
  }
  write_all(copy.get(), text.substr(done), file.string());
  return copy;
}

system::Descriptor without_partitions(const std::filesystem::path& file) {
  const io::WholeFile mapped(file);
  const std::string_view text = mapped.text();
  if (const std::string binary = binary_without_partitions(text); !binary.empty()) {
    system::Descriptor copy(::memfd_create("tessera", MFD_CLOEXEC));
    write_all(copy.get(), binary, file.string());
    return copy;
  }
  const std::size_t elements = text.find("\n$Elements"), format = line_at(text, 0).next;
  if (!text.starts_with("$MeshFormat") || elements == std::string_view::npos || text.substr(format, 2) != "2." ||
      text.substr(format, 16).find(" 0 ") == std::string_view::npos)
    return {};
  const std::size_t count = line_at(text, elements + 1).next, first = line_at(text, count).next;
  system::Descriptor copy(::memfd_create("tessera", MFD_CLOEXEC));
  write_all(copy.get(), text.substr(0, first), file.string());
  std::string lines;
  std::size_t at = first;
  for (Line line = line_at(text, at); at < text.size() && text[line.first] != '$'; line = line_at(text, at)) {
    lines += with_two_tags(text.substr(line.first, line.last - line.first)) + '\n';
    at = line.next;
    constexpr std::size_t chunk = 1 << 20;
    if (lines.size() > chunk) write_all(copy.get(), lines, file.string()), lines.clear();
  }
  write_all(copy.get(), lines, file.string());
  write_all(copy.get(), text.substr(at), file.string());
  return copy;
}

}  // namespace tessera::readers
