// SPDX-License-Identifier: BSD-3-Clause
#include "projection/gl/gl_rasterizer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <numeric>
#include <random>
#include <tuple>
#include <utility>
#include <vector>

#include "datasets/boxes.hpp"
#include "datasets/modify.hpp"
#include "datasets/shapes.hpp"
#include "projection/views.hpp"
#include "support/gl_context.hpp"

namespace tessera::projection::gl_rasterizer_test {
namespace {

using Records = std::vector<CellRecord>;

/// A mesh in a view.
struct Scene {
  Scene(const scene::TetMesh& mesh, const scene::Camera& camera, scene::ImageSize size_)
      : prepared(mesh), space(camera, size_), size(size_) {
    for (const glm::dvec3& p : mesh.positions) vertices.push_back(space.project(p));
    for (std::uint32_t t = 0; t < mesh.tets.size(); ++t)
      if (const auto record = cell_record(projected(), t, t)) records.push_back(*record);
  }
  [[nodiscard]] ProjectedMesh projected() const {
    return {&prepared, vertices, space.near_depth(), space.far_depth(), space.pixels_per_tangent()};
  }
  [[nodiscard]] CellUnits units() const {
    // Steps of depth and of scalars finer than the tolerances.
    const scene::Lattice lattice{
        .depth_origin = 0, .depth_unit = 0x1p-28, .scalar_origin = 0.5, .scalar_unit = 0x1p-29};
    return {0.5 * size.width, 0.5 * size.height, space.pixels_per_tangent(), lattice, 0, 0x1p28};
  }
  [[nodiscard]] scene::PixelRect rect() const { return {0, 0, size.width, size.height}; }

