#include "projection/tile_lists.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tessera::projection {
namespace {

/// `depth - origin` as a float that is not above it, rounding of the sum `origin + result` in double included.
float depth_behind(double origin, double depth) {
  const double exact = (depth - origin) - 4e-16 * (std::abs(depth) + std::abs(origin));
  const auto nearest = static_cast<float>(std::clamp(exact, -3e38, 3e38));
  return static_cast<double>(nearest) <= exact ? nearest
                                               : std::nextafter(nearest, -std::numeric_limits<float>::infinity());
}

double nearest_depth(const ProjectedMesh& projected) {
  const auto vertices = projected.vertices;
  const double nearest = tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, vertices.size(), 4096), std::numeric_limits<double>::max(),
      [&](const auto& range, double least) {
        for (std::size_t v = range.begin(); v != range.end(); ++v) least = std::min(least, vertices[v].depth);
        return least;
      },
      [](double a, double b) { return std::min(a, b); });
  return std::max(projected.near_depth, nearest);
}

std::array<PixelVertex, 4> corners_of(const ProjectedMesh& projected, std::size_t tet) {
  const scene::Tet& t = projected.mesh->mesh().tets[tet];
  return {projected.vertices[t[0]], projected.vertices[t[1]], projected.vertices[t[2]], projected.vertices[t[3]]};
}

bool crosses_eye_plane(const std::array<PixelVertex, 4>& c) {
  return !(c[0].w > 0 && c[1].w > 0 && c[2].w > 0 && c[3].w > 0);
}

/// Blocks of tets that are counted apart; few, as each has one counter a tile.
constexpr std::size_t block_count = 16;

std::size_t block_begin(std::size_t block, std::size_t tets) {
  return tets / block_count * block + std::min(block, tets % block_count);
}

}  // namespace

PixelRect TileGrid::rect(std::size_t tile) const {
  const int column = static_cast<int>(tile % static_cast<std::size_t>(columns()));
  const int row = static_cast<int>(tile / static_cast<std::size_t>(columns()));
  return {column * tile_size, row * tile_size, std::min((column + 1) * tile_size, image.width),
          std::min((row + 1) * tile_size, image.height)};
}

template <class Visit>
void TileLists::for_each_tile(std::size_t tet, Visit visit) const {
  const Extent& e = extents_[tet];
  if (e.column0 > e.column1) return;
  const auto columns = static_cast<std::size_t>(grid_.columns());
  const bool box_is_window = e.column0 != e.column1 || e.row0 != e.row1;
  std::array<PixelVertex, 4> corners;
  bool crossing = false;
  if (box_is_window) {
    corners = corners_of(*projected_, tet);
    crossing = crosses_eye_plane(corners);
  }
  for (std::size_t row = e.row0; row <= e.row1; ++row)
    for (std::size_t column = e.column0; column <= e.column1; ++column) {
      const std::size_t tile = row * columns + column;
      // Such a cell's extent is the whole window; its tiles are those that no plane through the eye parts from it.
      if (crossing && footprint(corners, grid_.rect(tile)).empty()) continue;
      visit(tile, e.near_depth);
    }
}

