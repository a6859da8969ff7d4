// SPDX-License-Identifier: BSD-3-Clause
#include "projection/tile_lists.hpp"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>

#include "datasets/boxes.hpp"
#include "support/instruction_sets.hpp"

namespace tessera::projection::tile_lists_test {
namespace {

struct Lists {
  Lists(const scene::TetMesh& mesh, const scene::Camera& camera, scene::ImageSize size, int tile,
        const scene::TransferFunction& function)
      : prepared(mesh), space(camera, size), grid{size, tile} {
    for (const glm::dvec3& p : mesh.positions) vertices.push_back(space.project(p));
    projected = {&prepared, vertices, space.near_depth(), space.far_depth(), space.pixels_per_tangent()};
    lists.emplace(projected, grid, function, false);
  }
  PreparedMesh prepared;
  PixelSpace space;
  TileGrid grid;
  std::vector<PixelVertex> vertices;
  ProjectedMesh projected{};
  std::optional<TileLists> lists;
};

scene::TransferFunction opaque() { return scene::TransferFunction({{0, {1, 1, 1}, 1}}); }

TEST(TileLists, EveryCellIsInEveryTileWhereItHasASegment) {
  const scene::TetMesh mesh = datasets::cube(4, 0.2);
  for (const bool eye_inside : {false, true}) {
    scene::Camera camera;
    camera.position = eye_inside ? glm::dvec3(0.1, 0.2, 0.3) : glm::dvec3(3, 2, 4);
    camera.projection = scene::ProjectionKind::perspective;
    camera.view_angle = eye_inside ? 90 : 30;
    Lists all(mesh, camera, {50, 40}, 8, opaque());
    all.lists->fill(0, all.grid.count());
    for (std::size_t tile = 0; tile < all.grid.count(); ++tile) {
      std::set<std::uint32_t> listed;
      std::map<std::uint32_t, float> near_depth;
      for (const TileEntry& e : all.lists->tile(tile)) {
        listed.insert(e.tet);
        near_depth[e.tet] = e.near_depth;
      }
      EXPECT_EQ(listed.size(), all.lists->entry_count(tile));
      std::vector<TileEntry> every;
      for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) every.push_back({0, t});
      RaySegments segments;
      segments.reserve(1 << 20);
      RasterCounts counts;
      ASSERT_EQ(rasterize_planes(all.projected, every, all.grid.rect(tile), segments, counts), every.size());
      for (std::size_t i = 0; i < segments.size; ++i) {
        ASSERT_TRUE(listed.count(segments.tet(i))) << "tile " << tile << " tet " << segments.tet(i);
        EXPECT_LE(all.lists->depth_origin() + near_depth[segments.tet(i)], segments.front[i]);
      }
    }
  }
}

TEST(TileLists, FilledBandByBandTheListsAreTheSame) {
  const scene::TetMesh mesh = datasets::cube(4, 0.2);
  scene::Camera camera;
  camera.position = {3, 2, 4};
  camera.parallel_scale = 1.7;
  Lists whole(mesh, camera, {50, 40}, 8, opaque()), banded(mesh, camera, {50, 40}, 8, opaque());
  whole.lists->fill(0, whole.grid.count());
  for (std::size_t first = 0; first < banded.grid.count(); first += 5) {
    const std::size_t last = std::min(first + 5, banded.grid.count());
    banded.lists->fill(first, last);
    for (std::size_t tile = first; tile < last; ++tile) {
      const auto a = whole.lists->tile(tile), b = banded.lists->tile(tile);
      ASSERT_EQ(a.size(), b.size());
      for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].tet, b[i].tet);
    }
  }
}

