#include "io/triangle_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "io/face_triangles.hpp"
#include "io/input_file.hpp"
#include "scene/error.hpp"

namespace tessera::io {
namespace {

bool has_triangles(FileKind kind) {
  return kind == FileKind::stl || kind == FileKind::ply || kind == FileKind::vtk_surface ||
         kind == FileKind::tetgen_surface;
}

/// Appends a polygon's triangles.
class PolygonTriangles {
 public:
  explicit PolygonTriangles(tessera::TriangleMesh& mesh) : mesh_(mesh) {}

  void add(const Polygon& polygon) {
    ring_.clear();
    for (const std::uint32_t v : polygon)
      if (ring_.empty() || mesh_.points[v] != mesh_.points[ring_.back()]) ring_.push_back(v);
    while (ring_.size() > 1 && mesh_.points[ring_.front()] == mesh_.points[ring_.back()]) ring_.pop_back();
    if (ring_.size() < 3) return;
    if (ring_.size() == 3) {
      mesh_.triangles.push_back({ring_[0], ring_[1], ring_[2]});
      return;
    }
    // Corners' numbers in the order of their positions.
    const auto place = [&](std::uint32_t v) {
      const glm::dvec3& p = mesh_.points[v];
      return std::tuple(p.x, p.y, p.z);
    };
    sorted_ = ring_;
    std::ranges::sort(sorted_, {}, place);
    corners_.clear(), places_.clear(), triangles_.clear();
    for (const std::uint32_t v : sorted_) places_.push_back(mesh_.points[v]);
    for (const std::uint32_t v : ring_)
      corners_.push_back(
          static_cast<std::uint32_t>(std::ranges::lower_bound(sorted_, place(v), {}, place) - sorted_.begin()));
    cutter_.cut(corners_, places_, triangles_);
    for (const CornerTriangle& t : triangles_) mesh_.triangles.push_back({sorted_[t[0]], sorted_[t[1]], sorted_[t[2]]});
  }

 private:
  tessera::TriangleMesh& mesh_;
  std::vector<std::uint32_t> ring_, sorted_, corners_;
  std::vector<glm::dvec3> places_;
  std::vector<CornerTriangle> triangles_;
  FaceCutter cutter_;
};

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
  PolygonTriangles to(mesh);
  for (std::size_t f = 0; f < read.surface.facets.size(); ++f) {
    const Facet& facet = read.surface.facets[f];
    if (!facet.holes.empty())
      throw scene::bad_input(fmt::format("{}: facet {} has holes; divide it into polygons without", source, f));
    for (const Polygon& polygon : facet.polygons) to.add(polygon);
  }
  if (mesh.triangles.empty())
    throw scene::bad_input(fmt::format("{}: the surface has no faces; write it anew", source));
  return mesh;
}

}  // namespace tessera::io
