// SPDX-License-Identifier: BSD-3-Clause
#include "frame/mesh/render.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "datasets/boxes.hpp"
#include "datasets/kuhn.hpp"
#include "frame/leaning_stack.hpp"
#include "projection/lattice/lattice_rasterizer.hpp"
#include "projection/prepared_mesh.hpp"
#include "reference/judge.hpp"
#include "scene/error.hpp"
#include "support/some_cases.hpp"

namespace tessera::frame::render_test {
namespace {

using scene::Camera;
using scene::Image;
using scene::ImageSize;
using scene::TransferFunction;

Camera oblique() {
  Camera camera;
  camera.position = {3.1, 2.3, 4.2};
  camera.parallel_scale = 1.8;
  return camera;
}

TransferFunction six_knots() {
  return TransferFunction({{0, {0, 0, 0.3}, 0},
                           {0.3, {0.1, 0.3, 0.9}, 0.4},
                           {0.5, {0.2, 0.9, 0.3}, 0},
                           {0.7, {0.9, 0.8, 0.1}, 3},
                           {0.8, {1, 0.3, 0}, 0.2},
                           {1, {1, 1, 1}, 8}});
}

Settings exact() {
  Settings settings;
  settings.integrator.kind = scene::IntegratorKind::exact;
  return settings;
}

bool same_bits(const Image& a, const Image& b) { return a.rgba == b.rgba && a.depth == b.depth; }

TEST(Render, GivesTheSameBitsWithCornersOrderedBeforehand) {
  const scene::TetMesh mesh = datasets::cube(12, 0.2);
  scene::TetMesh ordered = mesh;
  projection::order_corners(ordered);
  ASSERT_NE(ordered.tets, mesh.tets);
  const ImageSize size{97, 61};
  EXPECT_TRUE(same_bits(Renderer(ordered, exact()).render(oblique(), size, six_knots()),
                        Renderer(mesh, exact()).render(oblique(), size, six_knots())));
}

TEST(Render, GivesTheSameBitsForAnyThreadsTilesAndMemory) {
  const scene::TetMesh mesh = datasets::cube(12, 0.2);
  test::SomeCases some(5);
  for (const bool eye_inside : {false, true}) {
    Camera camera = oblique();
    if (eye_inside) {
      camera.position = {0.1, 0.2, 0.15};
      camera.projection = scene::ProjectionKind::perspective;
      camera.view_angle = 80;
    }
    const ImageSize size{97, 61};
    const Image expected = Renderer(mesh, exact()).render(camera, size, six_knots());
    for (const int threads : {1, 2, 5})
      for (const int tile : {1, 7, 32, 1024})
        for (const std::uint64_t memory : {64ull << 20, 8ull << 20}) {
          if (!some.next()) continue;
          Settings settings = exact();
          settings.threads = threads;
          settings.mesh.tile_size = tile;
          settings.memory_bytes = memory;
          EXPECT_TRUE(same_bits(Renderer(mesh, settings).render(camera, size, six_knots()), expected))
              << threads << " threads, tile " << tile << ", memory " << memory;
        }
  }
}

Settings scanline() {
  Settings settings = exact();
  settings.mesh.rasterizer = Rasterizer::scanline;
  return settings;
}

double largest_difference(const Image& a, const Image& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i)
    most = std::max(most, static_cast<double>(std::abs(a.rgba[i] - b.rgba[i])));
  return most;
}

TEST(Render, ScanlineGivesTheSameBitsForAnyThreadsTilesAndMemory) {
  const scene::TetMesh mesh = datasets::cube(16, 0.2);
  const scene::TetMesh regular = datasets::regular_split(16, 16, 16, glm::dvec3(0.125), glm::dvec3(-1));
  Camera along = oblique();  // vertices on pixel centres, and equal depths everywhere
  along.position = {1 / 64., -1 / 64., 5};
  along.focal_point = {1 / 64., -1 / 64., 0};
  along.parallel_scale = 61 / 64.;
  const ImageSize size{97, 61};
  test::SomeCases some(5);
  for (const auto& [m, camera] : {std::pair{&mesh, oblique()}, std::pair{&regular, along}}) {
    const Image expected = Renderer(*m, scanline()).render(camera, size, six_knots());
    for (const int threads : {1, 3})
      for (const int tile : {1, 7, 32, 1024})
        for (const std::uint64_t memory : {64ull << 20, 8ull << 20}) {
          if (!some.next()) continue;
          Settings settings = scanline();
          settings.threads = threads;
          settings.mesh.tile_size = tile;
          settings.memory_bytes = memory;
          EXPECT_TRUE(same_bits(Renderer(*m, settings).render(camera, size, six_knots()), expected))
              << threads << " threads, tile " << tile << ", memory " << memory;
        }
  }
}

TEST(Render, ScanlineIsPlanesToFloatRoundingWithEveryIntegrator) {
  // No ray of this view passes an edge closer than the rounding of float (1e-6 pixel); scanline_rasterizer_test
  // measures it.
  const scene::TetMesh mesh = datasets::cube(3, 0.25);
  const ImageSize size{31, 27};
  for (const auto kind :
       {scene::IntegratorKind::exact, scene::IntegratorKind::sampled, scene::IntegratorKind::automatic})
    for (const scene::Emission emission : {scene::Emission::absorption, scene::Emission::independent}) {
      Settings settings = scanline();
      settings.integrator.kind = kind;
      settings.integrator.samples = 8;
      settings.emission = emission;
      const Image paper = Renderer(mesh, settings).render(oblique(), size, six_knots());
      settings.mesh.rasterizer = Rasterizer::planes;
      const Image ours = Renderer(mesh, settings).render(oblique(), size, six_knots());
      // Depths are accurate to 5e-7 each; colours and extinctions change by up to 8 over a scalar range of 0.1.
      EXPECT_LT(largest_difference(paper, ours), 1e-5);
      EXPECT_GT(largest_difference(paper, ours), 0);
    }
}

TEST(Render, ScanlineRefusesPerspectiveAndScenesBeyondFloat) {
  const scene::TetMesh mesh = datasets::cube(2, 0);
  Camera camera = oblique();
  camera.projection = scene::ProjectionKind::perspective;
  camera.view_angle = 40;
  try {
    Renderer(mesh, scanline()).render(camera, {8, 8}, six_knots());
    FAIL() << "perspective was taken";
  } catch (const scene::Error& error) {
    EXPECT_EQ(error.code(), scene::ErrorCode::bad_input);
    EXPECT_NE(std::string(error.what()).find("orthographic"), std::string::npos) << error.what();
  }
  scene::TetMesh huge = mesh;
  for (glm::dvec3& p : huge.positions) p *= 1e38;
  camera = oblique();
  camera.position *= 1e38;
  camera.parallel_scale *= 1e38;
  EXPECT_THROW(Renderer(huge, scanline()).render(camera, {8, 8}, six_knots()), scene::Error);
  EXPECT_NO_THROW(Renderer(huge, exact()).render(camera, {8, 8}, six_knots()));
}

TEST(Render, CullingInvisibleCellsChangesNoBit) {
  const scene::TetMesh mesh = datasets::cube(10, 0.2);
  const TransferFunction peak({{0, {1, 0, 0}, 0}, {0.7, {1, 0, 0}, 0}, {0.8, {1, 1, 0}, 9}, {0.9, {0, 1, 0}, 0}});
  FrameStatistics statistics;
  const Image image = Renderer(mesh, exact()).render(oblique(), {64, 64}, peak, &statistics);
  EXPECT_GT(statistics.tets_invisible, mesh.tets.size() / 3);
  // The reference projects all cells.
  const reference::Reference reference(mesh, oblique(), {64, 64}, peak);
  EXPECT_LT(reference::judge(image, reference, 1e-6).max_error, 1e-6);  // float output has rounding errors of 6e-8
}

TEST(Render, AStackOfTwentyThousandThinCellsIsRightInBoundedMemory) {
  const scene::TetMesh mesh = leaning_stack(20000);
  Camera camera;
  camera.position = {0.0031, 0.0047, 9};
  camera.focal_point = {0.0031, 0.0047, 0};
  camera.parallel_scale = 0.06;
  const ImageSize size{24, 24};
  const TransferFunction function({{0, {0, 0.2, 1}, 0.1}, {1, {1, 0.3, 0}, 1.5}});
  const reference::Reference reference(mesh, camera, size, function);
  const Image roomy = Renderer(mesh, exact()).render(camera, size, function);
  EXPECT_GT(reference.segments(12.5, 12.5).size(), 20000u);
  EXPECT_LT(reference::judge(roomy, reference, 2e-5).max_error, 2e-5);

  Settings settings = exact();
  settings.threads = 2;
  settings.memory_bytes = 24ull << 20;  // 80 pixels of 20,000 segments at 100 bytes would take 160 MB
  FrameStatistics statistics;
  const Image tight = Renderer(mesh, settings).render(camera, size, function, &statistics);
  EXPECT_GT(statistics.tiles_split, 0u);
  EXPECT_LE(statistics.peak_buffer_bytes, settings.memory_bytes);
  EXPECT_TRUE(same_bits(tight, roomy));
}

TEST(Render, OpaqueMatterIsRightAndTheSameInAnyTilesAndThreads) {
  const scene::TetMesh mesh = datasets::cube(20, 0.2);
  const ImageSize size{40, 40};
  const TransferFunction clear = six_knots();
  std::vector<scene::Knot> knots(clear.knots().begin(), clear.knots().end());
  for (scene::Knot& knot : knots) knot.extinction = 40 * knot.extinction + 20;  // a length of 3.5 units is opaque
  const TransferFunction function(knots);
  const reference::Reference reference(mesh, oblique(), size, function);
  for (const double accuracy : {0.0, 1e-4}) {
    Settings settings = exact();
    if (accuracy > 0) {
      settings.integrator.kind = scene::IntegratorKind::automatic;
      settings.integrator.accuracy = accuracy;
    }
    FrameStatistics statistics;
    const Image image = Renderer(mesh, settings).render(oblique(), size, function, &statistics);
    EXPECT_TRUE(statistics.on_lattice);
    const double bound = accuracy > 0 ? accuracy : 2e-5;
    EXPECT_LT(reference::judge(image, reference, bound).max_error, bound);
    for (const int tile : {1, 7, 16}) {
      settings.mesh.tile_size = tile;
      settings.threads = tile % 3 + 1;
      EXPECT_TRUE(same_bits(Renderer(mesh, settings).render(oblique(), size, function), image)) << "tile " << tile;
    }
  }
}

TEST(Render, AMeshWithoutCellsIsABlankPicture) {
  const Image image = Renderer(scene::TetMesh{}, exact()).render(oblique(), {8, 8}, six_knots());
  for (const float v : image.rgba) EXPECT_EQ(v, 0);
  for (const float z : image.depth) EXPECT_TRUE(std::isinf(z));
}

TEST(Render, DepthIsThatOfTheFirstVisibleSample) {
  // The scalar is the height z. Matter begins at z = 0.25 and is seen from above, from z = 5.
  scene::TetMesh mesh = datasets::cube(3, 0.2);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) mesh.scalars[v] = mesh.positions[v].z;
  const TransferFunction function({{-1, {1, 1, 1}, 3}, {0, {1, 1, 1}, 3}, {0.25, {1, 1, 1}, 0}, {1, {1, 1, 1}, 0}});
  Camera camera;
  camera.position = {0.01, 0.02, 5};
  camera.focal_point = {0.01, 0.02, 0};
  camera.parallel_scale = 0.9;
  const Image image = Renderer(mesh, exact()).render(camera, {16, 16}, function);
  for (const float z : image.depth) EXPECT_NEAR(z, 4.75, 1e-6);  // float output
}

