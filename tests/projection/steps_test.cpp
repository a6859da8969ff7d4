// SPDX-License-Identifier: BSD-3-Clause
#include "projection/steps.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "datasets/boxes.hpp"
#include "projection/pixel_space.hpp"

namespace tessera::projection::steps_test {
namespace {

constexpr scene::ImageSize size{24, 24};

double below(double v) { return std::nextafter(v, -1e300); }

struct Projected {
  explicit Projected(const scene::TetMesh& mesh) : prepared(mesh), space(camera(), size) {
    for (const glm::dvec3& p : mesh.positions) vertices.push_back(space.project(p));
  }
  static scene::Camera camera() {
    scene::Camera camera;
    camera.position = {3.1, 2.3, 4.2};
    camera.parallel_scale = 1.8;
    return camera;
  }
  [[nodiscard]] ProjectedMesh view() const {
    return {&prepared, vertices, space.near_depth(), space.far_depth(), space.pixels_per_tangent()};
  }
  PreparedMesh prepared;
  PixelSpace space;
  std::vector<PixelVertex> vertices;
};

TEST(SplitRasterizer, CutsSegmentsWhereTheyCrossStepsAndTilesThemWithThePieces) {
  const scene::TetMesh mesh = datasets::cube(3, 0.2);
  const Projected projected(mesh);
  const std::vector<Step> steps{{0.2, 1}, {0.45, 1}, {0.5, 1}, {0.8, 1}};
  SplitRasterizer<RaySegments> splitter;
  RasterCounts counts;
  const scene::PixelRect rect{0, 0, size.width, size.height};
  RaySegments whole;
  whole.reserve(static_cast<std::size_t>(rect.area()));
  std::size_t cuts = 0;
  for (std::uint32_t tet = 0; tet < mesh.tets.size(); ++tet) {
    const TileEntry entry{0, tet};
    whole.size = 0;
    rasterize_planes(projected.view(), {&entry, 1}, rect, whole, counts);
    const RaySegments& pieces = splitter.rasterize(projected.view(), steps, entry, rect, counts);
    std::map<std::uint32_t, std::vector<std::size_t>> of_pixel;
    for (std::size_t i = 0; i < pieces.size; ++i) {
      EXPECT_EQ(pieces.tet(i), tet);
      of_pixel[pieces.pixel(i)].push_back(i);
      const auto [low, high] = std::minmax(pieces.scalar_front[i], pieces.scalar_back[i]);
      for (const Step& step : steps) EXPECT_FALSE(low < step.value && step.value < high);
    }
    ASSERT_EQ(of_pixel.size(), whole.size);
    for (std::size_t i = 0; i < whole.size; ++i) {
      double at = whole.front[i], scalar = whole.scalar_front[i];
      for (const std::size_t k : of_pixel[whole.pixel(i)]) {
        EXPECT_EQ(pieces.front[k], at);
        EXPECT_NEAR(pieces.scalar_front[k], scalar, 1e-15);
        at = pieces.back[k], scalar = pieces.scalar_back[k];
      }
      EXPECT_EQ(at, whole.back[i]);
      EXPECT_NEAR(scalar, whole.scalar_back[i], 1e-15);
      cuts += of_pixel[whole.pixel(i)].size() - 1;
    }
  }
  EXPECT_GT(cuts, 100u);
}

TEST(SplitRasterizer, KeepsValuesJustBelowAStepBelowIt) {
  scene::TetMesh mesh = datasets::cube(2, 0.2);
  std::mt19937_64 random(5);
  for (double& s : mesh.scalars) s = random() % 2 == 0 ? 1 : below(1);
  const Projected projected(mesh);
  const std::vector<Step> steps{{1, 1}};
  SplitRasterizer<RaySegments> splitter;
  RasterCounts counts;
  for (std::uint32_t tet = 0; tet < mesh.tets.size(); ++tet) {
    const auto [low, high] = projected.prepared.scalar_bounds(tet);
    const RaySegments& pieces =
        splitter.rasterize(projected.view(), steps, {0, tet}, {0, 0, size.width, size.height}, counts);
    for (std::size_t i = 0; i < pieces.size; ++i) {
      const double least = std::min(pieces.scalar_front[i], pieces.scalar_back[i]);
      // In a cell with both values, everything is below the step except corners, edges and faces at the step.
      EXPECT_EQ(least < 1, low < 1) << low << ' ' << high;
      const scene::Lattice lattice{0, 0x1p-30, 0.5, 0x1p-30};
      const LatticeScalars on_lattice = lattice_scalars(pieces.scalar_front[i], pieces.scalar_back[i], steps, lattice);
      const auto step = static_cast<float>(lattice.scalar_step(1));
      EXPECT_EQ(std::min(on_lattice.front, on_lattice.back) < step, low < 1);
    }
  }
}

TEST(CellsAtSteps, AreThoseNearAStepWhoseScalarsDifferLittle) {
  scene::TetMesh mesh = datasets::cube(6, 0.2);
  const std::vector<Step> steps{{0.5, 1}};
  const scene::Lattice lattice{0, 0x1p-30, 0.5, 0x1p-30};
  const auto count = [&] {
    const PreparedMesh prepared(mesh);
    const CellsAtSteps cells(prepared, steps, 3.5, &lattice);
    std::size_t n = 0;
    for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) n += cells.contain(t) ? 1u : 0u;
    return n;
  };
  EXPECT_EQ(count(), 0u);  // a usual field changes by far more than a step of the lattice
  std::fill(mesh.scalars.begin(), mesh.scalars.end(), 0.5);
  EXPECT_EQ(count(), 0u);  // all at the step
  std::fill(mesh.scalars.begin(), mesh.scalars.end(), below(0.5));
  EXPECT_EQ(count(), mesh.tets.size());  // the scalars are one last place below the step; the lattice maps them to it
  for (std::size_t v = 0; v < mesh.scalars.size(); v += 2) mesh.scalars[v] = 0.5 + 1e-9;
  EXPECT_GT(count(), mesh.tets.size() / 2);
}

}  // namespace
}  // namespace tessera::projection::steps_test
