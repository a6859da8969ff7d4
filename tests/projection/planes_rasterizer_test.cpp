// SPDX-License-Identifier: BSD-3-Clause
#include "projection/planes_rasterizer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <set>
#include <tuple>

#include "datasets/boxes.hpp"
#include "projection/views.hpp"
#include "reference/reference.hpp"
#include "support/instruction_sets.hpp"

namespace tessera::projection::planes_rasterizer_test {
namespace {

struct Segment {
  double front, back, scalar_front, scalar_back;
  std::uint32_t tet;
  auto operator<=>(const Segment&) const = default;
};
using Rays = std::vector<std::vector<Segment>>;  // by pixel, row-major, each in visibility order

/// All segments of a mesh, with the image rasterized in rectangles of `tile` pixels a side.
Rays rasterized(const scene::TetMesh& mesh, const scene::Camera& camera, scene::ImageSize size, int tile,
                RasterCounts* counts_out = nullptr) {
  const PreparedMesh prepared(mesh);
  const PixelSpace space(camera, size);
  std::vector<PixelVertex> vertices;
  for (const glm::dvec3& p : mesh.positions) vertices.push_back(space.project(p));
  const ProjectedMesh projected{&prepared, vertices, space.near_depth(), space.far_depth(), space.pixels_per_tangent()};
  std::vector<TileEntry> entries;
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) entries.push_back({0, t});
  Rays rays(static_cast<std::size_t>(size.width) * size.height);
  RasterCounts counts;
  for (int y = 0; y < size.height; y += tile)
    for (int x = 0; x < size.width; x += tile) {
      const scene::PixelRect rect{x, y, std::min(x + tile, size.width), std::min(y + tile, size.height)};
      RaySegments out;
      out.reserve(static_cast<std::size_t>(2 * rect.area()));
      for (std::size_t next = 0; next < entries.size();) {
        out.size = 0;
        const std::size_t taken = rasterize_planes(projected, std::span(entries).subspan(next), rect, out, counts);
        if (taken == 0) throw std::runtime_error("no progress");
        next += taken;
        for (std::size_t i = 0; i < out.size; ++i) {
          const int px = x + static_cast<int>(out.pixel(i)) % rect.width(),
                    py = y + static_cast<int>(out.pixel(i)) / rect.width();
          rays[static_cast<std::size_t>(py) * size.width + px].push_back(
              {out.front[i], out.back[i], out.scalar_front[i], out.scalar_back[i], out.tet(i)});
        }
      }
    }
  for (auto& ray : rays)
    std::sort(ray.begin(), ray.end(), [](const Segment& a, const Segment& b) {
      return std::tie(a.front, a.back, a.tet) < std::tie(b.front, b.back, b.tet);
    });
  if (counts_out != nullptr) *counts_out = counts;
  return rays;
}

/// The same cells on every ray as in the reference, and the same numbers up to rounding.
void expect_like_reference(const scene::TetMesh& mesh, const scene::Camera& camera, scene::ImageSize size) {
  const reference::Reference reference(mesh, camera, size, scene::TransferFunction({{0, {1, 1, 1}, 1}}));
  const Rays rays = rasterized(mesh, camera, size, 16);
  std::size_t hits = 0;
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const auto& ray = rays[static_cast<std::size_t>(y) * size.width + x];
      std::map<std::size_t, reference::RaySegment> expected;
      for (const auto& s : reference.segments(x + 0.5, y + 0.5)) expected[s.tet] = s;
      ASSERT_EQ(ray.size(), expected.size()) << "pixel " << x << "," << y;
      hits += !ray.empty();
      for (const Segment& s : ray) {
        const auto found = expected.find(s.tet);
        ASSERT_NE(found, expected.end()) << "pixel " << x << "," << y << " tet " << s.tet;
        // The projection has a rounding error (1e-16 of depths of order 5) in both. The slope of almost edge-on faces
        // magnifies it.
        EXPECT_NEAR(s.front, found->second.front, 1e-9);
        EXPECT_NEAR(s.back, found->second.back, 1e-9);
        EXPECT_NEAR(s.scalar_front, found->second.scalar_front, 1e-9);
        EXPECT_NEAR(s.scalar_back, found->second.scalar_back, 1e-9);
      }
    }
  EXPECT_GT(hits, 0u);
}

TEST(PlanesRasterizer, HitsTheReferencesCellsInEveryKindOfView) {
  const scene::TetMesh mesh = datasets::cube(5, 0.25);
  const scene::ImageSize size{40, 33};
  tests::for_each_instruction_set([&](const char* name) {
    SCOPED_TRACE(name);
    expect_like_reference(mesh, oblique(), size);
    expect_like_reference(mesh, perspective({3.1, 2.3, 4.2}, 35), size);
    expect_like_reference(mesh, perspective({0.11, 0.23, -0.17}, 100), size);  // eye inside: cells cross the eye plane
    scene::Camera near_cuts = perspective({3.1, 2.3, 4.2}, 35);
    near_cuts.clipping_range = scene::ClippingRange{5.2, 6.1};
    expect_like_reference(mesh, near_cuts, size);
    scene::Camera inside = oblique();
    inside.position = {0.1, 0.2, 0.3};
    inside.focal_point = {0, 0, 0};
    expect_like_reference(mesh, inside, size);
  });
}

