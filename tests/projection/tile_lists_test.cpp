#include "projection/tile_lists.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "datasets/boxes.hpp"

namespace tessera::projection {
namespace {

struct Lists {
  Lists(const scene::TetMesh& mesh, const scene::Camera& camera, scene::ImageSize size, int tile,
        const scene::TransferFunction& function)
      : prepared(mesh), space(camera, size), grid{size, tile} {
    for (const glm::dvec3& p : mesh.positions) vertices.push_back(space.project(p));
    projected = {&prepared, vertices, space.near_depth(), space.far_depth()};
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
  // Visible from 0.9 up only.
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

}  // namespace
}  // namespace tessera::projection
