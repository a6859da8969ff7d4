// SPDX-License-Identifier: BSD-3-Clause
#include "projection/lattice/lattice_rasterizer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/vec2.hpp>
#include <limits>
#include <map>
#include <tuple>

#include "datasets/boxes.hpp"
#include "projection/surface_crossings.hpp"
#include "projection/views.hpp"
#include "support/instruction_sets.hpp"

namespace tessera::projection::lattice_rasterizer_test {
namespace {

struct Segment {
  std::int32_t front, back;
  float scalar_front, scalar_back;
  std::uint32_t tet;
  auto operator<=>(const Segment&) const = default;
};
using Rays = std::vector<std::vector<Segment>>;  // by pixel, row-major, each in visibility order

/// A mesh in a view, on a lattice over its depths and scalars.
struct Scene {
  Scene(const scene::TetMesh& mesh, const scene::Camera& camera, scene::ImageSize image)
      : prepared(mesh), space(camera, image), size(image) {
    double near = std::numeric_limits<double>::infinity(), far = -near;
    for (const glm::dvec3& p : mesh.positions) {
      vertices.push_back(space.project(p));
      near = std::min(near, vertices.back().depth), far = std::max(far, vertices.back().depth);
    }
    near = std::max(near, space.near_depth()), far = std::min(far, space.far_depth());
    const auto [low, high] = scene::scalar_range(mesh);
    const double depth = (near + far) / 2, scalar = (low + high) / 2;
    lattice = {depth, scene::Lattice::unit_for(1.001 * (far - near) / 2), scalar,
               scene::Lattice::unit_for(1.001 * (high - low) / 2)};
    const bool per_point = mesh.association == scene::Association::point;
    lattice_vertices.resize(vertices.size());
    make_lattice_vertices(vertices, per_point ? std::span(mesh.scalars) : std::span<const double>(), lattice,
                          space.perspective(), lattice_vertices);
  }

  [[nodiscard]] LatticeView view() const {
    return {{&prepared, vertices, space.near_depth(), space.far_depth(), space.pixels_per_tangent()},
            lattice_vertices,
            lattice,
            space.perspective()};
  }

