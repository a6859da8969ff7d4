// SPDX-License-Identifier: BSD-3-Clause
// Iso-surfaces of grids, compared with positions and colours in closed form and with the double-precision reference.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <glm/geometric.hpp>
#include <random>

#include "reference/grid/grid_reference.hpp"
#include "reference/judge.hpp"
#include "scene/error.hpp"
#include "support/instruction_sets.hpp"
#include "support/some_cases.hpp"
#include "volume/chunk_cast.hpp"
#include "volume/image_sink.hpp"
#include "volume/render.hpp"
#include "volume/small_volume.hpp"

namespace tessera::grid_surfaces_test {
namespace {

using namespace tests;  // small volumes and views
using scene::ProjectionKind;
using scene::TransferFunction;

constexpr double promised_error = 1e-5;  // docs/ACCURACY.md: of exact

using Place = std::function<double(const glm::dvec3&)>;

std::unique_ptr<scene::MemorySource> volume_of(scene::GridGeometry geometry, const Place& field) {
  scene::Grid grid;
  grid.geometry = std::move(geometry);
  const scene::GridIndex n = grid.geometry.samples();
  std::vector<float> values;
  for (std::int64_t k = 0; k < n[2]; ++k)
    for (std::int64_t j = 0; j < n[1]; ++j)
      for (std::int64_t i = 0; i < n[0]; ++i)
        values.push_back(
            static_cast<float>(field(scene::world_of_index(grid.geometry, {double(i), double(j), double(k)}))));
  return scene::MemorySource::of(grid, std::move(values));
}

/// [-1, 1]^3 in 8 voxels a side.
scene::GridGeometry cube() {
  scene::GridGeometry g;
  g.points = {9, 9, 9};
  g.origin = glm::dvec3(-1);
  g.spacing = glm::dvec3(0.25);
  return g;
}

double ramp(const glm::dvec3& p) { return p.z / 2 + 0.5; }
TransferFunction clear() { return TransferFunction({{0, {0.2, 0.4, 0.6}, 0}, {1, {0.2, 0.4, 0.6}, 0}}); }
TransferFunction grey_fog() { return TransferFunction({{0, {0.5, 0.5, 0.5}, 0.7}, {1, {0.5, 0.5, 0.5}, 0.7}}); }

scene::Camera from(const glm::dvec3& position, ProjectionKind kind = ProjectionKind::orthographic) {
  scene::Camera camera;
  camera.position = position;
  camera.projection = kind;
  camera.parallel_scale = 1.5;
  camera.view_angle = 38;
  return camera;
}

volume::RenderSettings exact_with(const Surfaces& surfaces) {
  volume::RenderSettings settings = exact();
  settings.surfaces = surfaces;
  settings.threads = 2;
  return settings;
}

TEST(GridSurface, OfARampIsAPlaneLitByItsAngleAtTheDepthWhereTheFieldHasItsValue) {
  const scene::ImageSize small{24, 24};
  Surfaces surfaces;
  const auto source = volume_of(cube(), ramp);
  for (const double value : {0.625, 0.6}) {  // in a plane of the lattice, and between two
    surfaces.iso = {{value, glm::dvec3(0.5, 0.25, 0), 0.4}};
    const scene::Camera camera = from({2, 0, 4});
    const scene::Image image = volume::Renderer(*source, exact_with(surfaces)).render(camera, small, clear()).image;
    const std::size_t middle = image.index(12, 12);
    const double cosine = 4 / std::sqrt(20.0);
    const double matte = 0.2 + 0.8 * cosine, shine = 0.2 * std::pow(cosine, 32);
    EXPECT_NEAR(image.rgba[4 * middle], 0.4 * (0.5 * matte + shine), 1e-6);
    EXPECT_NEAR(image.rgba[4 * middle + 1], 0.4 * (0.25 * matte + shine), 1e-6);
    EXPECT_NEAR(image.rgba[4 * middle + 2], 0.4 * shine, 1e-6);
    EXPECT_NEAR(image.rgba[4 * middle + 3], 0.4, 1e-6);
    // The centre of the middle pixel is half a pixel (1.5 / 24) to the right of and above the axis; up is not along z.
    const glm::dvec3 forward = glm::normalize(glm::dvec3(-2, 0, -4)), right = glm::cross(forward, {0, 1, 0});
    const glm::dvec3 start = glm::dvec3(2, 0, 4) + (right - glm::cross(right, forward)) * (1.5 / 24);
    EXPECT_NEAR(image.depth[middle], (2 * value - 1 - start.z) / forward.z, 1e-6);
  }
}

TEST(GridSurface, IsBetweenTheDataInFrontAndBehind) {
  const scene::ImageSize small{8, 8};
  Surfaces surfaces;
  surfaces.light = {1, 0, 0, 1};
  const auto source = volume_of(cube(), ramp);
  for (const double side : {1.0, -1.0})
    for (const double opacity : {1.0, 0.25}) {
      surfaces.iso = {{0.5, glm::dvec3(1, 0, 0), opacity}};
      const auto image =
          volume::Renderer(*source, exact_with(surfaces)).render(from({0, 0, 4 * side}), small, grey_fog()).image;
      const std::size_t middle = 4 * image.index(4, 4);
      const double through = std::exp(-0.7), fog = 1 - through;  // for one unit of fog on either side; half is grey
      const double behind = through * (1 - opacity);
      EXPECT_NEAR(image.rgba[middle], 0.5 * fog + through * opacity + behind * 0.5 * fog, 2e-6);
      EXPECT_NEAR(image.rgba[middle + 1], 0.5 * fog + behind * 0.5 * fog, 2e-6);
      EXPECT_NEAR(image.rgba[middle + 3], 1 - behind * through, 2e-6);
    }
}

/// Rays in planes of the lattice and between them. The surface's value is that of one layer of samples, or of several
/// adjacent layers.
TEST(GridSurface, AtTheValueOfSamplesIsHitOnce) {
  const scene::ImageSize small{33, 33};  // pixels of 1 / 11: some centres are in lattice planes
  Surfaces surfaces;
  surfaces.iso = {{0.5, glm::dvec3(1), 0.5}};
  surfaces.light = {1, 0, 0, 1};
  const auto plateau = [](const glm::dvec3& p) {
    const double z = ramp(p);
    return z < 0.25 ? 2 * z : z <= 0.75 ? 0.5 : 2 * (z - 0.5);
  };
  for (const Place& field : {Place(ramp), Place(plateau)}) {
    const auto source = volume_of(cube(), field);
    for (const double side : {1.0, -1.0})
      for (const double scale : {1.5, 33 / 32.0}) {
        scene::Camera camera = from({0, 0, 4 * side});
        camera.parallel_scale = scale;
        const auto image = volume::Renderer(*source, exact_with(surfaces)).render(camera, small, clear()).image;
        for (int y = 6; y < 27; ++y)
          for (int x = 6; x < 27; ++x) EXPECT_NEAR(image.rgba[4 * image.index(x, y) + 3], 0.5, 1e-6) << x << ' ' << y;
      }
  }
}

/// More values than a vector has lanes.
TEST(GridSurface, ManyInOneVoxelAreAllHitInOrder) {
  constexpr int count = 40;
  constexpr double opacity = 0.02;
  Surfaces surfaces;
  surfaces.light = {1, 0, 0, 1};
  for (int n = 0; n < count; ++n)
    surfaces.iso.push_back({0.505 + 0.11 * n / count, glm::dvec3(n + 1 == count ? 1 : 0, n == 0 ? 1 : 0, 0), opacity});
  const auto source = volume_of(cube(), ramp);
  const double first = opacity, last = opacity * std::pow(1 - opacity, count - 1);
  for (const bool shaded : {false, true})
    for (const double side : {1.0, -1.0}) {
      volume::RenderSettings settings = exact_with(surfaces);
      if (shaded) settings.grid.shading.emplace();
      const auto image = volume::Renderer(*source, settings).render(from({1, 0.7, 4 * side}), {24, 24}, clear()).image;
      const std::size_t middle = 4 * image.index(12, 12);
      EXPECT_NEAR(image.rgba[middle], side > 0 ? first : last, 1e-6);
      EXPECT_NEAR(image.rgba[middle + 1], side > 0 ? last : first, 1e-6);
      EXPECT_NEAR(image.rgba[middle + 3], 1 - std::pow(1 - opacity, count), 2e-6);
    }
}

TEST(GridSurface, FewRaysThatMeetThemAreCastAgainInDoublePrecision) {
  const Volume volume = make_volume({45, 37, 41}, Field::smooth);
  Surfaces surfaces;
  for (int n = 1; n < 10; ++n)
    surfaces.iso.push_back({0.1 * n + 0.037, std::nullopt, 0.3});  // not at a side of the volume
  for (const char* name : {"oblique", "perspective"}) {
    const volume::RenderStatistics statistics =
        volume::Renderer(*volume.source, exact_with(surfaces)).render(view(name), size, smooth_function()).statistics;
    EXPECT_LT(static_cast<double>(statistics.pixels_again), 0.005 * static_cast<double>(statistics.rays)) << name;
  }
}

/// Samples are integers, and many equal a surface's value. So the field has this value on sides, edges and whole
/// voxels.
TEST(GridSurface, OfWholeNumbersAreFoundInLanesWhereSidesOfVoxelsHaveTheirValue) {
  scene::Grid grid;
  grid.geometry.points = {33, 29, 31};
  const scene::GridIndex n = grid.geometry.points;
  std::vector<std::uint8_t> values;
  for (std::int64_t k = 0; k < n[2]; ++k)
    for (std::int64_t j = 0; j < n[1]; ++j)
      for (std::int64_t i = 0; i < n[0]; ++i)
        values.push_back(static_cast<std::uint8_t>(std::lround(
            20 + 14 * std::sin(0.3 * double(i)) + 10 * std::cos(0.25 * double(j)) * std::sin(0.2 * double(k)))));
  const auto source = scene::MemorySource::of(grid, values);
  const TransferFunction function({{0, {0.2, 0.4, 0.6}, 0.01}, {40, {0.9, 0.4, 0.1}, 0.05}});
  Surfaces surfaces;
  surfaces.iso = {{10, std::nullopt, 0.3}, {20, glm::dvec3(0, 1, 0.5), 0.3}, {30, std::nullopt, 0.3}};
  scene::Camera camera;
  camera.focal_point = {16, 14, 15};
  camera.position = {50, 33, 61};
  camera.projection = ProjectionKind::orthographic;
  camera.parallel_scale = 25;
  const volume::Frame frame = volume::Renderer(*source, exact_with(surfaces)).render(camera, size, function);
  const reference::GridReference truth(*source, camera, size, function, scene::Emission::absorption, {}, {}, surfaces);
  EXPECT_LE(reference::judge(frame.image, truth, promised_error, {}, 2).max_error_not_excused, promised_error);
  EXPECT_LT(static_cast<double>(frame.statistics.pixels_again), 0.05 * static_cast<double>(frame.statistics.rays));
}

TEST(GridSurface, OutsideTheFieldsRangeOrOnTheBoundaryIsEmpty) {
  Surfaces surfaces;
  surfaces.iso = {{-0.1, {}, 1}, {1.1, {}, 1}, {0, {}, 1}};
  const auto source = volume_of(cube(), ramp);
  const auto image = volume::Renderer(*source, exact_with(surfaces)).render(from({2, 1, 4}), {16, 16}, clear()).image;
  for (const float v : image.rgba) EXPECT_EQ(v, 0.0f);
}

TEST(GridSurface, InAClipPlaneIsVisibleExactlyOverLowerValues) {
  Surfaces surfaces;
  surfaces.iso = {{0.3 / 2 + 0.5, glm::dvec3(1), 0.5}};
  surfaces.light = {1, 0, 0, 1};
  const auto source = volume_of(cube(), ramp);
  for (const double side : {1.0, -1.0})
    for (const double kept : {1.0, -1.0}) {
      volume::RenderSettings settings = exact_with(surfaces);
      settings.clip = {{{0, 0, 0.3}, {0, 0, kept}}};
      const auto image = volume::Renderer(*source, settings).render(from({1, 0.7, 4 * side}), {24, 24}, clear()).image;
      for (int y = 9; y < 15; ++y)
        for (int x = 9; x < 15; ++x)
          EXPECT_NEAR(image.rgba[4 * image.index(x, y) + 3], kept < 0 ? 0.5 : 0, 1e-6) << side << ' ' << kept;
    }
}

int wanted(const char* name, int otherwise) {
  const char* const word = std::getenv(name);
  return word == nullptr ? otherwise : std::atoi(word);
}

/// One random scene.
struct Case {
  std::unique_ptr<scene::MemorySource> source;
  scene::Camera camera;
  TransferFunction function;
  volume::RenderSettings settings;
};

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  int below(int n) { return std::uniform_int_distribution<int>(0, n - 1)(engine_); }
  bool chance(double p) { return uniform(0, 1) < p; }
  glm::dvec3 direction() {
    glm::dvec3 d;
    do d = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
    while (glm::length(d) < 0.1 || glm::length(d) > 1);
    return glm::normalize(d);
  }