TileLists::TileLists(const ProjectedMesh& projected, const TileGrid& grid,
                     const scene::TransferFunction& transfer_function, bool emits_without_extinction,
                     scene::Trace* trace)
    : projected_(&projected),
      trace_(trace),
      grid_(grid),
      depth_origin_(nearest_depth(projected)),
      extents_(projected.mesh->tet_count()),
      tile_counts_(grid.count(), 0) {
  const std::size_t tets = extents_.size();
  const PixelRect window{0, 0, grid.image.width, grid.image.height};
  std::array<CullCounts, block_count> culled;
  std::vector<std::vector<std::uint32_t>> counted(block_count);
  tbb::parallel_for(std::size_t{0}, block_count, [&](std::size_t block) {
    const scene::TraceScope timing(trace_, "cull");
    CullCounts local;
    std::vector<std::uint32_t>& tiles = counted[block];
    tiles.resize(grid.count(), 0);
    for (std::size_t t = block_begin(block, tets); t != block_begin(block + 1, tets); ++t) {
      Extent& extent = extents_[t];
      extent = {1, 1, 0, 0, 0};
      const auto [low, high] = projected.mesh->scalar_bounds(t);
      if (!transfer_function.visible(low, high, emits_without_extinction)) {
        ++local.invisible;
        continue;
      }
      const std::array<PixelVertex, 4> c = corners_of(projected, t);
      const auto [nearest, farthest] = std::minmax({c[0].depth, c[1].depth, c[2].depth, c[3].depth});
      if (!(farthest > projected.near_depth && nearest < projected.far_depth)) {
        ++local.outside_view;
        continue;
      }
      const PixelRect box = footprint(c, window);
      if (box.empty()) {
        // Inside the window's span in both directions, yet without a pixel centre?
        const auto inside = [&](const PixelVertex& v) {
          return v.w > 0 && v.x > 0 && v.x < window.x1 * v.w && v.y > 0 && v.y < window.y1 * v.w;
        };
        ++(std::any_of(c.begin(), c.end(), inside) ? local.between_pixels : local.outside_view);
        continue;
      }
      ++local.projected;
      const auto tile = [&](int pixel) { return static_cast<std::uint16_t>(pixel / grid.tile_size); };
      extent = {tile(box.x0), tile(box.y0), tile(box.x1 - 1), tile(box.y1 - 1),
                depth_behind(depth_origin_, std::max(nearest, projected.near_depth))};
      for_each_tile(t, [&](std::size_t i, float) { ++tiles[i]; });
    }
    culled[block] = local;
  });
  for (std::size_t block = 0; block < block_count; ++block) {
    counts_.invisible += culled[block].invisible;
    counts_.outside_view += culled[block].outside_view;
    counts_.between_pixels += culled[block].between_pixels;
    counts_.projected += culled[block].projected;
    for (std::size_t i = 0; i < tile_counts_.size(); ++i) tile_counts_[i] += counted[block][i];
  }
}

void TileLists::fill(std::size_t first, std::size_t last) {
  first_ = first;
  offsets_.assign(last - first + 1, 0);
  for (std::size_t i = first; i < last; ++i) offsets_[i - first + 1] = offsets_[i - first] + tile_counts_[i];
  entries_.resize(offsets_.back());
  // Each task fills its own run of tiles and reads all extents: no shared counters, and the lists come out in tet
  // order.
  const auto columns = static_cast<std::size_t>(grid_.columns());
  const std::size_t first_row = first / columns, last_row = (last - 1) / columns;
  const std::size_t tasks =
      std::min<std::size_t>(last - first, 2 * static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()));
  tbb::parallel_for(std::size_t{0}, tasks, [&](std::size_t task) {
    const scene::TraceScope timing(trace_, "bin");
    const std::size_t begin = first + (last - first) * task / tasks, end = first + (last - first) * (task + 1) / tasks;
    const std::size_t begin_row = begin / columns, end_row = (end - 1) / columns;
    std::vector<std::uint64_t> next(offsets_.begin() + static_cast<std::ptrdiff_t>(begin - first),
                                    offsets_.begin() + static_cast<std::ptrdiff_t>(end - first));
    for (std::size_t t = 0; t < extents_.size(); ++t) {
      const Extent& e = extents_[t];
      if (e.column0 > e.column1 || e.row1 < begin_row || e.row0 > end_row || e.row1 < first_row || e.row0 > last_row)
        continue;
      for_each_tile(t, [&](std::size_t tile, float near_depth) {
        if (tile >= begin && tile < end) entries_[next[tile - begin]++] = {near_depth, static_cast<std::uint32_t>(t)};
      });
    }
  });
}

std::span<TileEntry> TileLists::tile(std::size_t tile) {
  const std::size_t i = tile - first_;
  return std::span(entries_).subspan(offsets_[i], offsets_[i + 1] - offsets_[i]);
}

std::size_t TileLists::bytes() const {
  return extents_.capacity() * sizeof(Extent) + tile_counts_.capacity() * sizeof(std::uint64_t) +
         offsets_.capacity() * sizeof(std::uint64_t) + entries_.capacity() * sizeof(TileEntry);
}

}  // namespace tessera::projection
