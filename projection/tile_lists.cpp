// SPDX-License-Identifier: BSD-3-Clause
#include "projection/tile_lists.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "scene/frame_watch.hpp"

namespace tessera::projection {
namespace {

/// Returns `depth - origin` as a float that is not too large, even after the sum `origin + result` is rounded in
/// double.
float depth_behind(double origin, double depth) {
  const double exact = (depth - origin) - 4e-16 * (std::abs(depth) + std::abs(origin));
  const auto nearest = static_cast<float>(std::clamp(exact, -3e38, 3e38));
  return static_cast<double>(nearest) <= exact ? nearest
                                               : std::nextafter(nearest, -std::numeric_limits<float>::infinity());
}

double nearest_depth(const ProjectedMesh& projected, scene::Team* team) {
  const scene::Share own = scene::share_of(projected.vertices.size(), team);
  const double nearest = tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(own.first, own.last, 8192), std::numeric_limits<double>::max(),
      [&](const auto& range, double least) {
        return std::min(least, smallest_depth(projected.vertices.subspan(range.begin(), range.end() - range.begin())));
      },
      [](double a, double b) { return std::min(a, b); });
  return std::max(projected.near_depth, scene::least_of(nearest, team));
}

std::array<PixelVertex, 4> corners_of(const ProjectedMesh& projected, std::size_t tet) {
  const scene::Tet& t = projected.mesh->mesh().tets[tet];
  return {projected.vertices[t[0]], projected.vertices[t[1]], projected.vertices[t[2]], projected.vertices[t[3]]};
}

bool crosses_eye_plane(const std::array<PixelVertex, 4>& c) {
  return !(c[0].w > 0 && c[1].w > 0 && c[2].w > 0 && c[3].w > 0);
}

static_assert(PreparedMesh::block_tets == cull_block_cells);

/// Blocks between two checks for a stop: 16,384 tets, less than a millisecond.
constexpr std::size_t blocks_a_check = 256;
/// Returns the number of runs of blocks: enough runs that no thread waits long for the last run, but few enough that
/// the runs' counters, one per run and tile, stay below 32 MiB.
std::size_t run_count(std::size_t blocks, std::size_t tiles) {
  const auto threads = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
  const std::size_t most = std::max<std::size_t>((std::size_t{8} << 20) / tiles, 1);
  return std::clamp<std::size_t>(std::min(8 * threads, blocks), 1, most);
}

/// Calls visit(first + i) for every bit i that is set in `bits`.
template <class Visit>
void for_each_of(std::uint64_t bits, std::size_t first, Visit visit) {
  for (; bits != 0; bits &= bits - 1) visit(first + static_cast<std::size_t>(std::countr_zero(bits)));
}

}  // namespace

scene::PixelRect TileGrid::rect(std::size_t tile) const {
  const int column = static_cast<int>(tile % static_cast<std::size_t>(columns()));
  const int row = static_cast<int>(tile / static_cast<std::size_t>(columns()));
  return {column * tile_size, row * tile_size, std::min((column + 1) * tile_size, image.width),
          std::min((row + 1) * tile_size, image.height)};
}

/// Calls `visit` for every tile that a projected tet is in.
template <class Visit>
void TileLists::for_each_tile(std::size_t tet, Visit visit) const {
  const std::uint32_t place = buffers_->places[tet];
  const std::size_t columns = columns_;
  if (place < wide_place) {
    const std::size_t first = place & 0xffffff, right = place >> 24 & 15, down = place >> 28;
    for (std::size_t row = 0; row <= down; ++row)
      for (std::size_t column = 0; column <= right; ++column) visit(first + row * columns + column);
    return;
  }
  const std::array<PixelVertex, 4> corners = corners_of(*projected_, tet);
  const scene::PixelRect box = footprint(corners, {0, 0, grid_.image.width, grid_.image.height});
  const int size = grid_.tile_size;
  const bool crossing = crosses_eye_plane(corners);
  for (int row = box.y0 / size; row <= (box.y1 - 1) / size; ++row)
    for (int column = box.x0 / size; column <= (box.x1 - 1) / size; ++column) {
      const std::size_t tile = static_cast<std::size_t>(row) * columns + static_cast<std::size_t>(column);
      // The box of this cell is the whole window; the cell's tiles are those that no plane through the eye separates
      // from the cell.
      if (crossing && footprint(corners, grid_.rect(tile)).empty()) continue;
      visit(tile);
    }
}

