// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "cells/surface.hpp"
#include "io/files/inflated_file.hpp"
#include "io/files/whole_file.hpp"
#include "io/foreign/client/foreign_fill.hpp"
#include "io/foreign/client/foreign_surfaces.hpp"
#include "io/mesh/mesh_formats.hpp"
#include "io/mesh/ply_file.hpp"
#include "io/mesh/tetgen_files.hpp"
#include "scene/error.hpp"
#include "system/free_memory.hpp"

namespace tessera::io {
namespace {

/// Number of tets for a surface if no largest volume is given. This is about 40 tets across the surface, and takes
/// TetGen a second.
constexpr double default_tets = 30000;

std::string text_of(const std::filesystem::path& file) { return std::string(WholeFile(file).text()); }

cells::Surface read_poly(const std::filesystem::path& file, const std::string& source) {
  std::filesystem::path node_file = file;
  node_file.replace_extension(".node");
  std::error_code error;
  const std::string node = std::filesystem::is_regular_file(node_file, error) ? text_of(node_file) : std::string();
  return parse_tetgen_surface(text_of(file), system::lower_extension(file) == ".smesh", node, source,
                              node_file.string());
}

void require_sound(const cells::Surface& surface, const std::string& source) {
  if (surface.facets.empty())
    throw scene::bad_input(fmt::format("{}: the surface has no faces; write the file again", source));
  for (std::size_t v = 0; v < surface.points.size(); ++v)
    for (int k = 0; k < 3; ++k)
      if (!std::isfinite(surface.points[v][k]))
        throw scene::bad_input(fmt::format("{}: point {} of the surface is not finite; correct it", source, v));
  cells::require_closed(surface, source);
}

double box_volume(const cells::Surface& surface) {
  glm::dvec3 low(1e300), high(-1e300);
  for (const glm::dvec3& p : surface.points)
    for (int k = 0; k < 3; ++k) low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
  return (high.x - low.x) * (high.y - low.y) * (high.z - low.z);
}

/// Throws if TetGen would create more tets than fit into memory. TetGen itself may detect that only after an hour.
void require_room(double volume, double max_volume, const std::string& source) {
  const double tets = volume / max_volume;
  constexpr double bytes_a_tet = 1024;  // measured (readers/common/limits.cpp)
  const double room = std::min(static_cast<double>(system::available_memory()) / bytes_a_tet, 0x1p31);
  if (tets > room)
    throw scene::bad_input(fmt::format(
        "{}: with a `max_volume` of {:.3g} TetGen makes about {:.2g} tets, which takes {:.3g} GiB; set {:.2g} or more",
        source, max_volume, tets, tets * bytes_a_tet / 0x1p30, 1.1 * tets / room * max_volume));
}

}  // namespace

SurfaceFile read_stl_surface(const InputFile& file) {
  SurfaceFile result{.surface = read_stl(file), .words = "stl"};
  cells::merge_coincident_points(result.surface);
  return result;
}

SurfaceFile read_vtk_surface_file(const InputFile& file) {
  VtkSurface read = read_vtk_surface(file);
  cells::merge_coincident_points(read.surface);
  return {std::move(read.surface), std::move(read.attribute_names), std::move(read.notes), "vtk"};
}

SurfaceFile read_ply_surface(const InputFile& file) {
  PlySurface ply = parse_ply(WholeFile(file.path).text(), file.path.string());
  cells::merge_coincident_points(ply.surface);
  return {std::move(ply.surface), std::move(ply.attribute_names), {}, "ply"};
}

SurfaceFile read_tetgen_surface(const InputFile& file) {
  SurfaceFile result{.surface = read_poly(file.path, file.path.string()),
                     .words = system::lower_extension(file.path) == ".smesh" ? "smesh" : "poly"};
  for (std::size_t a = 0; a < result.surface.attributes.size(); ++a)
    result.attribute_names.push_back(fmt::format("attribute{}", a));
  return result;
}

cells::MeshBlocks fill_surface_file(const InputFile& file, const MeshOptions& options) {
  const std::optional<double>& max_volume = options.max_volume;
  const std::string source = file.path.string();
  if (max_volume && !(*max_volume > 0))
    throw scene::bad_input(fmt::format("{}: the largest tet volume is {}, but must be positive; give a number above 0",
                                       source, *max_volume));
  cells::MeshBlocks result;
  SurfaceFile read = file.format->read_surface(file);
  cells::Surface& surface = read.surface;
  result.notes = std::move(read.notes);
  require_sound(surface, source);
  cells::cut_warped_facets(surface);

  result.format = fmt::format("surface ({}) filled by TetGen", read.words);
  double volume = cells::enclosed_volume(surface);
  // If the orientations of facets are mixed, their volumes cancel, and only the bounding box is a useful estimate.
  if (!(volume > 1e-3 * box_volume(surface))) volume = box_volume(surface);
  if (!(volume > 0))
    throw scene::bad_input(
        fmt::format("{}: the surface is flat and encloses no volume; give a closed surface", source));
  const double largest = max_volume.value_or(volume / default_tets);
  if (max_volume) require_room(volume, largest, source);
  // Measured on spheres (readers/common/limits.cpp). A surface with fields is filled twice, the first time without
  // interior points.
  const auto facets = static_cast<double>(surface.facets.size());
  const double expected = (surface.attributes.empty() ? 2e-4 : 4e-4) * facets + 2e-5 * volume / largest;
  if (options.progress) options.progress({ReadProgress::Stage::filling, 0, expected});
  FilledMesh filled = fill_surface(surface, {largest, volume / largest, max_volume.has_value()}, file);
  result.notes.push_back(fmt::format("surface of {} points and {} facets filled with {} tets of at most {:.4g}{}",
                                     surface.points.size(), surface.facets.size(), filled.tets.size() / 4, largest,
                                     max_volume ? "" : " (`max_volume` sets it)"));
  cells::CellBlock block;
  for (std::size_t a = 0; a < filled.attributes.size(); ++a)
    block.fields.push_back(cells::field_of_values(read.attribute_names[a], "double", scene::Association::point, 1,
                                                  std::move(filled.attributes[a])));
  block.fields.push_back(
      cells::field_of_values("depth", "double", scene::Association::point, 1, std::move(filled.depth)));
  result.notes.emplace_back("field 'depth' is the distance to the surface in world units");
  block.positions = std::move(filled.points);
  block.tets.resize(filled.tets.size() / 4);
  for (std::size_t k = 0; k < filled.tets.size(); ++k) block.tets[k / 4][k % 4] = filled.tets[k];
  result.blocks.push_back(std::move(block));
  return result;
}

cells::MeshBlocks read_node_ele(const InputFile& input, const MeshOptions& /*options*/) {
  const std::filesystem::path& file = input.path;
  require_uncompressed(file);
  std::filesystem::path node_file = file, ele_file = file;
  // The extension of the other file has the same case: A.NODE matches A.ELE.
  const bool upper = file.extension().string() != system::lower_extension(file);
  node_file.replace_extension(system::lower_extension(file) == ".node" ? file.extension() : upper ? ".NODE" : ".node");
  ele_file.replace_extension(system::lower_extension(file) == ".ele" ? file.extension() : upper ? ".ELE" : ".ele");
  cells::MeshBlocks result;
  result.format = "TetGen .node/.ele";
  result.blocks.push_back(parse_node_ele(text_of(node_file), text_of(ele_file), node_file.string(), ele_file.string()));
  return result;
}

}  // namespace tessera::io