TEST(PlanesRasterizer, KeepsTheTieRuleWhereVerticesAreOnPixelCentres) {
  const int n = 8;
  const scene::TetMesh mesh = datasets::cube(n, 0);
  const scene::ImageSize size{24, 24};
  tests::for_each_instruction_set([&](const char* name) {
    SCOPED_TRACE(name);
    expect_like_reference(mesh, aligned(n, size.height), size);
    RasterCounts counts;
    const Rays rays = rasterized(mesh, aligned(n, size.height), size, 32, &counts);
    EXPECT_GT(counts.exact_sign_tests, 0u);
    // The tie rule shifts rays right and down, so that 2n columns and 2n rows of pixels hit the box. Each of these rays
    // has the length 2 in the box, all others 0.
    std::size_t hit = 0;
    for (const auto& ray : rays) {
      if (ray.empty()) continue;
      ++hit;
      double length = 0;
      for (const Segment& s : ray) length += s.back - s.front;
      EXPECT_NEAR(length, 2, 1e-12);
    }
    EXPECT_EQ(hit, static_cast<std::size_t>(4 * n * n));
  });
}

TEST(PlanesRasterizer, NeighboursShareTheBitsOfTheirFace) {
  const scene::TetMesh mesh = datasets::cube(7, 0.25);
  tests::for_each_instruction_set([&](const char* name) {
    SCOPED_TRACE(name);
    for (const scene::Camera& camera :
         {oblique(), perspective({3.1, 2.3, 4.2}, 40), perspective({0.1, 0.2, 0.1}, 90)}) {
      std::size_t junctions = 0;
      for (const auto& ray : rasterized(mesh, camera, {48, 48}, 64))
        for (std::size_t i = 1; i < ray.size(); ++i, ++junctions) {
          ASSERT_EQ(ray[i - 1].back, ray[i].front);
          ASSERT_EQ(ray[i - 1].scalar_back, ray[i].scalar_front);
        }
      EXPECT_GT(junctions, 5000u);
    }
  });
}

TEST(PlanesRasterizer, NeighboursAgreeWhateverIndicesAndOrientationTheyUse) {
  // Every tet gets its own vertices, in a shuffled order.
  const scene::TetMesh whole = datasets::cube(4, 0.25);
  scene::TetMesh torn;
  std::mt19937 random(5);
  for (scene::Tet tet : whole.tets) {
    std::shuffle(tet.begin(), tet.end(), random);
    scene::Tet own;
    for (int i = 0; i < 4; ++i) {
      own[i] = static_cast<std::uint32_t>(torn.positions.size());
      torn.positions.push_back(whole.positions[tet[i]]);
      torn.scalars.push_back(whole.scalars[tet[i]]);
    }
    torn.tets.push_back(own);
  }
  EXPECT_EQ(rasterized(torn, oblique(), {40, 40}, 64), rasterized(whole, oblique(), {40, 40}, 64));
}

TEST(PlanesRasterizer, BitsDoNotDependOnTheRectangle) {
  const scene::TetMesh mesh = datasets::cube(5, 0.25);
  for (const scene::Camera& camera : {oblique(), perspective({0.1, 0.2, 0.1}, 90), aligned(5, 37)}) {
    const Rays whole = rasterized(mesh, camera, {41, 37}, 64);
    for (const int tile : {1, 3, 8, 16}) EXPECT_EQ(rasterized(mesh, camera, {41, 37}, tile), whole) << tile;
  }
}

TEST(PlanesRasterizer, FlatInvertedAndNeedleCellsTileTheRayToo) {
  // A box compressed to a thickness of 1e-9 along the ray, one stretched along it, and one of zero thickness.
  for (const double thickness : {1e-9, 1e6, 0.0}) {
    scene::TetMesh mesh = datasets::regular_split(3, 3, 3, glm::dvec3(2.0 / 3), {-1, -1, -1});
    for (glm::dvec3& p : mesh.positions) p.z *= 0.5 * thickness;
    for (std::size_t t = 0; t < mesh.tets.size(); t += 2) std::swap(mesh.tets[t][0], mesh.tets[t][3]);
    scene::Camera camera;
    camera.position = {0.013, 0.027, 1e6};
    camera.focal_point = {0.013, 0.027, 0};
    camera.parallel_scale = 1.3;
    for (const auto& ray : rasterized(mesh, camera, {24, 24}, 32)) {
      double length = 0;
      for (const Segment& s : ray) length += s.back - s.front;
      EXPECT_NEAR(length, ray.empty() ? 0 : thickness, 1e-9 * (1 + thickness));  // depths are 1e6: an ulp is 1e-10
    }
  }
}

TEST(PlanesRasterizer, NamesTheInstructionSetThatRan) {
  std::set<std::string> names;
  tests::for_each_instruction_set([&](const char* name) {
    EXPECT_EQ(instruction_set(), name);
    names.insert(name);
  });
  EXPECT_GE(names.size(), 1u);
}

}  // namespace
}  // namespace tessera::projection::planes_rasterizer_test