TileLists::TileLists(const ProjectedMesh& projected, const TileGrid& grid,
                     const scene::TransferFunction& transfer_function, bool emits_without_extinction,
                     TileListSettings settings)
    : projected_(&projected),
      trace_(settings.trace),
      grid_(grid),
      stop_(std::move(settings.stop)),
      team_(settings.team),
      columns_(static_cast<std::size_t>(grid.columns())),
      buffers_(settings.buffers != nullptr ? settings.buffers : &own_),
      depth_origin_(nearest_depth(projected, team_)),
      view_(projected.near_depth, projected.far_depth, depth_origin_, grid.image, grid.tile_size),
      projected_tets_(projected.mesh->block_count()),
      in_one_tile_(projected_tets_.size()),
      tile_counts_(grid.count(), 0) {
  const scene::TetMeshView& mesh = projected.mesh->mesh();
  if (team_ == nullptr)
    buffers_->vertices.reset(projected.vertices.size());
  else
    buffers_->vertices.refer(team_->memory_of<CullVertex>(scene::Team::Room::cull_vertices, projected.vertices.size()),
                             projected.vertices.size());
  buffers_->places.reset(projected_tets_.size() * cull_block_cells);
  buffers_->near_depths.reset(projected_tets_.size() * cull_block_cells);
  buffers_->entries.clear();
  const bool per_cell = mesh.association == scene::Association::cell;
  const scene::Share vertices = scene::share_of(projected.vertices.size(), team_);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(vertices.first, vertices.last, 4096), [&](const auto& range) {
    scene::throw_if_stopped(stop_);
    const scene::TraceScope timing(trace_, "cull");
    const std::size_t n = range.end() - range.begin();
    make_cull_vertices(projected.vertices.subspan(range.begin(), n),
                       per_cell ? std::span<const double>() : std::span(mesh.scalars).subspan(range.begin(), n),
                       depth_origin_, buffers_->vertices.data() + range.begin());
  });

  const ClearIntervals clear =
      settings.cull_invisible
          ? ClearIntervals(transfer_function, emits_without_extinction,
                           projected.iso != nullptr ? projected.iso->values() : std::span<const double>())
          : ClearIntervals();
  if (team_ != nullptr) team_->barrier();
  const scene::Share blocks = scene::share_of(projected_tets_.size(), team_);
  runs_.resize(run_count(blocks.size(), grid.count()));
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    runs_[r].first_block = blocks.first + blocks.size() * r / runs_.size();
    runs_[r].last_block = blocks.first + blocks.size() * (r + 1) / runs_.size();
  }
  tbb::parallel_for(
      std::size_t{0}, runs_.size(),
      [&](std::size_t r) {
        const scene::TraceScope timing(trace_, "cull");
        cull(runs_[r], clear);
      },
      tbb::simple_partitioner());
  add_counts();
  add_reads(tile_counts_.size());
  reads_.serial_counters += runs_.size() * tile_counts_.size();
}

void TileLists::add_counts() {
  const std::size_t tiles = tile_counts_.size();
  std::vector<std::uint64_t> all;  // entries of all members, if there are several
  if (team_ != nullptr) {
    const auto members = static_cast<std::size_t>(team_->size()), rank = static_cast<std::size_t>(team_->rank());
    auto* const shared = team_->memory_of<std::uint32_t>(scene::Team::Room::tile_counts, members * tiles);
    std::uint32_t* const own = shared + rank * tiles;
    std::fill_n(own, tiles, 0);
    for (const Run& run : runs_)
      for (std::size_t i = 0; i < tiles; ++i) own[i] += run.tiles[i];
    team_->barrier();
    all.assign(tiles, 0);
    for (std::size_t m = 0; m < members; ++m) {
      if (m == rank) tile_counts_ = all;  // this member's entries follow those of the previous members
      for (std::size_t i = 0; i < tiles; ++i) all[i] += shared[m * tiles + i];
    }
  }
  for (Run& run : runs_) {
    counts_.invisible += run.culled.invisible;
    counts_.outside_view += run.culled.outside_view;
    counts_.between_pixels += run.culled.between_pixels;
    counts_.projected += run.culled.projected;
    for (std::size_t i = 0; i < tiles; ++i) {
      const std::uint32_t here = run.tiles[i];
      run.tiles[i] = static_cast<std::uint32_t>(tile_counts_[i]);  // less than the number of tets, so 32 bits suffice
      tile_counts_[i] += here;
    }
  }
  ends_ = tile_counts_;
  if (team_ != nullptr) tile_counts_ = std::move(all);
}