TEST(TileLists, CountsWhyCellsAreLeftOut) {
  const scene::TetMesh mesh = datasets::cube(6, 0.2);
  scene::Camera camera;
  camera.position = {0, 0, 5};
  camera.parallel_scale = 0.4;  // the window is smaller than the box
  // Visible only from 0.9 up.
  const scene::TransferFunction function({{0.9, {1, 1, 1}, 0}, {1, {1, 1, 1}, 5}});
  Lists lists(mesh, camera, {30, 30}, 8, function);
  const CullCounts& counts = lists.lists->counts();
  std::uint64_t invisible = 0;
  for (const scene::Tet& t : mesh.tets) {
    double most = 0;
    for (const auto v : t) most = std::max(most, mesh.scalars[v]);
    invisible += most <= 0.9;
  }
  EXPECT_EQ(counts.invisible, invisible);
  EXPECT_GT(counts.outside_view, 0u);
  EXPECT_EQ(counts.invisible + counts.outside_view + counts.between_pixels + counts.projected, mesh.tets.size());

  Lists coarse(mesh, camera, {1, 1}, 8, opaque());
  EXPECT_GT(coarse.lists->counts().between_pixels, 0u);

  camera.clipping_range = scene::ClippingRange{100, 200};
  Lists behind(mesh, camera, {30, 30}, 8, opaque());
  EXPECT_EQ(behind.lists->counts().outside_view, mesh.tets.size());
}

/// The result of culling in double precision, one cell after the other.
struct Expected {
  CullCounts counts;
  std::vector<std::vector<std::uint32_t>> tiles;
};

Expected expected_lists(const ProjectedMesh& projected, const TileGrid& grid, const scene::TransferFunction& function,
                        bool independent) {
  Expected all{{}, std::vector<std::vector<std::uint32_t>>(grid.count())};
  const scene::PixelRect window{0, 0, grid.image.width, grid.image.height};
  for (std::uint32_t t = 0; t < projected.mesh->tet_count(); ++t) {
    const auto [low, high] = projected.mesh->scalar_bounds(t);
    std::array<PixelVertex, 4> c;
    for (int i = 0; i < 4; ++i) c[i] = projected.vertices[projected.mesh->mesh().tets[t][i]];
    const auto [nearest, farthest] = std::minmax({c[0].depth, c[1].depth, c[2].depth, c[3].depth});
    const scene::PixelRect box = footprint(c, window);
    const auto inside = [&](const PixelVertex& v) {
      return v.w > 0 && v.x > 0 && v.x < window.x1 * v.w && v.y > 0 && v.y < window.y1 * v.w;
    };
    if (!function.visible(low, high, independent)) {
      ++all.counts.invisible;
    } else if (!(farthest > projected.near_depth && nearest < projected.far_depth)) {
      ++all.counts.outside_view;
    } else if (box.empty()) {
      ++(std::any_of(c.begin(), c.end(), inside) ? all.counts.between_pixels : all.counts.outside_view);
    } else {
      ++all.counts.projected;
      const bool crossing = std::any_of(c.begin(), c.end(), [](const PixelVertex& v) { return !(v.w > 0); });
      for (std::size_t tile = 0; tile < grid.count(); ++tile) {
        const scene::PixelRect r = grid.rect(tile);
        const bool meets =
            crossing ? !footprint(c, r).empty() : r.x0 < box.x1 && box.x0 < r.x1 && r.y0 < box.y1 && box.y0 < r.y1;
        if (meets) all.tiles[tile].push_back(t);
      }
    }
  }
  return all;
}

scene::TransferFunction stepped() {
  return scene::TransferFunction({{0.2, {1, 1, 1}, 0},
                                  {0.25, {1, 1, 1}, 1},
                                  {0.25, {0, 0, 0}, 0},
                                  {0.5, {0, 0, 0}, 0},
                                  {0.5, {1, 1, 1}, 2},
                                  {0.6, {1, 1, 1}, 0}});
}

struct View {
  const char* name;
  scene::Camera camera;
  scene::ImageSize size;
  int tile_size;
};

std::vector<View> views() {
  std::vector<View> all;
  scene::Camera camera;
  camera.position = {3, 2, 4};
  camera.parallel_scale = 1.7;
  all.push_back({"whole mesh", camera, {100, 75}, 32});
  all.push_back({"tiles of one pixel", camera, {60, 41}, 1});
  all.push_back({"one pixel", camera, {1, 1}, 32});
  camera.parallel_scale = 0.3;
  all.push_back({"window inside the mesh", camera, {64, 64}, 8});
  camera.clipping_range = scene::ClippingRange{4.5, 5.5};
  all.push_back({"clipped", camera, {64, 64}, 8});
  camera = {};
  camera.position = {0, 0, 5};
  camera.parallel_scale = 1;  // on a lattice of 1/4 all vertices are on pixel corners
  all.push_back({"along an axis", camera, {16, 16}, 4});
  camera.projection = scene::ProjectionKind::perspective;
  camera.position = {3, 2, 4};
  camera.view_angle = 30;
  all.push_back({"perspective", camera, {100, 75}, 16});
  camera.position = {0.1, 0.2, 0.3};
  camera.view_angle = 90;
  all.push_back({"eye inside", camera, {50, 40}, 8});
  camera.position = {-1, -0.5, 0.25};
  camera.clipping_range = scene::ClippingRange{0.3, 1.2};
  all.push_back({"eye on the face, clipped", camera, {50, 40}, 8});
  return all;
}

