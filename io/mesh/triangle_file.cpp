// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/triangle_file.hpp"

#include <fmt/format.h>

#include <cmath>

#include "cells/polygon_triangles.hpp"
#include "io/formats/input_file.hpp"
#include "scene/error.hpp"

namespace tessera::io {
namespace {

bool has_triangles(FileKind kind) {
  return kind == FileKind::stl || kind == FileKind::ply || kind == FileKind::vtk_surface ||
         kind == FileKind::tetgen_surface;
}

}  // namespace

tessera::TriangleMesh read_triangles(const std::filesystem::path& file) {
  require_file(file);
  const std::string source = file.string();
  const FormatRow* row = format_of(file);
  if (row == nullptr || !has_triangles(row->kind))
    throw scene::bad_input(
        fmt::format("{}: is no surface of triangles; give a .ply, .stl, .vtp, .vtk, .poly or .smesh", source));
  SurfaceFile read = read_surface_file(file, row->kind);
  tessera::TriangleMesh mesh;
  mesh.points = std::move(read.surface.points);
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
    if (!(std::isfinite(mesh.points[v].x) && std::isfinite(mesh.points[v].y) && std::isfinite(mesh.points[v].z)))
      throw scene::bad_input(fmt::format("{}: point {} of the surface is not finite; mend it", source, v));
  cells::PolygonTriangles cutter;
  for (std::size_t f = 0; f < read.surface.facets.size(); ++f) {
    const cells::Facet& facet = read.surface.facets[f];
    if (!facet.holes.empty())
      throw scene::bad_input(fmt::format("{}: facet {} has holes; divide it into polygons without", source, f));
    for (const cells::Polygon& polygon : facet.polygons) cutter.cut(polygon, mesh.points, mesh.triangles);
  }
  if (mesh.triangles.empty())
    throw scene::bad_input(fmt::format("{}: the surface has no faces; write it anew", source));
  return mesh;
}

}  // namespace tessera::io
