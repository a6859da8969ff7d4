// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <system_error>

#include "api/options/argument_values.hpp"
#include "api/options/surface_file_name.hpp"
#include "api/options/values.hpp"
#include "tessera/error.hpp"
#include "tessera/triangle_file.hpp"

namespace tessera {
namespace api {
namespace {

/// The text after a surface's name: COLOUR, COLOUR:OPACITY or :OPACITY. `given` is the whole word, for messages.
struct Look {
  std::optional<glm::dvec3> color{};
  double opacity = 1;
};
Look look_of(const std::string& option, const std::string& given, const std::string& text) {
  const std::size_t colon = std::min(text.find(':'), text.size());
  Look look;
  if (colon > 0) look.color = parse_color(option, text.substr(0, colon));
  if (colon < text.size()) {
    look.opacity = parse_number(option, text.substr(colon + 1));
    if (!(look.opacity > 0 && look.opacity <= 1))
      throw bad_input(fmt::format("{} {}: the opacity {} is not above 0 and at most 1", option, given, look.opacity));
  }
  return look;
}

std::string text_after(const std::string& word, std::size_t colon) {
  return colon < word.size() ? word.substr(colon + 1) : std::string();
}

IsoSurface iso_of(const std::string& word) {
  const std::size_t colon = std::min(word.find(':'), word.size());
  const double value = parse_number("`iso`", word.substr(0, colon));
  const Look look = look_of("`iso`", word, text_after(word, colon));
  return {value, look.color, look.opacity};
}

/// Position where the name of a surface ends; the name of an existing file may contain colons.
std::size_t end_of_name(const std::string& word) {
  std::size_t end = word.size();
  for (int colons = 0; colons <= 2 && end != std::string::npos && end > 0; ++colons) {
    std::error_code unknown;
    if (std::filesystem::is_regular_file(word.substr(0, end), unknown)) return end;
    end = word.rfind(':', end - 1);
  }
  return std::min(word.find(':'), word.size());
}

BlockSurfaceWord unread_block(const std::string& word, const std::string& name) {
  try {
    const Look look = look_of("`surface`", word, text_after(word, name.size()));
    return {word, name, look.color, look.opacity};
  } catch (const Error&) {
    return {word, word};
  }
}

/// Whether a name matches one of `names`, by the rules of ReadOptions::blocks.
bool is_among(const std::string& name, std::span<const std::string> names) {
  return std::ranges::any_of(names, [&](const std::string& each) {
    return each == name || each.starts_with(name + '/') || each.ends_with('/' + name);
  });
}

BlockSurfaceWord found_block(const BlockSurfaceWord& block, const Dataset& data) {
  std::size_t end = block.word.size();
  for (int colons = 0; colons <= 2 && end != std::string::npos && end > 0; ++colons) {
    const std::string name = block.word.substr(0, end);
    if (is_among(name, data.blocks()) || is_among(name, data.surfaces())) {
      const Look look = look_of("`surface`", block.word, text_after(block.word, end));
      return {block.word, name, look.color, look.opacity};
    }
    end = block.word.rfind(':', end - 1);
  }
  return block;
}

void add_surface(const std::string& word, Surfaces& surfaces, std::vector<BlockSurfaceWord>& blocks) {
  const std::size_t end = end_of_name(word);
  const std::string name = word.substr(0, end);
  std::error_code unknown;
  const bool is_file = std::filesystem::is_regular_file(name, unknown);
  if (name != "boundary" && !is_file && !names_surface_file(name)) {
    blocks.push_back(unread_block(word, name));
    return;
  }
  const Look look = look_of("`surface`", word, text_after(word, end));
  if (name == "boundary")
    surfaces.boundary.push_back({look.color, look.opacity});
  else if (is_file)
    surfaces.triangles.push_back(
        {std::make_shared<const TriangleMesh>(read_triangles(name)), look.color, look.opacity});
  else
    throw bad_input(
        fmt::format("`surface`: '{}' is neither boundary nor an existing file; give one of the two, with a file such "
                    "as .ply, .stl, .vtp, .vtk, .poly or .smesh, or a block of the mesh",
                    name));
}

}  // namespace

Surfaces surfaces_of(const OptionWords& words, std::vector<BlockSurfaceWord>& blocks) {
  Surfaces surfaces;
  surfaces.iso = iso_surfaces_of(words);
  for (const std::string& word : words.words("surface")) add_surface(word, surfaces, blocks);
  return surfaces;
}

std::vector<IsoSurface> iso_surfaces_of(const OptionWords& words) {
  std::vector<IsoSurface> surfaces;
  for (const std::string& word : words.words("iso")) surfaces.push_back(iso_of(word));
  return surfaces;
}

std::vector<std::string> unseen_surfaces(const Surfaces& surfaces, const std::array<double, 2>& range) {
  std::vector<std::string> warnings;
  for (const IsoSurface& iso : surfaces.iso)
    if (!(range[0] < iso.value && iso.value <= range[1]))
      warnings.push_back(
          fmt::format("`iso` {}: it shows nothing, because the field's values are from {:.6g} to {:.6g}; choose a "
                      "value between them",
                      iso.value, range[0], range[1]));
  return warnings;
}

}  // namespace api

inline namespace v0_1 {

std::vector<BlockSurfaceWord> found_blocks(std::span<const BlockSurfaceWord> words, const Dataset& data) {
  std::vector<BlockSurfaceWord> found;
  found.reserve(words.size());
  for (const BlockSurfaceWord& word : words) found.push_back(api::found_block(word, data));
  return found;
}

Surfaces with_block_surfaces(Surfaces surfaces, std::span<const BlockSurfaceWord> blocks, const Dataset& data,
                             std::span<const std::filesystem::path> files, ReadOptions read) {
  const char* const of = data.association() == Association::cell ? "cell:" : "point:";
  read.axis_scale = data.axis_scale();
  if (data.axis_scale() != glm::dvec3(1))
    for (TriangleSurface& surface : surfaces.triangles) {
      TriangleMesh scaled = *surface.mesh;
      for (glm::dvec3& point : scaled.points) point *= data.axis_scale();
      surface.mesh = std::make_shared<const TriangleMesh>(std::move(scaled));
    }
  read.field = data.shows_shape() ? std::string() : of + data.field_name();
  for (const BlockSurfaceWord& block : blocks)
    surfaces.triangles.push_back({std::make_shared<const TriangleMesh>(read_block_surface(files, block.name, read)),
                                  block.color, block.opacity});
  return surfaces;
}

}  // namespace v0_1
}  // namespace tessera