void expect_lists(const scene::TetMesh& mesh, const View& view, const scene::TransferFunction& function,
                  bool independent, const std::string& where) {
  const PreparedMesh prepared(mesh);
  const PixelSpace space(view.camera, view.size);
  std::vector<PixelVertex> vertices(mesh.positions.size());
  space.project(mesh.positions, vertices);
  const ProjectedMesh projected{&prepared, vertices, space.near_depth(), space.far_depth(), space.pixels_per_tangent()};
  const TileGrid grid{view.size, view.tile_size};
  const Expected expected = expected_lists(projected, grid, function, independent);
  TileListBuffers buffers;
  for (const bool again : {false, true}) {
    TileLists lists(projected, grid, function, independent, {.buffers = again ? &buffers : nullptr});
    EXPECT_EQ(lists.counts().invisible, expected.counts.invisible) << where;
    EXPECT_EQ(lists.counts().outside_view, expected.counts.outside_view) << where;
    EXPECT_EQ(lists.counts().between_pixels, expected.counts.between_pixels) << where;
    EXPECT_EQ(lists.counts().projected, expected.counts.projected) << where;
    lists.fill(0, grid.count());
    for (std::size_t tile = 0; tile < grid.count(); ++tile) {
      ASSERT_EQ(lists.entry_count(tile), expected.tiles[tile].size()) << where << ", tile " << tile;
      const std::span<TileEntry> entries = lists.tile(tile);
      // In the order of blocks; within a block tets of a single tile come first.
      const auto by_block = [](const TileEntry& a, const TileEntry& b) { return a.tet / 64 < b.tet / 64; };
      EXPECT_TRUE(std::is_sorted(entries.begin(), entries.end(), by_block)) << where << ", tile " << tile;
      std::sort(entries.begin(), entries.end(), [](const TileEntry& a, const TileEntry& b) { return a.tet < b.tet; });
      for (std::size_t i = 0; i < expected.tiles[tile].size(); ++i) {
        const TileEntry& entry = entries[i];
        ASSERT_EQ(entry.tet, expected.tiles[tile][i]) << where << ", tile " << tile;
        double nearest = HUGE_VAL;
        for (const auto v : mesh.tets[entry.tet]) nearest = std::min(nearest, vertices[v].depth);
        nearest = std::max(nearest, projected.near_depth);
        EXPECT_LE(lists.depth_origin() + entry.near_depth, nearest) << where;
        // The tolerance is the rounding of floats and the margin for it.
        EXPECT_GE(lists.depth_origin() + entry.near_depth, nearest - 4e-7 * (nearest - lists.depth_origin()) - 1e-14);
      }
    }
  }
}

TEST(TileLists, MatchDoublePrecisionOnEveryInstructionSet) {
  const auto check = [](const std::string& where) {
    scene::TetMesh jittered = datasets::cube(7, 0.2);
    scene::TetMesh on_knots = datasets::regular_split(8, 8, 8, glm::dvec3(0.25), glm::dvec3(-1));
    for (double& s : on_knots.scalars) s = std::round(s * 20) / 20;
    scene::TetMesh fine = jittered;
    for (double& s : fine.scalars) s = s * 0.999 + 1e-12;  // no longer float numbers
    scene::TetMesh per_cell = on_knots;
    per_cell.association = scene::Association::cell;
    per_cell.scalars.resize(per_cell.tets.size());
    for (std::size_t t = 0; t < per_cell.scalars.size(); ++t) per_cell.scalars[t] = static_cast<double>(t % 21) / 20;
    for (const View& view : views())
      for (const auto& function : {opaque(), stepped()})
        for (const auto& [name, mesh] : {std::pair{"jittered", &jittered}, std::pair{"on knots", &on_knots},
                                         std::pair{"fine", &fine}, std::pair{"per cell", &per_cell}})
          for (const bool independent : {false, true})
            expect_lists(*mesh, view, function, independent,
                         where + ", " + view.name + ", " + name + ", knots " + std::to_string(function.knots().size()));
  };
  tests::for_each_instruction_set(check);
}

