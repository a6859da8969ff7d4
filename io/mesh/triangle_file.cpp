// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/triangle_file.hpp"

#include <fmt/format.h>

#include <cmath>

#include "cells/polygon_triangles.hpp"
#include "scene/error.hpp"

namespace tessera::io {

tessera::TriangleMesh read_triangles(const InputFile& file) {
  const std::string& source = file.name;
  if (file.format == nullptr || file.format->read_surface == nullptr)
    throw scene::bad_input(
        fmt::format("{}: it is not a surface of triangles; give a .ply, .stl, .vtp, .vtk, .poly or .smesh", source));
  SurfaceFile read = file.format->read_surface(file);
  tessera::TriangleMesh mesh;
  mesh.points = std::move(read.surface.points);
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
    if (!(std::isfinite(mesh.points[v].x) && std::isfinite(mesh.points[v].y) && std::isfinite(mesh.points[v].z)))
      throw scene::bad_input(fmt::format("{}: point {} of the surface is not finite; correct it", source, v));
  cells::PolygonTriangles cutter;
  for (std::size_t f = 0; f < read.surface.facets.size(); ++f) {
    const cells::Facet& facet = read.surface.facets[f];
    if (!facet.holes.empty())
      throw scene::bad_input(fmt::format("{}: facet {} has holes; divide it into polygons without holes", source, f));
    for (const cells::Polygon& polygon : facet.polygons) cutter.cut(polygon, mesh.points, mesh.triangles);
  }
  if (mesh.triangles.empty())
    throw scene::bad_input(fmt::format("{}: the surface has no faces; write the file again", source));
  return mesh;
}

}  // namespace tessera::io
