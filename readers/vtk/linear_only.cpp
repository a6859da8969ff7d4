// SPDX-License-Identifier: BSD-3-Clause
#include "readers/vtk/linear_only.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <fstream>
#include <optional>
#include <sstream>
#include <string_view>

#include "io/files/whole_file.hpp"
#include "scene/error.hpp"

namespace tessera::readers {
namespace {

/// Removes and returns the next integer of a text; no value if another word comes first.
std::optional<std::int64_t> take_number(std::string_view& text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return std::nullopt;
  std::int64_t number = 0;
  const auto [end, fault] = std::from_chars(text.data() + first, text.data() + text.size(), number);
  if (fault != std::errc()) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return number;
}

}  // namespace

void require_linear_gambit(const std::filesystem::path& file) {
  struct Type {
    const char* name;
    std::int64_t nodes;
  };
  static constexpr std::array<Type, 8> types = {{{"", 0},
                                                 {"edge", 2},
                                                 {"quadrilateral", 4},
                                                 {"triangle", 3},
                                                 {"brick", 8},
                                                 {"wedge", 6},
                                                 {"tetrahedron", 4},
                                                 {"pyramid", 5}}};
  const io::WholeFile mapped(file);
  std::string_view text = mapped.text();
  const std::size_t title = text.find("ELEMENTS/CELLS");
  if (title == std::string_view::npos) return;
  text.remove_prefix(std::min(text.find('\n', title), text.size()));
  while (const auto id = take_number(text)) {
    const auto type = take_number(text), nodes = take_number(text);
    if (!type || !nodes || *type < 1 || *type >= static_cast<std::int64_t>(types.size())) return;
    const Type& known = types[static_cast<std::size_t>(*type)];
    if (*nodes > known.nodes)
      throw scene::bad_input(
          fmt::format("{}: element {} is a {} of {} nodes, but VTK's reader supports only linear elements; export CGNS "
                      "or EnSight Gold, or a linear mesh",
                      file.string(), *id, known.name, *nodes));
    for (std::int64_t k = 0; k < *nodes; ++k)
      if (!take_number(text)) return;
  }
}

std::string note_on_ensight6(const std::filesystem::path& case_file) {
  std::ifstream lines(case_file);
  bool is_gold = false;
  std::string model;
  for (std::string line; std::getline(lines, line);) {
    std::ranges::transform(line, line.begin(), [](unsigned char c) { return c == '\t' || c == '\r' ? ' ' : c; });
    std::istringstream words(line);
    std::string key, word, last;
    words >> key;
    while (words >> word) {
      if (key == "type:" && word == "gold") is_gold = true;
      last = word;
    }
    if (key == "model:" && !last.empty()) model = last;
  }
  std::error_code unknown;
  const std::filesystem::path geometry = case_file.parent_path() / model;
  if (is_gold || model.empty() || !std::filesystem::is_regular_file(geometry, unknown)) return {};
  const io::WholeFile mapped(geometry);
  for (const char* type : {"tetra10", "pyramid13", "penta15", "hexa20"})
    if (mapped.text().find(type) != std::string_view::npos)
      return fmt::format(
          "cells of second order ({}) are drawn as linear cells, because VTK's reader of EnSight 6 reads only their "
          "corners; write EnSight Gold",
          type);
  return {};
}

}  // namespace tessera::readers