TEST(TileLists, HoldInScenesOfAnySize) {
  for (const double size : {1e-30, 1e-20, 1e20, 1e30, 1e100}) {
    scene::TetMesh mesh = datasets::cube(4, 0.2);
    for (glm::dvec3& p : mesh.positions) p *= size;
    for (double& s : mesh.scalars) s *= size;
    View view{"scaled", {}, {40, 40}, 8};
    view.camera.position = glm::dvec3(3, 2, 4) * size;
    view.camera.parallel_scale = 1.7 * size;
    const scene::TransferFunction function({{0.5 * size, {1, 1, 1}, 0}, {0.6 * size, {1, 1, 1}, 1}});
    const PreparedMesh prepared(mesh);
    const PixelSpace space(view.camera, view.size);
    std::vector<PixelVertex> vertices(mesh.positions.size());
    space.project(mesh.positions, vertices);
    const ProjectedMesh projected{&prepared, vertices, space.near_depth(), space.far_depth(),
                                  space.pixels_per_tangent()};
    const TileGrid grid{view.size, view.tile_size};
    const Expected expected = expected_lists(projected, grid, function, false);
    TileLists lists(projected, grid, function, false);
    lists.fill(0, grid.count());
    EXPECT_EQ(lists.counts().invisible, expected.counts.invisible) << size;
    EXPECT_EQ(lists.counts().projected, expected.counts.projected) << size;
    for (std::size_t tile = 0; tile < grid.count(); ++tile)
      ASSERT_EQ(lists.entry_count(tile), expected.tiles[tile].size()) << size;
  }
}

TEST(TileLists, AreTheSameForAnyNumberOfThreads) {
  const scene::TetMesh mesh = datasets::cube(12, 0.2);
  scene::Camera camera;
  camera.position = {3, 2, 4};
  camera.parallel_scale = 1.7;
  std::vector<std::vector<TileEntry>> lists;
  for (const int threads : {1, 3, 16}) {
    tbb::task_arena arena(threads);
    arena.execute([&] {
      Lists all(mesh, camera, {200, 150}, 16, opaque());
      all.lists->fill(0, all.grid.count());
      auto& entries = lists.emplace_back();
      for (std::size_t tile = 0; tile < all.grid.count(); ++tile)
        entries.insert(entries.end(), all.lists->tile(tile).begin(), all.lists->tile(tile).end());
    });
  }
  for (const auto& other : {lists[1], lists[2]}) {
    ASSERT_EQ(other.size(), lists[0].size());
    for (std::size_t i = 0; i < other.size(); ++i) {
      ASSERT_EQ(other[i].tet, lists[0][i].tet);
      ASSERT_EQ(other[i].near_depth, lists[0][i].near_depth);
    }
  }
}

TEST(TileLists, ReadEachCellTwiceHoweverManyTasks) {
  const scene::TetMesh mesh = datasets::cube(24, 0.2);
  scene::Camera camera;
  camera.position = {3, 2, 4};
  camera.parallel_scale = 1.7;
  for (const int threads : {1, 64}) {
    tbb::task_arena arena(threads);
    arena.execute([&] {
      Lists all(mesh, camera, {200, 150}, 16, opaque());
      EXPECT_EQ(all.lists->reads().cells, mesh.tets.size()) << threads << " threads";
      const std::uint64_t counters = all.lists->reads().counters;
      all.lists->fill(0, all.grid.count());
      EXPECT_EQ(all.lists->reads().cells, mesh.tets.size() + all.lists->counts().projected) << threads << " threads";
      // There are eight runs per thread, each with separate counters.
      EXPECT_EQ(all.lists->reads().serial_counters, counters);
      EXPECT_EQ(counters, 8 * static_cast<std::uint64_t>(threads) * all.grid.count()) << threads << " threads";
    });
  }
}

}  // namespace
}  // namespace tessera::projection::tile_lists_test