 private:
  std::mt19937 engine_;
};

scene::GridGeometry random_geometry(Random& random) {
  scene::GridGeometry g;
  const int most = random.chance(0.3) ? 20 : 7;  // more than two cells of 8^3, or one
  for (std::int64_t& points : g.points) points = random.chance(0.15) ? 2 : 3 + random.below(most);
  g.origin = random.uniform(0, 3) * random.direction();
  for (int axis = 0; axis < 3; ++axis) g.spacing[axis] = random.chance(0.4) ? 0.5 : random.uniform(0.2, 1.2);
  if (random.chance(0.3)) {
    const glm::dvec3 x = random.direction(), y = glm::normalize(glm::cross(x, random.direction()));
    g.direction = {x, y, glm::cross(x, y)};
  }
  if (random.chance(0.25))
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double place = 0;
      for (std::int64_t n = 0; n < g.points[axis]; ++n, place += random.uniform(0.1, 0.9))
        g.coordinates[axis].push_back(place);
    }
  return g;
}

Surfaces random_surfaces(Random& random, const std::vector<float>& values) {
  Surfaces surfaces;
  const int count = 1 + random.below(random.chance(0.2) ? 20 : 4);
  for (int n = 0; n < count; ++n) {
    const float of_sample = values[static_cast<std::size_t>(random.below(static_cast<int>(values.size())))];
    IsoSurface iso{of_sample, std::nullopt, 1};
    if (random.chance(0.1)) iso.value = std::nextafter(iso.value, random.chance(0.5) ? 9.0 : -9.0);
    if (random.chance(0.5)) iso.value = random.uniform(0, 1);
    if (random.chance(0.7)) iso.color = glm::dvec3(random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1));
    if (random.chance(0.7)) iso.opacity = random.uniform(0.05, 1);
    surfaces.iso.push_back(iso);
  }
  return surfaces;
}