void TileLists::add_reads(std::size_t tiles) {
  for (Run& run : runs_) reads_.cells += std::exchange(run.cells_read, 0);
  reads_.counters += runs_.size() * tiles;
}

void TileLists::cull(Run& run, const ClearIntervals& clear) {
  const PreparedMesh& prepared = *projected_->mesh;
  const scene::TetMeshView& mesh = prepared.mesh();
  const bool per_cell = mesh.association == scene::Association::cell;
  CullCounts& counts = run.culled;
  run.tiles.assign(grid_.count(), 0);
  std::uint32_t* const tiles = run.tiles.data();
  std::vector<ClearFloats> clear_here;
  for (std::size_t block = run.first_block; block < run.last_block; ++block) {
    if (block % blocks_a_check == 0) scene::throw_if_stopped(stop_);
    const std::size_t first = block * cull_block_cells;
    const std::size_t n = std::min(cull_block_cells, mesh.tets.size() - first);
    run.cells_read += n;
    const auto [low, high] = prepared.block_scalar_bounds(block);
    if (clear.hold(low, high)) {
      counts.invisible += n;
      continue;
    }
    clear_here.clear();
    for (const ClearIntervals::Interval& interval : clear.meeting(low, high))
      clear_here.push_back(clear_floats(interval, prepared.scalars_are_floats()));
    CulledBlock culled = cull_cells(view_,
                                    {buffers_->vertices.data(), std::span(mesh.tets).subspan(first, n),
                                     per_cell ? mesh.scalars.data() + first : nullptr, clear_here},
                                    &buffers_->places[first], &buffers_->near_depths[first]);
    counts.invisible += static_cast<std::uint64_t>(std::popcount(culled.invisible));
    counts.outside_view += static_cast<std::uint64_t>(std::popcount(culled.outside_view));
    counts.between_pixels += static_cast<std::uint64_t>(std::popcount(culled.between_pixels));
    for (std::uint64_t unsure = culled.unsure; unsure != 0; unsure &= unsure - 1) {
      const auto cell = static_cast<std::size_t>(std::countr_zero(unsure));
      if (!cull_exactly(first + cell, clear, counts)) continue;
      culled.projected |= std::uint64_t{1} << cell;
      if (buffers_->places[first + cell] < most_places) culled.in_one_tile |= std::uint64_t{1} << cell;
    }
    counts.projected += static_cast<std::uint64_t>(std::popcount(culled.projected));
    projected_tets_[block] = culled.projected;
    in_one_tile_[block] = culled.in_one_tile;
    for_each_of(culled.in_one_tile, first, [&](std::size_t tet) { ++tiles[buffers_->places[tet]]; });
    for_each_of(culled.projected & ~culled.in_one_tile, first,
                [&](std::size_t tet) { for_each_tile(tet, [&](std::size_t tile) { ++tiles[tile]; }); });
  }
}

bool TileLists::cull_exactly(std::size_t tet, const ClearIntervals& clear, CullCounts& counts) {
  const auto [low, high] = projected_->mesh->scalar_bounds(tet);
  if (clear.hold(low, high)) {
    ++counts.invisible;
    return false;
  }
  const std::array<PixelVertex, 4> c = corners_of(*projected_, tet);
  const auto [nearest, farthest] = std::minmax({c[0].depth, c[1].depth, c[2].depth, c[3].depth});
  if (!(farthest > projected_->near_depth && nearest < projected_->far_depth)) {
    ++counts.outside_view;
    return false;
  }
  const scene::PixelRect window{0, 0, grid_.image.width, grid_.image.height}, box = footprint(c, window);
  if (box.empty()) {
    // If a corner is inside the window, the cell is in view but covers no pixel centre; otherwise it is out of view.
    const auto inside = [&](const PixelVertex& v) {
      return v.w > 0 && v.x > 0 && v.x < window.x1 * v.w && v.y > 0 && v.y < window.y1 * v.w;
    };
    ++(std::any_of(c.begin(), c.end(), inside) ? counts.between_pixels : counts.outside_view);
    return false;
  }
  buffers_->near_depths[tet] = depth_behind(depth_origin_, std::max(nearest, projected_->near_depth));
  const int column = box.x0 / grid_.tile_size, row = box.y0 / grid_.tile_size;
  const int right = (box.x1 - 1) / grid_.tile_size - column, down = (box.y1 - 1) / grid_.tile_size - row;
  const bool wide =
      right > largest_place_span || down > largest_place_span || grid_.count() > most_places || crosses_eye_plane(c);
  const auto bits = [](int number, int shift) { return static_cast<std::uint32_t>(number) << shift; };
  buffers_->places[tet] =
      wide ? wide_place : bits(row * grid_.columns() + column, 0) | bits(right, 24) | bits(down, 28);
  return true;
}

