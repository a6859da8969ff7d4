// SPDX-License-Identifier: BSD-3-Clause
#include "projection/cell_record.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "projection/edge_sign.hpp"
#include "projection/prepared_mesh.hpp"

namespace tessera::projection {

std::optional<CellRecord> cell_record(const ProjectedMesh& projected, std::uint32_t tet, std::uint64_t global_tet) {
  const scene::TetMeshView& mesh = projected.mesh->mesh();
  const scene::Tet& corners = projected.mesh->tets()[tet];
  const bool per_cell = mesh.association == scene::Association::cell;
  CellRecord record{};
  for (std::size_t i = 0; i < 4; ++i) {
    const PixelVertex& v = projected.vertices[corners[i]];
    if (!(v.w > 0) || v.depth < projected.near_depth || v.depth > projected.far_depth) return std::nullopt;
    const LineOfSight sight = line_of_sight(v, projected.pixels_per_tangent);
    if (!(std::max(std::abs(sight.x), std::abs(sight.y)) <= CellRecord::reach) || sight.w != 1) return std::nullopt;
    record.corner[i] = {sight.x, sight.y, v.depth, mesh.scalars[per_cell ? tet : corners[i]]};
  }
  record.tet = global_tet;
  return record;
}

void rasterize_records(std::span<const CellRecord> cells, const scene::PixelRect& rect, double pixels_per_tangent,
                       const std::function<void(const RaySegments&, std::span<const CellRecord>)>& take) {
  constexpr std::size_t cells_at_once = 4096;
  RaySegments segments;
  segments.reserve(std::max<std::size_t>(2 * static_cast<std::size_t>(rect.area()), 16384));
  RasterCounts counts;
  for (; !cells.empty(); cells = cells.subspan(std::min(cells_at_once, cells.size()))) {
    const auto batch = cells.first(std::min(cells_at_once, cells.size()));
    scene::TetMesh mesh;  // has four vertices per cell; the order of corners is the same in all cells
    std::vector<PixelVertex> vertices;
    for (const CellRecord& cell : batch) {
      const auto first = static_cast<std::uint32_t>(vertices.size());
      mesh.tets.push_back({first, first + 1, first + 2, first + 3});
      for (const CellRecord::Corner& c : cell.corner) {
        const double w = pixels_per_tangent != 0 ? c.depth : 1;
        mesh.positions.emplace_back(c.x, c.y, c.depth);
        mesh.scalars.push_back(c.scalar);
        vertices.push_back({c.x * w, c.y * w, w, c.depth});
      }
    }
    const PreparedMesh prepared(mesh);
    const ProjectedMesh projected{&prepared, vertices, 0, std::numeric_limits<double>::infinity(), pixels_per_tangent};
    std::vector<TileEntry> entries;
    for (std::uint32_t tet = 0; tet < batch.size(); ++tet) entries.push_back({0, tet});
    for (std::span<const TileEntry> rest = entries; !rest.empty();) {
      segments.size = 0;
      rest = rest.subspan(rasterize_planes(projected, rest, rect, segments, counts));
      take(segments, batch);
    }
  }
}

}  // namespace tessera::projection