Case random_case(unsigned number) {
  Random random(50017u + number);
  Case c;
  scene::Grid grid;
  grid.geometry = random_geometry(random);
  const scene::GridIndex n = grid.geometry.samples();
  // Few values, so that edges, sides and voxels are constant.
  const int steps = random.chance(0.4) ? 1 + random.below(4) : 0;
  const bool blanks = random.chance(0.2), smooth = random.chance(0.4);
  std::vector<float> values;
  const glm::dvec3 wave = random.uniform(0.2, 1.5) * random.direction();
  for (std::int64_t sample = 0; sample < n[0] * n[1] * n[2]; ++sample) {
    const glm::dvec3 at(double(sample % n[0]), double(sample / n[0] % n[1]), double(sample / n[0] / n[1]));
    double v = smooth ? 0.5 + 0.5 * std::sin(glm::dot(wave, at)) : random.uniform(0, 1);
    if (steps > 0) v = std::round(v * steps) / steps;
    values.push_back(static_cast<float>(v));
  }
  c.settings = exact_with(random_surfaces(random, values));
  if (blanks)
    for (float& v : values) v = random.chance(0.02) ? NAN : v;
  const scene::GridGeometry& g = grid.geometry;
  const scene::Box box = scene::bounds(g);
  const glm::dvec3 middle = (box.low + box.high) / 2.0, extent = box.high - box.low;
  const double size_of_all = glm::length(extent);
  c.camera.focal_point = middle;
  c.camera.position = middle + (random.chance(0.2) ? 0.15 : 1.6) * size_of_all * random.direction();
  c.camera.parallel_scale = 0.5 * size_of_all;
  c.camera.view_up = random.direction();
  if (random.chance(0.5)) c.camera.projection = ProjectionKind::perspective, c.camera.view_angle = 45;
  if (random.chance(0.3)) {  // along an axis, rays in planes of the lattice
    const int axis = random.below(3);
    c.camera.projection = ProjectionKind::orthographic;
    c.camera.position = middle;
    c.camera.position += g.direction[axis] * (random.chance(0.5) ? 2.0 : -2.0) * size_of_all;
    c.camera.view_up = g.direction[(axis + 1) % 3];
    if (random.chance(0.7)) c.camera.parallel_scale = 0.5 * size.height * g.spacing[0] / (1 << random.below(4));
  }
  std::vector<scene::Knot> knots;
  const int knot_count = 2 + random.below(4);
  for (int k = 0; k < knot_count; ++k)
    knots.push_back({k / (knot_count - 1.0),
                     {random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)},
                     random.chance(0.4) ? 0 : std::pow(10, random.uniform(-1, 1.5)) / size_of_all});
  c.function = TransferFunction(knots);
  if (random.chance(0.25)) c.settings.grid.shading.emplace();
  if (random.chance(0.25)) {
    const glm::dvec3 inside = box.low + extent * glm::dvec3(random.uniform(0.2, 0.8), random.uniform(0.2, 0.8), 0.5);
    c.settings.clip.push_back({inside, random.direction()});
  }
  if (random.chance(0.15)) c.camera.clipping_range = scene::ClippingRange{1.3 * size_of_all, 1.8 * size_of_all};
  if (random.chance(0.2)) c.settings.emission = scene::Emission::independent, c.settings.grid.shading.reset();
  c.source = scene::MemorySource::of(grid, std::move(values));
  return c;
}