void TileLists::fill(std::size_t first, std::size_t last) {
  first_ = first;
  offsets_.assign(last - first + 1, 0);
  for (std::size_t i = first; i < last; ++i) offsets_[i - first + 1] = offsets_[i - first] + tile_counts_[i];
  if (team_ == nullptr)
    buffers_->entries.reset(offsets_.back());
  else
    buffers_->entries.refer(team_->memory_of<TileEntry>(scene::Team::Room::entries, offsets_.back()), offsets_.back());
  tbb::parallel_for(
      std::size_t{0}, runs_.size(),
      [&](std::size_t r) {
        const scene::TraceScope timing(trace_, "bin");
        fill(r, first, last);
      },
      tbb::simple_partitioner());
  add_reads(last - first);
  if (team_ != nullptr) team_->barrier();
}

void TileLists::fill(std::size_t r, std::size_t first, std::size_t last) {
  Run& run = runs_[r];
  std::vector<std::uint64_t> next(last - first);
  bool any = false;
  for (std::size_t i = first; i < last; ++i) {
    next[i - first] = offsets_[i - first] + run.tiles[i];
    any |= (r + 1 < runs_.size() ? runs_[r + 1].tiles[i] : ends_[i]) > run.tiles[i];
  }
  if (!any) return;
  TileEntry* const entries = buffers_->entries.data();
  const std::size_t tiles = last - first;
  const auto add = [&](std::size_t tet, std::size_t tile) {
    // For tiles before the band, the difference wraps around to a large number.
    if (tile - first < tiles)
      entries[next[tile - first]++] = {buffers_->near_depths[tet], static_cast<std::uint32_t>(tet)};
  };
  for (std::size_t block = run.first_block; block < run.last_block; ++block) {
    if (block % blocks_a_check == 0) scene::throw_if_stopped(stop_);
    const std::size_t first_tet = block * cull_block_cells;
    run.cells_read += static_cast<std::uint64_t>(std::popcount(projected_tets_[block]));
    for_each_of(in_one_tile_[block], first_tet, [&](std::size_t tet) { add(tet, buffers_->places[tet]); });
    for_each_of(projected_tets_[block] & ~in_one_tile_[block], first_tet,
                [&](std::size_t tet) { for_each_tile(tet, [&](std::size_t tile) { add(tet, tile); }); });
  }
}

std::span<TileEntry> TileLists::tile(std::size_t tile) {
  const std::size_t i = tile - first_;
  return {buffers_->entries.data() + offsets_[i], buffers_->entries.data() + offsets_[i + 1]};
}

std::size_t TileLists::bytes() const {
  // Each member of a team counts only its share of the buffers: the members share them, or the member uses only its
  // share of its own buffers.
  const std::size_t members = team_ != nullptr ? static_cast<std::size_t>(team_->size()) : 1;
  return (buffers_->vertices.bytes() + buffers_->places.bytes() + buffers_->near_depths.bytes() +
          buffers_->entries.bytes()) /
             members +
         (projected_tets_.capacity() + in_one_tile_.capacity()) * sizeof(std::uint64_t) +
         runs_.size() * grid_.count() * sizeof(std::uint32_t) +
         (tile_counts_.capacity() + ends_.capacity() + offsets_.capacity()) * sizeof(std::uint64_t);
}

}  // namespace tessera::projection