  PreparedMesh prepared;
  PixelSpace space;
  scene::ImageSize size;
  std::vector<PixelVertex> vertices;
  Records records;
};

struct Segment {
  std::uint32_t pixel, tet;
  double front, back;                        ///< planar
  double length, scalar_front, scalar_back;  ///< world units, the field's
  [[nodiscard]] auto key() const { return std::tie(pixel, tet); }
};

std::vector<Segment> ordered(std::vector<Segment> segments) {
  std::sort(segments.begin(), segments.end(), [](const Segment& a, const Segment& b) { return a.key() < b.key(); });
  return segments;
}

std::vector<Segment> by_planes(const Scene& scene) {
  std::vector<Segment> segments;
  rasterize_records(scene.records, scene.rect(), scene.space.pixels_per_tangent(),
                    [&](const RaySegments& of, std::span<const CellRecord> cells) {
                      for (std::size_t i = 0; i < of.size; ++i)
                        segments.push_back({of.pixel(i), static_cast<std::uint32_t>(cells[of.tet(i)].tet), of.front[i],
                                            of.back[i], 0, of.scalar_front[i], of.scalar_back[i]});
                    });
  for (Segment& s : segments) {
    const int x = static_cast<int>(s.pixel) % scene.size.width, y = static_cast<int>(s.pixel) / scene.size.width;
    s.length = (s.back - s.front) * scene.space.length_per_depth(x + 0.5, y + 0.5);
  }
  return ordered(std::move(segments));
}

template <class T>
std::vector<T> read_back(const gl::Context& context, const gl::Buffer& buffer, std::size_t count) {
  gl::Buffer readback(context, gl::Buffer::Use::readback);
  readback.reserve(count * sizeof(T));
  context.gl().MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  readback.copy_from(buffer, 0, count * sizeof(T));
  gl::Fence fence(context);
  fence.set();
  fence.wait();
  std::vector<T> values(count);
  if (count > 0) std::memcpy(values.data(), readback.mapped(), count * sizeof(T));
  return values;
}

/// Counts the segments first, then fills lists of exactly these lengths.
std::vector<Segment> by_device(const gl::Context& context, const Scene& scene, std::size_t most_cells) {
  using gl::Buffer;
  GlRasterizer rasterizer(context, most_cells);
  const auto pixels = static_cast<std::size_t>(scene.rect().area());
  const GlRasterizer::Job job{scene.records, scene.units(), scene.rect(), 0};
  Buffer next(context, Buffer::Use::device), keys(context, Buffer::Use::device), values(context, Buffer::Use::device),
      scalars(context, Buffer::Use::device), upload(context, Buffer::Use::upload);
  next.reserve(4 * pixels);
  next.clear(4 * pixels);
  rasterizer.count({&job, 1}, next);
  const auto counts = read_back<std::uint32_t>(context, next, pixels);
  std::vector<std::uint32_t> begin(pixels + 1, 0);
  for (std::size_t p = 0; p < pixels; ++p) begin[p + 1] = begin[p] + counts[p];
  const std::size_t total = begin.back();
  upload.reserve(4 * pixels);
  std::memcpy(upload.mapped(), begin.data(), 4 * pixels);
  next.copy_from(upload, 0, 4 * pixels);
  keys.reserve(16 * total + 16), values.reserve(16 * total + 16), scalars.reserve(8 * total + 8);
  rasterizer.fill({&job, 1}, {&next, &keys, &values, &scalars});
  EXPECT_EQ(read_back<std::uint32_t>(context, next, pixels),
            std::vector<std::uint32_t>(begin.begin() + 1, begin.end()));  // every list is full
  const auto key = read_back<std::array<std::uint32_t, 4>>(context, keys, total);
  const auto value = read_back<std::array<float, 4>>(context, values, total);
  const auto scalar = read_back<std::array<float, 2>>(context, scalars, total);
  context.check("rasterizing");
  const CellUnits units = scene.units();
  std::vector<Segment> segments;
  for (std::size_t p = 0; p < pixels; ++p)
    for (std::size_t i = begin[p]; i < begin[p + 1]; ++i) {
      EXPECT_EQ(key[i][3], i);
      EXPECT_EQ(value[i][3], -1);
      EXPECT_EQ(value[i][1], scalar[i][0]);
      EXPECT_EQ(value[i][2], scalar[i][1]);
      segments.push_back({static_cast<std::uint32_t>(p), key[i][2], units.key_origin + key[i][0] / units.keys_per_depth,
                          units.key_origin + key[i][1] / units.keys_per_depth, value[i][0] * units.lattice.depth_unit,
                          units.lattice.scalar(double{value[i][1]}), units.lattice.scalar(double{value[i][2]})});
    }
  return ordered(std::move(segments));
}

/// Expects the cells and numbers of rasterize_planes on every ray, within the rounding of a device's formats.
void expect_like_planes(const gl::Context& context, const Scene& scene) {
  const auto expected = by_planes(scene), found = by_device(context, scene, 1 << 17);
  ASSERT_EQ(found.size(), expected.size());
  ASSERT_FALSE(expected.empty());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const Segment &a = expected[i], &b = found[i];
    ASSERT_EQ(a.key(), b.key()) << "pixel " << a.pixel << " tet " << a.tet;
    // Keys and scalars are truncated to 2^-28 and 2^-29, lengths and scalars are floats; almost edge-on faces magnify
    // the 2^-33 pixel by which the tie rule moves corners.
    EXPECT_NEAR(a.front, b.front, 1e-8) << "pixel " << a.pixel << " tet " << a.tet;
    EXPECT_NEAR(a.back, b.back, 1e-8) << "pixel " << a.pixel << " tet " << a.tet;
    EXPECT_NEAR(a.length, b.length, 1e-8 + 1e-7 * a.length) << "pixel " << a.pixel << " tet " << a.tet;
    EXPECT_NEAR(a.scalar_front, b.scalar_front, 6e-8) << "pixel " << a.pixel << " tet " << a.tet;
    EXPECT_NEAR(a.scalar_back, b.scalar_back, 6e-8) << "pixel " << a.pixel << " tet " << a.tet;
  }
}

/// The tests run on each OpenGL platform, in software on machines without a GPU.
class GlRasterizerOn : public testing::TestWithParam<gl::Platform> {
 protected:
  void SetUp() override {
    try {
      context_ = gl::open_context(GetParam());
    } catch (const scene::Error& error) {
      GTEST_SKIP() << error.what();
    }
  }
  std::unique_ptr<gl::Context> context_;
};
INSTANTIATE_TEST_SUITE_P(All, GlRasterizerOn, testing::Values(gl::Platform::osmesa, gl::Platform::egl),
                         [](const auto& param) { return param.param == gl::Platform::osmesa ? "OSMesa" : "EGL"; });

TEST_P(GlRasterizerOn, HitsWhatPlanesHitsInEveryKindOfView) {
  const scene::TetMesh mesh = datasets::cube(5, 0.25);
  const scene::ImageSize size{40, 33};
  for (const scene::Camera& camera :
       {oblique(), perspective({3.1, 2.3, 4.2}, 35), perspective({0.11, 0.23, -0.17}, 100)})
    expect_like_planes(*context_, Scene(mesh, camera, size));
}

TEST_P(GlRasterizerOn, LeavesOutCellsBehindTheEyeAndAcrossTheClippingRange) {
  const scene::TetMesh mesh = datasets::cube(5, 0.25);
  const Scene inside(mesh, perspective({0.11, 0.23, -0.17}, 100), {40, 33});
  EXPECT_LT(inside.records.size(), mesh.tets.size());
  EXPECT_GT(inside.records.size(), 0u);
  for (const CellRecord& record : inside.records)
    for (const auto& corner : record.corner) EXPECT_GT(corner.depth, 0);
  scene::Camera cut = oblique();
  cut.clipping_range = scene::ClippingRange{5.2, 6.1};
  for (const CellRecord& record : Scene(mesh, cut, {40, 33}).records)
    for (const auto& corner : record.corner) EXPECT_TRUE(corner.depth >= 5.2 && corner.depth <= 6.1);
}

TEST_P(GlRasterizerOn, KeepsTheTieRuleWhereVerticesAreOnPixelCentres) {
  const int n = 8;
  const Scene scene(datasets::cube(n, 0), aligned(n, 24), {24, 24});
  expect_like_planes(*context_, scene);
  // The tie rule shifts rays right and down, so that 2n columns and 2n rows of pixels hit the box. Each of these rays
  // has the length 2 in the box, all others 0.
  std::vector<double> length(24 * 24, 0);
  for (const Segment& s : by_device(*context_, scene, 1 << 17)) length[s.pixel] += s.back - s.front;
  std::size_t hit = 0;
  for (const double l : length) {
    if (l == 0) continue;
    ++hit;
    EXPECT_NEAR(l, 2, 1e-6);
  }
  EXPECT_EQ(hit, static_cast<std::size_t>(4 * n * n));
}

TEST_P(GlRasterizerOn, KeepsTheTieRuleInPerspective) {
  // The eye is on the axis, so that faces of the split are in planes through the eye that contain rows and columns of
  // pixel centres.
  scene::Camera camera;
  camera.position = {0, 0, 4};
  camera.projection = scene::ProjectionKind::perspective;
  camera.view_angle = 40;
  for (const scene::ImageSize size : {scene::ImageSize{25, 25}, scene::ImageSize{24, 24}})
    expect_like_planes(*context_, Scene(datasets::cube(6, 0), camera, size));
}

TEST_P(GlRasterizerOn, CellsWithoutVolumeMatchThoseOfPlanes) {
  const scene::ImageSize size{32, 32};
  for (const bool flat : {true, false}) {
    scene::TetMesh mesh = datasets::cube(3, 0.2);
    std::mt19937 random(5);
    const std::size_t vertices = mesh.positions.size();
    const auto any = [&] { return static_cast<std::uint32_t>(random() % vertices); };
    for (int i = 0; i < 60; ++i) {
      const std::uint32_t a = any(), b = any(), c = any();
      if (flat) {  // a point in the triangle a, b, c: rounding decides which face is in front, without any effect
        mesh.positions.push_back(0.25 * mesh.positions[a] + 0.25 * mesh.positions[b] + 0.5 * mesh.positions[c]);
        mesh.scalars.push_back(0.25 * mesh.scalars[a] + 0.25 * mesh.scalars[b] + 0.5 * mesh.scalars[c]);
        mesh.tets.push_back({a, b, c, static_cast<std::uint32_t>(mesh.positions.size() - 1)});
      } else {
        mesh.tets.push_back({a, b, i % 2 == 0 ? b : a, c});  // two or three coincident corners
      }
    }
    for (const scene::Camera& camera : {aligned(3, 32), oblique(), perspective({3.1, 2.3, 4.2}, 40)})
      expect_like_planes(*context_, Scene(mesh, camera, size));
  }
}

TEST_P(GlRasterizerOn, TinyCellsAndSliversMatchThoseOfPlanes) {
  const scene::ImageSize size{32, 32};
  for (const scene::TetMesh& mesh : {datasets::graded(6, 1e12), datasets::slivers(4, 1e6), datasets::cube(20, 0.2)})
    for (const scene::Camera& camera : {oblique(), perspective({1.2, 0.9, 1.4}, 60)})
      expect_like_planes(*context_, Scene(mesh, camera, size));
}

TEST_P(GlRasterizerOn, CellsAFewAtATimeGiveTheSameBits) {
  const Scene scene(datasets::cube(4, 0.2), oblique(), {24, 24});
  const auto at_once = by_device(*context_, scene, 1 << 17);
  for (const std::size_t few : {1, 7, 64}) {
    const auto again = by_device(*context_, scene, few);
    ASSERT_EQ(again.size(), at_once.size());
    for (std::size_t i = 0; i < again.size(); ++i) {
      const auto all = [](const Segment& s) {
        return std::tie(s.pixel, s.tet, s.front, s.back, s.length, s.scalar_front, s.scalar_back);
      };
      EXPECT_EQ(all(again[i]), all(at_once[i]));
    }
  }
}

/// Tests exact_edge(), which only rays near edges reach, at all pixels of cells whose edges pass within 2^-31 of pixel
/// centres.
TEST_P(GlRasterizerOn, EdgesWithinTheLastPlacesOfPixelCentresAreDecidedExactly) {
  std::mt19937 random(11);
  scene::TetMesh mesh;
  mesh.association = scene::Association::point;
  const auto place = [&](int most) {
    // A pixel centre of an image of 32 x 32 in which a pixel is one unit, or a number adjacent to one.
    return static_cast<double>(random() % static_cast<unsigned>(most)) - 15.5 +
           0x1p-32 * (static_cast<int>(random() % 3) - 1);
  };
  for (int i = 0; i < 400; ++i) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int corner = 0; corner < 4; ++corner) {
      mesh.positions.emplace_back(place(32), place(32), static_cast<double>(random() % 7) - 3);
      mesh.scalars.push_back(0.1 * static_cast<double>(random() % 10));
    }
    mesh.tets.push_back({first, first + 1, first + 2, first + 3});
  }
  scene::Camera camera;
  camera.position = {0, 0, 10};
  camera.parallel_scale = 16;
  expect_like_planes(*context_, Scene(mesh, camera, {32, 32}));
}