TEST(GridSurface, RandomSurfacesKeepThePromise) {
  const int first = wanted("TESSERA_RANDOM_FIRST", 0), last = first + wanted("TESSERA_RANDOM_CASES", 60);
  const scene::ImageSize small{48, 40};
  double worst = 0;
  std::size_t excused = 0, pixels = 0, seen = 0, tried = 0;
  test::SomeCases some(4);
  for (int number = first; number < last; ++number) {
    if (!some.next()) continue;
    ++tried;
    const Case c = random_case(static_cast<unsigned>(number));
    const auto image = volume::Renderer(*c.source, c.settings).render(c.camera, small, c.function).image;
    const reference::GridReference truth(*c.source, c.camera, small, c.function, c.settings.emission,
                                         c.settings.grid.shading, c.settings.clip, c.settings.surfaces);
    const auto judged = reference::judge(image, truth, promised_error, {}, 2);
    EXPECT_LE(judged.max_error_not_excused, promised_error)
        << "case " << number << ", at (" << judged.worst_x << ", " << judged.worst_y << ") of " << judged.over_bound
        << (c.source->geometry().rectilinear() ? " rectilinear" : "") << (c.settings.grid.shading ? " shaded" : "")
        << (c.settings.clip.empty() ? "" : " clipped");
    volume::RenderSettings without = c.settings;
    without.surfaces = {};
    seen += volume::Renderer(*c.source, without).render(c.camera, small, c.function).image.rgba != image.rgba ? 1 : 0;
    worst = std::max(worst, judged.max_error_not_excused), excused += judged.excused, pixels += judged.pixels_checked;
  }
  EXPECT_LE(static_cast<double>(excused), 1e-4 * static_cast<double>(pixels) + 3);
  EXPECT_GT(seen, tried * 3 / 4);
  std::printf("cases %d to %d: largest error %.3g, %zu of %zu pixels excused\n", first, last - 1, worst, excused,
              pixels);
}