TEST(Render, ScalesAndOffsetsOfTheSceneDoNotChangeTheImage) {
  const ImageSize size{40, 40};
  const scene::TetMesh mesh = datasets::cube(4, 0.2);
  const Image expected = Renderer(mesh, exact()).render(oblique(), size, six_knots());
  const auto distance = [&](double scale, const glm::dvec3& offset) {
    scene::TetMesh moved = mesh;
    for (glm::dvec3& p : moved.positions) p = p * scale + offset;
    Camera camera = oblique();
    camera.position = camera.position * scale + offset;
    camera.focal_point = camera.focal_point * scale + offset;
    camera.parallel_scale *= scale;
    const TransferFunction original = six_knots();
    std::vector<scene::Knot> knots(original.knots().begin(), original.knots().end());
    for (scene::Knot& k : knots) k.extinction /= scale;
    const Image image = Renderer(moved, exact()).render(camera, size, TransferFunction(knots));
    double most = 0;
    for (std::size_t i = 0; i < image.rgba.size(); ++i)
      most = std::max(most, static_cast<double>(std::abs(image.rgba[i] - expected.rgba[i])));
    return most;
  };
  // Positions have 53 bits, so an offset of 7e6 cells leaves an error of 1e-9 of a cell.
  EXPECT_LT(distance(1e20, {0, 0, 0}), 1e-6);
  EXPECT_LT(distance(1e-20, {0, 0, 0}), 1e-6);
  EXPECT_LT(distance(1, {7e6, -3e6, 2e6}), 1e-6);
}