/// Integers with m * v - n * u = 1, for coprime m and n (Euclid).
std::array<std::int64_t, 2> beside(std::int64_t m, std::int64_t n) {
  std::int64_t r0 = m, r1 = n, s0 = 1, s1 = 0, t0 = 0, t1 = 1;
  while (r1 != 0) {
    const std::int64_t q = r0 / r1;
    std::tie(r0, r1) = std::pair{r1, r0 - q * r1};
    std::tie(s0, s1) = std::pair{s1, s0 - q * s1};
    std::tie(t0, t1) = std::pair{t1, t0 - q * t1};
  }
  EXPECT_EQ(r0, 1);
  return {-t0, s0};  // m * s0 + n * t0 = 1
}

/// The smallest nonzero E, 2^-64: in double arithmetic it becomes zero or, if a product is fused, anything.
TEST_P(GlRasterizerOn, EdgesNearerToCentresThanDoublesResolveAreDecidedExactly) {
  std::mt19937_64 random(3);
  scene::TetMesh mesh;
  const auto add = [&](double x, double y) {
    mesh.positions.emplace_back(x, y, static_cast<double>(random() % 5) - 2);
    mesh.scalars.push_back(0.1 * static_cast<double>(random() % 10));
  };
  for (int i = 0; i < 400; ++i) {
    const double x = static_cast<double>(random() % 20) - 9.5, y = static_cast<double>(random() % 20) - 9.5;
    std::int64_t m = 0, n = 0;
    do m = static_cast<std::int64_t>(random() >> 29) | 1, n = static_cast<std::int64_t>(random() >> 29);
    while (n == 0 || std::gcd(m, n) != 1);
    const auto [u, v] = beside(m, n);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const double step = i % 2 == 0 ? 0x1p-32 : -0x1p-32;
    add(x + step * static_cast<double>(m), y + step * static_cast<double>(n));
    add(x - step * static_cast<double>(u), y - step * static_cast<double>(v));
    for (int corner = 0; corner < 2; ++corner)
      add(static_cast<double>(random() % 64) / 2 - 16, static_cast<double>(random() % 64) / 2 - 16);
    mesh.tets.push_back({first, first + 1, first + 2, first + 3});
  }
  scene::Camera camera;
  camera.position = {0, 0, 10};
  camera.parallel_scale = 16;
  expect_like_planes(*context_, Scene(mesh, camera, {32, 32}));
}

}  // namespace
}  // namespace tessera::projection::gl_rasterizer_test