/// Vectors of four and eight lanes look up surface values in memory, those of sixteen hold some.
TEST(GridSurface, RandomSurfacesKeepThePromiseOnEveryInstructionSet) {
  const scene::ImageSize small{24, 20};
  for_each_instruction_set([&](const std::string& name) {
    for (unsigned number = 0; number < 24; ++number) {
      const Case c = random_case(number);
      const auto image = volume::Renderer(*c.source, c.settings).render(c.camera, small, c.function).image;
      const reference::GridReference truth(*c.source, c.camera, small, c.function, c.settings.emission,
                                           c.settings.grid.shading, c.settings.clip, c.settings.surfaces);
      EXPECT_LE(reference::judge(image, truth, promised_error, {}, 2).max_error_not_excused, promised_error)
          << name << ", case " << number;
    }
  });
}

TEST(GridSurface, BitsDoNotDependOnBricksThreadsOrRegionsNorLightOnSkippedSpace) {
  const Volume volume = make_volume({45, 37, 41}, Field::smooth);
  Surfaces surfaces;
  surfaces.iso = {{0.4, glm::dvec3(1, 0.4, 0), 0.3}, {0.62, {}, 0.5}, {0.75, glm::dvec3(0, 1, 0.2), 1}};
  test::SomeCases some(5);
  for (const char* name : views)
    for (const bool shaded : {false, true}) {
      if (!some.next()) continue;
      volume::RenderSettings settings = exact_with(surfaces);
      if (shaded) settings.grid.shading.emplace();
      const scene::Image image = render(volume, view(name), sharp_function(), settings);
      volume::RenderSettings other = settings;
      other.grid.brick_size = 5, other.threads = 1;
      EXPECT_TRUE(same_bits(render(volume, view(name), sharp_function(), other), image)) << name;
      other.use.skipping = other.use.culling = false;
      const scene::Image all = render(volume, view(name), sharp_function(), other);
      for (std::size_t n = 0; n < image.rgba.size(); ++n) ASSERT_NEAR(all.rgba[n], image.rgba[n], 1e-6) << name;
      const scene::PixelRect region{12, 20, 64, 72};
      const scene::Image part = volume::Renderer(*volume.source, settings)
                                    .render(view(name), size, sharp_function(), {.regions = {region}})
                                    .image;
      for (int y = region.y0; y < region.y1; ++y)
        for (std::size_t n = 4 * image.index(region.x0, y); n < 4 * image.index(region.x1 - 1, y) + 4; ++n)
          ASSERT_EQ(part.rgba[n], image.rgba[n]) << name;
    }
}

TEST(GridSurface, GoesInChunksToo) {
  const Volume volume = make_volume({64, 20, 64}, Field::smooth);
  Surfaces surfaces;
  surfaces.iso = {{0.4, glm::dvec3(1, 0.4, 0), 0.3}, {0.75, glm::dvec3(0, 1, 0.2), 1}};
  volume::Renderer renderer(*volume.source, exact_with(surfaces));
  for (const char* name : {"oblique", "perspective"}) {
    const scene::Image whole = renderer.render(view(name), size, smooth_function()).image;
    scene::Image image(size);
    scene::FrameWatch unwatched;
    volume::ImageSink sink(image, nullptr, unwatched);
    volume::ChunkCast cast(renderer, view(name), size, smooth_function());
    for (const volume::VoxelBox& chunk : volume::boxes_front_to_back(volume.grid.geometry, {32, 20, 32}, view(name)))
      cast.advance(chunk);
    cast.emit(sink);
    for (std::size_t n = 0; n < image.rgba.size(); ++n) ASSERT_NEAR(image.rgba[n], whole.rgba[n], 2e-6) << name;
  }
}

}  // namespace
}  // namespace tessera::grid_surfaces_test
