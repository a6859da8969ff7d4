// SPDX-License-Identifier: BSD-3-Clause
#include "projection/scanline/scanline_rasterizer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/vec2.hpp>
#include <map>
#include <random>
#include <set>
#include <tuple>

#include "datasets/boxes.hpp"
#include "datasets/modify.hpp"
#include "datasets/shapes.hpp"
#include "support/instruction_sets.hpp"
#include "support/some_cases.hpp"

namespace tessera::projection::scanline_rasterizer_test {
namespace {

struct Segment {
  double front, back, scalar_front, scalar_back;
  auto operator<=>(const Segment&) const = default;
};
/// By pixel, row-major, then by tet: at most one segment each.
using Rays = std::vector<std::map<std::uint32_t, Segment>>;

enum class Rasterizer { planes, scanline };

struct Frame {
  const scene::TetMesh& mesh;
  PreparedMesh prepared;
  std::vector<PixelVertex> vertices;
  ProjectedMesh projected;
  float edge;

  explicit Frame(const scene::TetMesh& m) : mesh(m), prepared(m), edge(longest_edge(m)) {}
  Frame(const scene::TetMesh& m, const scene::Camera& camera, scene::ImageSize size) : Frame(m) {
    const PixelSpace space(camera, size);
    for (const glm::dvec3& p : m.positions) vertices.push_back(space.project(p));
    projected = {&prepared, vertices, space.near_depth(), space.far_depth(), space.pixels_per_tangent()};
  }
};

/// All segments of an image rasterized in rectangles of `tile` pixels a side; checks invariants that hold for any
/// input.
Rays rasterized(const Frame& frame, scene::ImageSize size, int tile, Rasterizer rasterizer = Rasterizer::scanline,
                RasterCounts* counts_out = nullptr) {
  std::vector<TileEntry> entries;
  for (std::uint32_t t = 0; t < frame.mesh.tets.size(); ++t) entries.push_back({0, t});
  Rays rays(static_cast<std::size_t>(size.width) * size.height);
  RasterCounts counts;
  ScanlineBuffers buffers;
  for (int y = 0; y < size.height; y += tile)
    for (int x = 0; x < size.width; x += tile) {
      const scene::PixelRect rect{x, y, std::min(x + tile, size.width), std::min(y + tile, size.height)};
      RaySegments out;
      out.reserve(static_cast<std::size_t>(2 * rect.area()));
      for (std::size_t next = 0; next < entries.size();) {
        out.size = 0;
        const auto rest = std::span(entries).subspan(next);
        const std::size_t taken =
            rasterizer == Rasterizer::scanline
                ? rasterize_scanline({frame.projected, frame.edge}, rest, rect, buffers, out, counts)
                : rasterize_planes(frame.projected, rest, rect, out, counts);
        if (taken == 0) throw std::runtime_error("no progress");
        next += taken;
        if (out.size > out.capacity()) throw std::runtime_error("more segments than room");
        for (std::size_t i = 0; i < out.size; ++i) {
          if (out.pixel(i) >= static_cast<std::uint32_t>(rect.area())) throw std::runtime_error("a pixel outside");
          const int px = x + static_cast<int>(out.pixel(i)) % rect.width(),
                    py = y + static_cast<int>(out.pixel(i)) / rect.width();
          const bool fresh =
              rays[static_cast<std::size_t>(py) * size.width + px]
                  .insert({out.tet(i), {out.front[i], out.back[i], out.scalar_front[i], out.scalar_back[i]}})
                  .second;
          if (!fresh) throw std::runtime_error("two segments of one cell in one pixel");
        }
      }
    }
  if (counts_out != nullptr) *counts_out = counts;
  return rays;
}

scene::Camera down_z(double distance, double scale, glm::dvec2 at = {0, 0}) {
  scene::Camera camera;
  camera.position = {at.x, at.y, distance};
  camera.focal_point = {at.x, at.y, 0};
  camera.parallel_scale = scale;
  return camera;
}

scene::Camera oblique() {
  scene::Camera camera;
  camera.position = {3.1, 2.3, 4.2};
  camera.parallel_scale = 1.8;
  return camera;
}

/// Smallest distance of a pixel centre to a projected edge, in pixels.
double closest_edge(const Frame& frame, scene::ImageSize size) {
  double closest = HUGE_VAL;
  for (const scene::Tet& tet : frame.mesh.tets)
    for (int i = 0; i < 4; ++i)
      for (int j = i + 1; j < 4; ++j) {
        const PixelVertex &a = frame.vertices[tet[i]], &b = frame.vertices[tet[j]];
        const double dx = b.x - a.x, dy = b.y - a.y, length2 = dx * dx + dy * dy;
        for (int y = 0; y < size.height; ++y)
          for (int x = 0; x < size.width; ++x) {
            const double px = x + 0.5 - a.x, py = y + 0.5 - a.y;
            const double along = std::clamp((px * dx + py * dy) / length2, 0.0, 1.0);
            closest = std::min(closest, std::hypot(px - along * dx, py - along * dy));
          }
      }
  return closest;
}

TEST(ScanlineRasterizer, ACornerOfACubeMatchesTheHandCalculation) {
  // Corners at 0, x, y, z: along z from height 5, a ray enters at z = 1 - x - y and leaves at z = 0.
  const scene::TetMesh mesh = datasets::single_tet();
  const scene::ImageSize size{64, 64};
  const Frame frame(mesh, down_z(5, 0.6, {0.4, 0.4}), size);
  EXPECT_EQ(frame.edge, std::sqrt(2.0f));
  tests::for_each_instruction_set([&](const char* name) {
    SCOPED_TRACE(name);
    const Rays rays = rasterized(frame, size, 16);
    std::size_t inside = 0;
    for (int j = 0; j < size.height; ++j)
      for (int i = 0; i < size.width; ++i) {
        const double x = -0.2 + (i + 0.5) * 1.2 / 64, y = 1.0 - (j + 0.5) * 1.2 / 64, z = 1 - x - y;
        const auto& ray = rays[static_cast<std::size_t>(j) * size.width + i];
        if (std::min({x, y, z}) < -1e-3) {
          EXPECT_TRUE(ray.empty());
        }
        if (std::min({x, y, z}) < 1e-3) continue;
        ++inside;
        ASSERT_EQ(ray.size(), 1u);
        const Segment& s = ray.begin()->second;
        // Floats of pixel coordinates up to 64 and depths up to 5 have a few rounding errors of 2^-24 of their values.
        EXPECT_NEAR(s.front, 5 - z, 2e-6);
        EXPECT_NEAR(s.back, 5, 2e-6);
        EXPECT_NEAR(s.scalar_front, x / 3 + y * 2 / 3 + z, 2e-6);
        EXPECT_NEAR(s.scalar_back, x / 3 + y * 2 / 3, 2e-6);
      }
    EXPECT_GT(inside, 1000u);
  });
}

TEST(ScanlineRasterizer, IsPlanesToFloatRoundingWhereNoRayComesNearAnEdge) {
  const scene::TetMesh mesh = datasets::cube(3, 0.25);
  const scene::ImageSize size{31, 27};
  const Frame frame(mesh, oblique(), size);
  ASSERT_GT(closest_edge(frame, size), 1e-4);  // float rounds a pixel coordinate of this image by 1e-6
  const Rays exact = rasterized(frame, size, 16, Rasterizer::planes);
  tests::for_each_instruction_set([&](const char* name) {
    SCOPED_TRACE(name);
    RasterCounts counts;
    const Rays rays = rasterized(frame, size, 16, Rasterizer::scanline, &counts);
    EXPECT_EQ(counts.unpaired, 0u);
    std::size_t segments = 0;
    for (std::size_t p = 0; p < rays.size(); ++p) {
      ASSERT_EQ(rays[p].size(), exact[p].size()) << p;
      segments += rays[p].size();
      for (const auto& [tet, s] : rays[p]) {
        const auto found = exact[p].find(tet);
        ASSERT_NE(found, exact[p].end());
        // Pixel coordinates have errors of 1e-6 and depths of 5e-7, magnified by the steepest face of this mesh.
        EXPECT_NEAR(s.front, found->second.front, 2e-5);
        EXPECT_NEAR(s.back, found->second.back, 2e-5);
        EXPECT_NEAR(s.scalar_front, found->second.scalar_front, 2e-5);
        EXPECT_NEAR(s.scalar_back, found->second.scalar_back, 2e-5);
      }
    }
    EXPECT_GT(segments, 1000u);
  });
}

TEST(ScanlineRasterizer, BitsDoNotDependOnTheRectangle) {
  const scene::TetMesh meshes[] = {datasets::cube(5, 0.25), datasets::slivers(4, 1e5),
                                   datasets::regular_split(4, 4, 4, glm::dvec3(0.5), glm::dvec3(-1))};
  const scene::ImageSize size{41, 37};
  for (const scene::TetMesh& mesh : meshes)
    // Oblique; edge-on faces and vertices on pixel centres; close up, cells larger than the image.
    for (const scene::Camera& camera :
         {oblique(), down_z(5, 37.0 / 32, {1 / 32., -1 / 32.}), down_z(5, 0.03, {0.21, 0.37})}) {
      const Frame frame(mesh, camera, size);
      RasterCounts counts;
      const Rays whole = rasterized(frame, size, 64, Rasterizer::scanline, &counts);
      for (const int tile : {1, 3, 8, 16}) {
        RasterCounts in_tiles;
        EXPECT_EQ(rasterized(frame, size, tile, Rasterizer::scanline, &in_tiles), whole) << tile;
        EXPECT_EQ(in_tiles.unpaired, counts.unpaired);
      }
    }
}

TEST(ScanlineRasterizer, CellDataIsTheCellsValueAtBothEnds) {
  const scene::TetMesh mesh = datasets::with_cell_data(datasets::cube(3, 0.25));
  for (const auto& ray : rasterized(Frame(mesh, oblique(), {24, 24}), {24, 24}, 8))
    for (const auto& [tet, s] : ray) {
      EXPECT_EQ(s.scalar_front, static_cast<float>(mesh.scalars[tet]));
      EXPECT_EQ(s.scalar_back, static_cast<float>(mesh.scalars[tet]));
    }
}

TEST(ScanlineRasterizer, TheClippingRangeCutsSegments) {
  // The scalar is the depth, so a cut is correct if the scalar still equals the depth.
  scene::TetMesh mesh = datasets::cube(3, 0.2);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) mesh.scalars[v] = 5 - mesh.positions[v].z;
  scene::Camera camera = down_z(5, 0.8, {0.01, 0.02});
  camera.clipping_range = scene::ClippingRange{4.4, 5.25};
  std::size_t rays = 0;
  for (const auto& ray : rasterized(Frame(mesh, camera, {16, 16}), {16, 16}, 16)) {
    double length = 0;
    for (const auto& [tet, s] : ray) {
      length += s.back - s.front;
      EXPECT_NEAR(s.scalar_front, s.front, 2e-5);
      EXPECT_NEAR(s.scalar_back, s.back, 2e-5);
    }
    EXPECT_NEAR(length, 0.85, 2e-5);
    ++rays;
  }
  EXPECT_EQ(rays, 256u);
}

TEST(ScanlineRasterizer, AnyCoordinatesStayInsideTheBuffers) {
  // rasterized() checks pixels, counts and capacity, a sanitizer build the rest. Depths and scalars stay small, so all
  // results must be finite.
  std::mt19937 random(11);
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  const scene::ImageSize size{23, 19};
  const auto pixel = [&]() -> double {
    switch (random() % 7) {
      case 0:
        return std::copysign(std::pow(10.0, uniform(-30, 30)), uniform(-1, 1));
      case 1:
        return std::copysign(1e30, uniform(-1, 1));
      case 2:
        return static_cast<double>(random() % 24) + 0.5;  // on a centre
      case 3:
        return static_cast<double>(random() % 24);
      case 4:
        return 11.5 + uniform(-1e-6, 1e-6);
      default:
        return uniform(-5, 28);
    }
  };
  scene::TetMesh mesh;
  for (int i = 0; i < 400; ++i) {
    const auto base = static_cast<std::uint32_t>(mesh.positions.size());
    for (int k = 0; k < 4; ++k) mesh.positions.emplace_back(), mesh.scalars.push_back(uniform(-1, 1));
    mesh.tets.push_back({base, base + 1, base + 2, base + 3});
  }
  test::SomeCases some(5);
  for (int round = 0; round < 40; ++round) {
    if (!some.next()) continue;
    Frame frame(mesh);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
      frame.vertices.push_back({pixel(), pixel(), 1, random() % 3 == 0 ? 5.0 : uniform(1, 9)});
    // Cells that are flat in the image, or have only one or two points.
    for (std::size_t t = 0; t < mesh.tets.size(); t += 5) {
      PixelVertex* c = &frame.vertices[mesh.tets[t][0]];
      if (t % 2 == 0) c[3].x = c[2].x, c[3].y = c[2].y;
      c[1].y = c[0].y = c[2].y;
    }
    const bool cut = round % 2 == 1;
    frame.projected = {&frame.prepared, frame.vertices, cut ? 3.0 : 0.0, cut ? 6.0 : HUGE_VAL, 0};
    ASSERT_TRUE(fits_scanline(frame.projected, frame.edge));
    std::size_t segments = 0;
    const Rays whole = rasterized(frame, size, 64);
    for (const auto& ray : whole)
      for (const auto& [tet, s] : ray) {
        ++segments;
        for (const double value : {s.front, s.back, s.scalar_front, s.scalar_back})
          ASSERT_TRUE(std::isfinite(value)) << "round " << round << " tet " << tet;
        ASSERT_LE(s.front, s.back);
        ASSERT_GE(s.back, cut ? 3 : 1);  // not in front of the nearest vertex or the near plane
      }
    EXPECT_GT(segments, 1000u);
    EXPECT_EQ(rasterized(frame, size, 7), whole);
  }
}

TEST(ScanlineRasterizer, ReportsScenesThatFloatsDoNotHold) {
  const scene::TetMesh mesh = datasets::cube(2, 0);
  const auto fits = [](scene::TetMesh m, double scale) {
    m = datasets::transformed(m, scale, glm::dvec3(0));
    scene::Camera camera = oblique();
    camera.position *= scale;
    camera.parallel_scale *= scale;
    const Frame frame(m, camera, {8, 8});
    return fits_scanline(frame.projected, frame.edge);
  };
  EXPECT_TRUE(fits(mesh, 1));
  EXPECT_TRUE(fits(mesh, 1e20));
  EXPECT_TRUE(fits(mesh, 1e-20));
  EXPECT_FALSE(fits(mesh, 1e37));
  EXPECT_FALSE(fits(mesh, 1e-31));
  scene::TetMesh steep = mesh;
  steep.scalars[3] = -1e38;
  EXPECT_FALSE(fits(steep, 1));
}

TEST(SegmentTuple, GivesBackTheFloatsThatTheRasterizerMade) {
  // The mesh is seen from far away, where lengths are a few units of the depth's last place, and from near.
  for (const double distance : {3.0, 5.0, 100.0, 1e4, 1e6})
    for (const double scale : {1.0, 3e-12, 7e15}) {
      scene::Camera camera = down_z(distance, 1.2, {0.013, 0.027});
      camera.position *= scale;
      camera.focal_point *= scale;
      camera.parallel_scale *= scale;
      const scene::TetMesh mesh = datasets::transformed(datasets::cube(6, 0.25), scale, glm::dvec3(0));
      const Frame frame(mesh, camera, {32, 32});
      std::vector<TileEntry> entries;
      for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) entries.push_back({0, t});
      RaySegments out, back;
      out.reserve(100'000);
      back.reserve(1);
      ScanlineBuffers buffers;
      RasterCounts counts;
      rasterize_scanline({frame.projected, frame.edge}, entries, {0, 0, 32, 32}, buffers, out, counts);
      ASSERT_GT(out.size, 10'000u);
      for (std::size_t i = 0; i < out.size; ++i) {
        const SegmentTuple tuple = to_tuple(out, i, frame.edge);
        from_tuple(tuple, out.pixel(i), out.tet(i), frame.edge, back, 0);
        ASSERT_EQ(back.front[0], out.front[i]);
        ASSERT_EQ(back.back[0], out.back[i]);
        ASSERT_EQ(back.scalar_front[0], out.scalar_front[i]);
        ASSERT_EQ(back.scalar_back[0], out.scalar_back[i]);
        ASSERT_EQ(back.pixel_and_tet[0], out.pixel_and_tet[i]);
        ASSERT_LE(tuple.length, 1.0f + 1e-6f);
      }
    }
}

TEST(SegmentTuple, RoundTripsExactlyDownToLengthsOfOneUnitOfTheDepth) {
  std::mt19937 random(2);
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  RaySegments segments;
  segments.reserve(1);
  for (int i = 0; i < 1'000'000; ++i) {
    const auto edge = static_cast<float>(std::pow(10.0, uniform(-20, 20)));
    const auto z_back = static_cast<float>(edge * std::pow(10.0, uniform(-2, 7)));
    const auto z_front = static_cast<float>(z_back - edge * std::pow(10.0, uniform(-9, 0)));
    const float length = std::max(0.0f, z_back - z_front) * (1 / edge);  // computed like rasterize_scanline()
    const SegmentTuple tuple{z_back, length, static_cast<float>(uniform(-1, 1)), static_cast<float>(uniform(-1, 1))};
    from_tuple(tuple, 17, 4'000'000'000u, edge, segments, 0);
    ASSERT_EQ(to_tuple(segments, 0, edge), tuple) << i;
    ASSERT_EQ(segments.pixel(0), 17u);
    ASSERT_EQ(segments.tet(0), 4'000'000'000u);
  }
}

}  // namespace
}  // namespace tessera::projection::scanline_rasterizer_test