  PreparedMesh prepared;
  PixelSpace space;
  scene::ImageSize size;
  std::vector<PixelVertex> vertices;
  scene::Lattice lattice{};
  std::vector<LatticeVertex> lattice_vertices;
};

/// All segments, with the image rasterized in rectangles of `tile` pixels a side, a power of two up to 32. If cells are
/// rasterized together, segments do not identify their cell.
Rays rasterized(const Scene& scene, int tile, RasterCounts* counts_out = nullptr, std::size_t together = 1,
                const LatticeFaces* faces = nullptr) {
  const LatticeView view = scene.view();
  OpenPixels open;
  open.fill(~0u);
  LatticeScratch scratch;
  SegmentStream stream;
  RasterCounts counts;
  Rays rays(static_cast<std::size_t>(scene.size.width) * scene.size.height);
  for (int y = 0; y < scene.size.height; y += tile)
    for (int x = 0; x < scene.size.width; x += tile) {
      const scene::PixelRect rect{x, y, std::min(x + tile, scene.size.width), std::min(y + tile, scene.size.height)};
      std::vector<TileEntry> entries(scene.prepared.tet_count());
      for (std::uint32_t t = 0; t < entries.size(); ++t) entries[t] = {0, t};
      for (std::size_t from = 0; from < entries.size(); from += together) {
        const auto cells = std::span(entries).subspan(from, std::min(together, entries.size() - from));
        const std::uint32_t t = together == 1 ? cells.front().tet : 0;
        stream.size = 0;
        rasterize_lattice(view, {cells, {}}, {rect, open, faces}, scratch, stream, counts);
        for (std::size_t i = 0; i < stream.size; ++i) {
          const int px = x + stream.pixel[i] % rect.width(), py = y + stream.pixel[i] / rect.width();
          rays[static_cast<std::size_t>(py) * scene.size.width + px].push_back(
              {stream.front[i], stream.back[i], stream.scalar_front[i], stream.scalar_back[i], t});
        }
      }
    }
  for (auto& ray : rays) std::sort(ray.begin(), ray.end());
  if (counts_out != nullptr) *counts_out = counts;
  return rays;
}

/// Whether a face of the cell is so close to edge-on that the cell is handled in double precision.
bool edge_on(const Scene& scene, std::uint32_t tet) {
  const scene::Tet& corners = scene.prepared.tets()[tet];
  for (const auto& face : {std::array{0, 1, 2}, std::array{0, 1, 3}, std::array{0, 2, 3}, std::array{1, 2, 3}}) {
    std::array<glm::dvec2, 3> p;
    for (int i = 0; i < 3; ++i) {
      const PixelVertex& v = scene.vertices[corners[face[i]]];
      p[i] = glm::dvec2(v.x, v.y) / v.w;
    }
    const glm::dvec2 a = p[1] - p[0], b = p[2] - p[0];
    if (std::abs(a.x * b.y - a.y * b.x) < 0x1p-9 * (std::abs(a.x) + std::abs(a.y) + std::abs(b.x) + std::abs(b.y)))
      return true;
  }
  return false;
}

/// Exactly the cells that rasterize_planes hits, with its depths and scalars up to the lattice's error.
void expect_like_planes(const scene::TetMesh& mesh, const scene::Camera& camera, scene::ImageSize size) {
  const Scene scene(mesh, camera, size);
  const Rays rays = rasterized(scene, 32);
  std::vector<std::map<std::uint32_t, std::array<double, 4>>> expected(rays.size());
  RaySegments out;
  RasterCounts counts;
  const scene::PixelRect window{0, 0, size.width, size.height};
  out.reserve(static_cast<std::size_t>(window.area()));
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
    const TileEntry entry{0, t};
    out.size = 0;
    ASSERT_EQ(rasterize_planes(scene.view().projected, {&entry, 1}, window, out, counts), 1u);
    for (std::size_t i = 0; i < out.size; ++i)
      expected[out.pixel(i)][t] = {out.front[i], out.back[i], out.scalar_front[i], out.scalar_back[i]};
  }
  // Gradients are rounded to a step, over 16 pixels per direction (20 steps), and scalars to floats of up to 2^30 steps
  // (32 steps). Perspective multiplies a float quotient by a face's range, which is less than half of the lattice. The
  // quotient has an error of 3.2e-7: three roundings, and an estimate's error of 1.5 * 2^-12 (SSE), squared by a Newton
  // step.
  const double quotient = scene.space.perspective() ? 3.2e-7 * scene::Lattice::limit : 0;
  const double depth_error = (20 + quotient) * scene.lattice.depth_unit;
  const double scalar_error = (20 + 32 + quotient) * scene.lattice.scalar_unit;
  std::size_t hits = 0;
  for (std::size_t p = 0; p < rays.size(); ++p) {
    ASSERT_EQ(rays[p].size(), expected[p].size()) << "pixel " << p;
    for (const Segment& s : rays[p]) {
      const auto found = expected[p].find(s.tet);
      ASSERT_NE(found, expected[p].end()) << "pixel " << p << " tet " << s.tet;
      const auto [front, back, scalar_front, scalar_back] = found->second;
      EXPECT_NEAR(scene.lattice.depth(s.front), front, depth_error);
      EXPECT_NEAR(scene.lattice.depth(s.back), back, depth_error);
      EXPECT_NEAR(scene.lattice.scalar(s.scalar_front), scalar_front, scalar_error);
      EXPECT_NEAR(scene.lattice.scalar(s.scalar_back), scalar_back, scalar_error);
      ++hits;
    }
  }
  EXPECT_GT(hits, 0u);
}

TEST(LatticeRasterizer, HitsTheCellsOfDoublePrecisionInEveryKindOfView) {
  const scene::TetMesh mesh = datasets::cube(5, 0.25);
  const scene::ImageSize size{40, 33};
  tests::for_each_instruction_set([&](const char* name) {
    SCOPED_TRACE(name);
    expect_like_planes(mesh, oblique(), size);
    expect_like_planes(mesh, perspective({3.1, 2.3, 4.2}, 35), size);
    expect_like_planes(mesh, perspective({0.11, 0.23, -0.17}, 100), size);  // eye inside: cells cross the eye plane
    scene::Camera near_cuts = perspective({3.1, 2.3, 4.2}, 35);
    near_cuts.clipping_range = scene::ClippingRange{5.2, 6.1};
    expect_like_planes(mesh, near_cuts, size);
  });
}

/// Up to four marks on each ray of one tile: inside segments, and at depths where cells meet.
FaceMarks some_marks(const Scene& scene, const Rays& rays) {
  FaceMarks marks;
  marks.reset(rays.size());
  for (std::uint32_t p = 0; p < rays.size(); ++p)
    for (std::size_t i = 0; i < std::min<std::size_t>(p % 5, rays[p].size()); ++i) {
      const Segment& s = rays[p][(7 * i + p) % rays[p].size()];
      const double step = i % 2 == 0 ? s.front : s.front + 0.3 * (s.back - s.front);
      marks.add({p, static_cast<std::uint32_t>(i), scene.lattice.depth(step), 0.5, 0, {}, {}, 0.5f, i != 3});
    }
  marks.sort();
  return marks;
}

TEST(LatticeRasterizer, CutsSegmentsAtTheTrianglesThatTheirRaysMeet) {
  const scene::TetMesh mesh = datasets::cube(5, 0.25);
  tests::for_each_instruction_set([&](const char* name) {
    SCOPED_TRACE(name);
    for (const scene::Camera& camera : {oblique(), perspective({3.1, 2.3, 4.2}, 40)}) {
      const Scene scene(mesh, camera, {32, 32});
      const Rays whole = rasterized(scene, 32);
      const FaceMarks marks = some_marks(scene, whole);
      LatticeFaces faces;
      faces.set(marks, scene.lattice, {});
      const Rays cut = rasterized(scene, 32, nullptr, 16, &faces);
      std::size_t parts = 0;
      for (std::size_t p = 0; p < cut.size(); ++p) {
        const auto first = faces.places() + faces.begin()[p], last = faces.places() + faces.begin()[p + 1];
        EXPECT_TRUE(std::is_sorted(first, last));
        double length = 0, length_of_whole = 0;
        for (const Segment& s : whole[p]) length_of_whole += s.back - s.front;
        for (const Segment& s : cut[p]) {
          length += s.back - s.front;
          EXPECT_TRUE(std::none_of(first, last, [&](std::int32_t at) { return s.front < at && at < s.back; })) << p;
          // Each piece is a part of a cell's segment and has the segment's scalars, up to the error of a face's depth.
          const double reach = LatticeFaces::reach + 4;
          EXPECT_TRUE(std::ranges::any_of(whole[p], [&](const Segment& of) {
            const double steps = std::max(1, of.back - of.front), slope = (of.scalar_back - of.scalar_front) / steps;
            const auto is_on = [&](std::int32_t depth, double scalar) {
              return std::abs(scalar - (of.scalar_front + slope * (depth - of.front))) <=
                     std::abs(slope) * reach + 128;  // 2^-24 of 2^30, twice
            };
            return s.front >= of.front - reach && s.back <= of.back + reach &&
                   (s.front == s.back || (is_on(s.front, s.scalar_front) && is_on(s.back, s.scalar_back)));
          })) << p;
        }
        EXPECT_NEAR(length, length_of_whole, LatticeFaces::reach * (last - first) * 4.0) << p;
        parts += cut[p].size() - whole[p].size();
      }
      EXPECT_GT(parts, 200u);
      SegmentStream own;
      faces.append_own(own);
      EXPECT_EQ(own.size, marks.own());
      for (std::size_t i = 0; i < own.size; ++i) {
        EXPECT_EQ(own.front[i], own.back[i]);
        EXPECT_NEAR(crossing_of(own.scalar_front[i]).cosine, 0.5, 1e-6);
        EXPECT_EQ(own.scalar_back[i], static_cast<float>(scene.lattice.scalar_step(0.5)));
      }
    }
  });
}

TEST(LatticeRasterizer, KeepsTheTieRuleWhereVerticesAreOnPixelCentres) {
  const scene::TetMesh mesh = datasets::cube(8, 0);
  tests::for_each_instruction_set([&](const char* name) {
    SCOPED_TRACE(name);
    expect_like_planes(mesh, aligned(8, 24), {24, 24});
  });
}

TEST(LatticeRasterizer, SeesAllCellsFromAVertexAnEdgeAndAFace) {
  const scene::TetMesh mesh = datasets::regular_split(8, 8, 8, glm::dvec3(0.25), glm::dvec3(-1));
  for (const glm::dvec3& eye : {glm::dvec3(0, 0.25, -0.5), {0.125, 0.125, 0.125}, {0.125, 0.0625, 0}, {-1, -1, -1}}) {
    scene::Camera camera = perspective(eye, 100);
    camera.focal_point = eye.x < 0 ? glm::dvec3(1, 0.9, 0.8) : glm::dvec3(0.9, -0.3, 0.6);
    expect_like_planes(mesh, camera, {48, 32});
  }
}

TEST(LatticeRasterizer, NeighboursShareTheBitsOfTheirFace) {
  const scene::TetMesh mesh = datasets::cube(7, 0.25);
  tests::for_each_instruction_set([&](const char* name) {
    SCOPED_TRACE(name);
    for (const scene::Camera& camera : {oblique(), perspective({3.1, 2.3, 4.2}, 40)}) {
      const Scene scene(mesh, camera, {48, 48});
      std::size_t junctions = 0, irregular = 0;
      for (const auto& ray : rasterized(scene, 32))
        for (std::size_t i = 1; i < ray.size(); ++i, ++junctions) {
          if (ray[i - 1].back == ray[i].front && ray[i - 1].scalar_back == ray[i].scalar_front) continue;
          ++irregular;
          EXPECT_TRUE(edge_on(scene, ray[i - 1].tet) != edge_on(scene, ray[i].tet));
          EXPECT_NEAR(ray[i - 1].back, ray[i].front, 64);  // the tolerance within which runs count as touching
        }
      EXPECT_GT(junctions, 5000u);
      EXPECT_LT(irregular, junctions / 100);
    }
  });
}

/// A large cell is processed by blocks of its pixels, small ones in parallel: the same segments either way.
TEST(LatticeRasterizer, CellsTogetherGiveWhatEachGivesAlone) {
  scene::TetMesh by_cell = datasets::cube(8, 0.25);
  by_cell.association = scene::Association::cell;
  by_cell.scalars.resize(by_cell.tets.size());
  for (std::size_t t = 0; t < by_cell.scalars.size(); ++t) by_cell.scalars[t] = std::sin(static_cast<double>(t));
  const scene::TetMesh meshes[] = {datasets::cube(8, 0.25), datasets::cube(8, 0), by_cell};
  tests::for_each_instruction_set([&](const char* name) {
    SCOPED_TRACE(name);
    for (const scene::TetMesh& mesh : meshes)
      for (const scene::Camera& camera :
           {oblique(), perspective({3.1, 2.3, 4.2}, 35), perspective({0.1, 0.2, 0.1}, 90), aligned(8, 24)})
        for (const int side : {24, 64}) {
          const Scene scene(mesh, camera, {side, side});
          RasterCounts alone_counts, together_counts;
          Rays alone = rasterized(scene, 32, &alone_counts);
          for (auto& ray : alone) {
            for (Segment& s : ray) s.tet = 0;
            std::sort(ray.begin(), ray.end());
          }
          EXPECT_EQ(rasterized(scene, 32, &together_counts, 16), alone) << side;
          EXPECT_EQ(rasterized(scene, 32, nullptr, 5), alone) << side;
          // Exact signs are computed where they decide, not for all pixels on an edge's line.
          EXPECT_EQ(together_counts.exact_sign_tests, alone_counts.exact_sign_tests);
        }
  });
}

TEST(LatticeRasterizer, BitsDoNotDependOnTheRectangle) {
  const scene::TetMesh mesh = datasets::cube(5, 0.25);
  for (const scene::Camera& camera : {oblique(), perspective({0.1, 0.2, 0.1}, 90), aligned(5, 37)}) {
    const Scene scene(mesh, camera, {41, 37});
    const Rays whole = rasterized(scene, 32);
    for (const int tile : {1, 4, 8, 16}) EXPECT_EQ(rasterized(scene, tile), whole) << tile;
  }
}

}  // namespace
}  // namespace tessera::projection::lattice_rasterizer_test