TEST(Render, ADistantEyeHoldsNoMoreSegments) {
  const scene::TetMesh mesh = datasets::cube(24, 0.2);
  const auto alive = [&](double distance) {
    Camera camera;
    camera.position = glm::dvec3(0.3, 0.2, 1) * distance;
    camera.parallel_scale = 1.8;
    Settings settings = exact();
    settings.mesh.tile_size = 64;
    FrameStatistics statistics;
    Renderer(mesh, settings).render(camera, {64, 64}, six_knots(), &statistics);
    return statistics.max_segments_alive;
  };
  EXPECT_LE(alive(1e9), 2 * alive(5));
}

/// Colour and extinction change between any two of `count` knots.
TransferFunction zigzag(int count, double least) {
  std::vector<scene::Knot> knots;
  knots.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i)
    knots.push_back(
        {static_cast<double>(i) / (count - 1), glm::dvec3(i % 2, 0.5, 1 - i % 2), least + (i % 2) * (1 + least / 4)});
  return TransferFunction(knots);
}

TEST(Render, ScalarsRoundedEquallyAlongARayStayWithinTheBound) {
  // The field is constant except at two corners. Its value is in the middle of pieces of the function in which colour
  // and extinction change as fast as allowed, so every segment has the same error.
  const ImageSize size{24, 24};
  for (const bool automatic : {false, true})
    for (const scene::Emission emission : {scene::Emission::absorption, scene::Emission::independent})
      for (const double least : {0.0, 2.4, 200.0}) {
        const TransferFunction function = zigzag(automatic ? 1024 : 256, least);
        Settings settings = automatic ? Settings() : exact();
        settings.emission = emission;
        const double promised = automatic ? settings.integrator.accuracy : 2e-5;
        for (const double value : {0.0013, 0.3333, 0.9017}) {
          scene::TetMesh mesh = datasets::cube(6, 0.2);
          std::fill(mesh.scalars.begin(), mesh.scalars.end(), value);
          mesh.scalars.front() = 0, mesh.scalars.back() = 1;
          FrameStatistics statistics;
          const Image image = Renderer(mesh, settings).render(oblique(), size, function, &statistics);
          if (emission == scene::Emission::absorption) {
            EXPECT_EQ(statistics.on_lattice, projection::lattice_available() && least > 0) << automatic << least;
          }
          const reference::Reference reference(mesh, oblique(), size, function, emission);
          EXPECT_LT(reference::judge(image, reference, promised).max_error, promised)
              << automatic << ' ' << least << ' ' << value;
        }
      }
}

TEST(Render, RefusesImpossibleSettings) {
  const scene::TetMesh mesh = datasets::cube(4, 0);
  Settings settings = exact();
  settings.memory_bytes = 1000;
  EXPECT_THROW(Renderer(mesh, settings).render(oblique(), {8, 8}, six_knots()), scene::Error);
  Camera camera = oblique();
  camera.focal_point = camera.position;
  EXPECT_THROW(Renderer(mesh, exact()).render(camera, {8, 8}, six_knots()), scene::Error);
  EXPECT_THROW(Renderer(mesh, exact()).render(oblique(), {0, 8}, six_knots()), scene::Error);
}

}  // namespace
}  // namespace tessera::frame::render_test
