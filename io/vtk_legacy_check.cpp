#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <cstring>

#include "io/vtk_checks.hpp"
#include "scene/error.hpp"

namespace tessera::io {
namespace {

/// Bytes of a legacy type's value, 0 for those of no fixed size (strings, variants).
std::uint64_t size_of_type(const std::string& type) {
  if (type == "char" || type == "unsigned_char" || type == "signed_char" || type == "bit") return 1;
  if (type == "short" || type == "unsigned_short") return 2;
  if (type == "int" || type == "unsigned_int" || type == "float") return 4;
  if (type == "long" || type == "unsigned_long" || type == "double" || type == "vtkidtype" || type == "vtktypeint64" ||
      type == "vtktypeuint64")
    return type == "vtkidtype" ? 4 : 8;  // VTK writes vtkIdType as int
  return 0;
}

std::string lower(std::string_view word) {
  std::string text(word);
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

class LegacyCheck {
 public:
  LegacyCheck(std::string_view text, const std::string& source) : text_(text), source_(source) {}

  void run() {
    // "# vtk DataFile Version x.y": VTK chooses between the two layouts of CELLS by x.
    const std::string_view first = line(), version = "Version ";
    const std::size_t at = first.find(version);
    if (at == std::string_view::npos) fail("its first line names no version");
    const std::string_view digits = first.substr(at + version.size());
    int minor = 0;
    const char* const end = digits.data() + digits.size();
    auto parsed = std::from_chars(digits.data(), end, major_version_);
    if (parsed.ec == std::errc() && parsed.ptr != end && *parsed.ptr == '.')
      parsed = std::from_chars(parsed.ptr + 1, end, minor);
    else
      parsed.ec = std::errc::invalid_argument;
    if (parsed.ec != std::errc() || parsed.ptr != end || !first.starts_with("# vtk DataFile Version "))
      fail(fmt::format("its first line is '{}', not '# vtk DataFile Version x.y'", printable(first)));
    line();  // title
    const std::string mode = lower(word());
    if (mode != "ascii" && mode != "binary")
      fail(fmt::format("it is '{}', neither ASCII nor BINARY", mode.substr(0, 20)));
    binary_ = mode == "binary";
    line();
    while (true) {
      const std::string key = lower(word());
      if (key.empty() || !step(key)) return;
    }
  }

 private:
  /// One keyword with its payload; false if what follows cannot be checked (strings).
  bool step(const std::string& key) {
    if (key == "dataset") {
      word();
    } else if (key == "dimensions") {
      for (int k = 0; k < 3; ++k) count("DIMENSIONS", INT32_MAX);
    } else if (key == "origin" || key == "spacing" || key == "aspect_ratio") {
      for (int k = 0; k < 3; ++k) word();
    } else if (key == "points") {
      const std::uint64_t n = count("POINTS", text_.size());
      return payload("POINTS", 3 * n, lower(word()));
    } else if (key == "x_coordinates" || key == "y_coordinates" || key == "z_coordinates") {
      const std::uint64_t n = count("coordinates", text_.size());
      return payload("coordinates", n, lower(word()));
    } else if (key == "cells" || key == "vertices" || key == "lines" || key == "polygons" || key == "triangle_strips") {
      cells();
    } else if (key == "cell_types") {
      const std::uint64_t n = count("CELL_TYPES", text_.size());
      return payload("CELL_TYPES", n, "int");
    } else if (key == "point_data" || key == "cell_data") {
      tuples_ = count("the number of tuples", text_.size());
    } else if (key == "metadata") {
      line();
      while (at_ < text_.size() && !line().empty()) {
      }
    } else {
      return attribute(key);
    }
    return true;
  }

  bool attribute(const std::string& key) {
    if (key == "scalars") {
      word();
      const std::string type = lower(word());
      const std::size_t line_end = std::min(text_.find('\n', at_), text_.size());
      const bool has_components =
          text_.substr(at_, line_end - at_).find_first_not_of(" \t\r") != std::string_view::npos;
      const std::uint64_t components = has_components ? count("the number of components", 1000) : 1;
      const std::size_t before = at_;
      if (lower(word()) == "lookup_table")
        word();
      else
        at_ = before;
      return payload("SCALARS", components * tuples_, type);
    }
    if (key == "color_scalars") {
      word();
      const std::uint64_t components = count("the number of components", 1000);
      return payload("COLOR_SCALARS", components * tuples_, binary_ ? "unsigned_char" : "float");
    }
    if (key == "lookup_table") {
      word();
      return payload("LOOKUP_TABLE", 4 * count("LOOKUP_TABLE", text_.size()), binary_ ? "unsigned_char" : "float");
    }
    if (key == "texture_coordinates") {
      word();
      const std::uint64_t components = count("the number of components", 1000);
      return payload("TEXTURE_COORDINATES", components * tuples_, lower(word()));
    }
    if (key == "field") {
      word();
      for (std::uint64_t left = count("FIELD", text_.size()); left > 0; --left) {
        std::string name = lower(word());
        if (name == "metadata") {
          step(name);
          name = lower(word());
        }
        if (name == "null_array") continue;
        const std::uint64_t components = count("the number of components", text_.size());
        const std::uint64_t tuples = count("the number of tuples", text_.size());
        if (components != 0 && tuples > text_.size() / components)
          fail(fmt::format("field array '{}' has {} x {} values", name.substr(0, 40), tuples, components));
        if (!payload("FIELD", components * tuples, lower(word()))) return false;
      }
      return true;
    }
    const int components = key == "vectors" || key == "normals"                                  ? 3
                           : key == "tensors"                                                    ? 9
                           : key == "tensors6"                                                   ? 6
                           : key == "global_ids" || key == "pedigree_ids" || key == "edge_flags" ? 1
                                                                                                 : 0;
    if (components == 0) fail(fmt::format("'{}' is no keyword of legacy VTK", printable(key)));
    word();
    return payload("an attribute", static_cast<std::uint64_t>(components) * tuples_, lower(word()));
  }

  void cells() {
    const std::uint64_t cells = count("the number of cells", text_.size());
    const std::uint64_t entries = count("the size of the cell list", text_.size());
    if (major_version_ >= 5) {  // n + 1 offsets, then the indices
      if (lower(word()) != "offsets") fail("no OFFSETS follow the number of cells");
      payload("OFFSETS", cells, lower(word()));
      if (lower(word()) != "connectivity") fail("no CONNECTIVITY follows the cell offsets");
      payload("CONNECTIVITY", entries, lower(word()));
      return;
    }
    // Before version 5: each cell's number of points, then the points. VTK walks through them unchecked.
    if (binary_) line();
    require(entries, 4);
    std::uint64_t used = 0;
    for (std::uint64_t c = 0; c < cells; ++c) {
      const std::int64_t n = used < entries ? cell_entry() : -1;
      if (n < 0 || static_cast<std::uint64_t>(n) > entries - used - 1)
        fail(fmt::format("cell {} does not fit the list of {} entries", c, entries));
      used += 1 + static_cast<std::uint64_t>(n);
      for (std::int64_t k = 0; k < n; ++k) cell_entry();
    }
    if (used != entries) fail(fmt::format("its {} cells take {} entries, the list has {}", cells, used, entries));
  }

  std::int64_t cell_entry() {
    if (!binary_) {
      const std::string_view text = word();
      std::int64_t value = 0;
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
      if (error != std::errc() || end != text.data() + text.size() || text.empty())
        fail(fmt::format("'{}' stands in the list of cells", text.substr(0, 20)));
      return value;
    }
    std::uint32_t value = 0;  // big-endian; require() has seen that the bytes are there
    std::memcpy(&value, text_.data() + at_, 4);
    at_ += 4;
    if constexpr (std::endian::native == std::endian::little) value = __builtin_bswap32(value);
    return static_cast<std::int32_t>(value);
  }

  /// Passes over `n` values; false if they are strings.
  bool payload(const char* what, std::uint64_t n, const std::string& type) {
    const std::uint64_t size = size_of_type(type);
    if (size == 0) {
      if (type == "string" || type == "utf8_string" || type == "variant") return false;
      fail(fmt::format("{} has the unknown type '{}'", what, printable(type)));
    }
    what_ = what;
    if (binary_) {
      line();
      const std::uint64_t bytes = type == "bit" ? (n + 7) / 8 : n * size;  // n is at most 1000 times the file's size
      if (bytes > text_.size() - at_) require(n, size);
      at_ += bytes;
      return true;
    }
    require(n, 1);
    for (std::uint64_t k = 0; k < n; ++k)
      if (word().empty()) fail(fmt::format("{} needs {} values, the file ends after {}", what, n, k));
    return true;
  }

  void require(std::uint64_t n, std::uint64_t size) const {
    if (n > (text_.size() - at_) / size)
      fail(fmt::format("{} needs {} values, {} bytes are left", what_, n, text_.size() - at_));
  }

  std::uint64_t count(const char* what, std::uint64_t most) {
    what_ = what;
    const std::string_view text = word();
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || text.empty() || value < 0 ||
        static_cast<std::uint64_t>(value) > most)
      fail(fmt::format("{} is '{}', which the file's {} bytes cannot hold", what, printable(text), text_.size()));
    return static_cast<std::uint64_t>(value);
  }

  static std::string printable(std::string_view text) { return clean(std::string(text.substr(0, 30))); }

  static std::string clean(std::string text) {
    for (char& c : text)
      if (c < ' ' || c > '~') c = '?';
    return text;
  }

  std::string_view word() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
    const std::size_t start = at_;
    while (at_ < text_.size() && !std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
    return text_.substr(start, at_ - start);
  }

  /// The rest of the line, without its end.
  std::string_view line() {
    const std::size_t start = at_, end = std::min(text_.find('\n', at_), text_.size());
    at_ = std::min(end + 1, text_.size());
    std::string_view rest = text_.substr(start, end - start);
    while (!rest.empty() && std::isspace(static_cast<unsigned char>(rest.back()))) rest.remove_suffix(1);
    return rest;
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw scene::bad_input(
        fmt::format("{}: {}; the file is truncated or damaged, write it anew", source_, clean(what)));
  }

  std::string_view text_;
  const std::string& source_;
  std::size_t at_ = 0;
  bool binary_ = false;
  int major_version_ = 0;
  std::uint64_t tuples_ = 0;
  const char* what_ = "the list of cells";
};

}  // namespace

void check_vtk_legacy(std::string_view text, const std::string& source) { LegacyCheck(text, source).run(); }

}  // namespace tessera::io
