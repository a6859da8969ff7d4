// SPDX-License-Identifier: BSD-3-Clause
#include "reference/grid/grid_reference.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <random>

#include "reference/judge.hpp"
#include "reference/reference.hpp"
#include "reference/small_meshes.hpp"
#include "scene/error.hpp"

namespace tessera::reference::grid_reference_test {
namespace {

using scene::Association;
using scene::Emission;
using scene::MemorySource;
using scene::ProjectionKind;
using scene::TransferFunction;

using Source = std::unique_ptr<MemorySource>;

scene::GridGeometry lattice(const scene::GridIndex& points, const glm::dvec3& low, const glm::dvec3& high) {
  scene::GridGeometry g;
  g.points = points;
  g.origin = low;
  for (int a = 0; a < 3; ++a)
    g.spacing[a] = (high[a] - low[a]) / static_cast<double>(points[static_cast<std::size_t>(a)] - 1);
  return g;
}

/// The field at the lattice points, or at the voxels' centres for cell data.
Source sampled(const scene::GridGeometry& geometry, const std::function<double(const glm::dvec3&)>& field) {
  scene::Grid grid;
  grid.geometry = geometry;
  const scene::GridIndex n = geometry.samples();
  const double half = geometry.association == Association::cell ? 0.5 : 0;
  std::vector<double> values;
  for (std::int64_t k = 0; k < n[2]; ++k)
    for (std::int64_t j = 0; j < n[1]; ++j)
      for (std::int64_t i = 0; i < n[0]; ++i)
        values.push_back(field(scene::world_of_index(
            geometry, glm::dvec3(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)) + half)));
  return MemorySource::of(grid, values);
}

const TransferFunction bumpy({{-1, {0.2, 0.4, 1}, 0},
                              {-0.3, {0.9, 0.1, 0.3}, 2},
                              {0.1, {0.1, 0.9, 0.2}, 0},
                              {0.1, {1, 1, 0}, 5},
                              {0.6, {0, 0.3, 1}, 0.5},
                              {1.2, {1, 1, 1}, 9}});

double wave(const glm::dvec3& p) { return std::sin(3 * p.x + p.y) * std::cos(2 * p.z - p.x) + 0.2 * p.y; }

void expect_equal(const Pixel& a, const Pixel& b, double tolerance) {
  EXPECT_NEAR(a.r, b.r, tolerance);
  EXPECT_NEAR(a.g, b.g, tolerance);
  EXPECT_NEAR(a.b, b.b, tolerance);
  EXPECT_NEAR(a.a, b.a, tolerance);
}

constexpr scene::ImageSize window{20, 16};
constexpr double rounding = 1e-12;  // a few hundred pieces, each accurate to about 1e-15

TEST(GridReference, AConstantFieldObeysBeerLambertInEveryProjection) {
  const Source source = sampled(lattice({5, 3, 4}, {-1, -1, -1}, {1, 1, 1}), [](auto&) { return 0.5; });
  const TransferFunction gray({{0.5, {1, 0.5, 0.25}, 1.3}});
  for (const ProjectionKind projection : {ProjectionKind::orthographic, ProjectionKind::perspective})
    for (const glm::dvec3 eye : {glm::dvec3(3, 2, 4), glm::dvec3(0.1, 0.2, 0.3)}) {
      const GridReference reference(*source, looking(eye, {0, 0, 0}, projection, 1), window, gray);
      double thickest = 0;
      for (const Pixel& p : reference.pixels(all_pixels(window))) {
        EXPECT_NEAR(p.a, -std::expm1(-1.3 * p.length), rounding);
        EXPECT_NEAR(p.r, p.a, rounding);
        EXPECT_NEAR(p.b, 0.25 * p.a, rounding);
        thickest = std::max(thickest, p.length);
      }
      EXPECT_GT(thickest, 0.7);  // if the eye is inside, only matter in front of it is visible
    }
}

TEST(GridReference, TheLengthInTheBoxIsThatOfItsChord) {
  const Source source = sampled(lattice({4, 4, 4}, {-1, -1, -1}, {1, 1, 1}), wave);
  const scene::Camera camera = looking({0, 0, 5}, {0, 0, 0}, ProjectionKind::orthographic, 1.5);
  const GridReference reference(*source, camera, {30, 30}, bumpy);
  EXPECT_NEAR(reference.pixel(15.3, 14.2).length, 2, rounding);
  EXPECT_EQ(reference.pixel(4.9, 15).length, 0);  // the box covers 20 of 30 pixels
}

TEST(GridReference, ALinearFieldIsTheSameAsInTetrahedra) {
  const auto linear = [](const glm::dvec3& p) { return 0.4 * p.x - 0.3 * p.y + 0.5 * p.z; };
  const Source source = sampled(lattice({4, 4, 4}, {-1, -1, -1}, {1, 1, 1}), linear);
  const scene::TetMesh mesh = box_of_tets(3, {-1, -1, -1}, {1, 1, 1}, linear);
  for (const Emission emission : {Emission::absorption, Emission::independent})
    for (const ProjectionKind projection : {ProjectionKind::orthographic, ProjectionKind::perspective}) {
      const scene::Camera camera = looking({2.1, 1.7, 3.3}, {0, 0, 0}, projection, 1.6);
      const GridReference grid(*source, camera, window, bumpy, emission);
      const Reference tets(mesh, camera, window, bumpy, emission);
      const auto a = grid.pixels(all_pixels(window)), b = tets.image();
      for (std::size_t i = 0; i < a.size(); ++i) {
        expect_equal(a[i], b[i], 1e-8);  // rays of tets are rounded to 2^-32 pixel
        if (a[i].a > 1e-6) {
          EXPECT_NEAR(a[i].z, b[i].z, 1e-6);
        }
      }
    }
}

TEST(GridReference, OneVoxelOfEightValuesIsTheSumOfVeryManySamples) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1, 1.2);
  scene::Grid grid;
  grid.geometry = lattice({2, 2, 2}, {0, 0, 0}, {1, 2, 0.5});
  std::vector<double> v(8);
  for (double& x : v) x = any(random);
  const Source source = MemorySource::of(grid, v);
  const scene::Camera camera = looking({2, 3, 2.5}, {0.5, 1, 0.25}, ProjectionKind::orthographic, 0.9);
  const GridReference reference(*source, camera, window, bumpy);
  const View view(camera, window);
  for (const auto& [x, y] : {std::array{10.2, 8.1}, std::array{8.0, 9.5}, std::array{12.4, 6.7}}) {
    const Pixel pixel = reference.pixel(x, y);
    ASSERT_GT(pixel.length, 0.1);
    constexpr int steps = 400000;
    const View::Ray ray = view.ray(x, y);
    const double begin = 0, end = 8, dz = (end - begin) / steps;
    double depth = 0, red = 0;
    for (int i = 0; i < steps; ++i) {
      const glm::dvec3 p = (ray.origin + ray.step * (begin + (i + 0.5) * dz)) / glm::dvec3(1, 2, 0.5);
      if (p.x < 0 || p.y < 0 || p.z < 0 || p.x > 1 || p.y > 1 || p.z > 1) continue;
      const auto mix = [](double a, double b, double u) { return a + (b - a) * u; };
      const double s = mix(mix(mix(v[0], v[1], p.x), mix(v[2], v[3], p.x), p.y),
                           mix(mix(v[4], v[5], p.x), mix(v[6], v[7], p.x), p.y), p.z);
      const scene::Knot k = bumpy.evaluate(s);
      red += k.extinction * k.color.x * std::exp(-depth - k.extinction * dz / 2) * dz;
      depth += k.extinction * dz;
    }
    EXPECT_NEAR(pixel.r, red, 5e-4);  // steps are 2e-5 long: errors at a step of the function by 5 and at both ends
    EXPECT_NEAR(pixel.a, -std::expm1(-depth), 5e-4);
  }
}

/// Blinn-Phong according to its paper, for a normal: the factor on the field's colour, and the white added.
std::array<double, 2> blinn_phong(const glm::dvec3& normal, const glm::dvec3& to_light, const glm::dvec3& to_eye,
                                  const scene::Shading& s) {
  const double angle = std::acos(std::min(1.0, std::abs(glm::dot(normal, glm::normalize(to_light + to_eye)))));
  return {s.ambient + s.diffuse * std::abs(glm::dot(normal, to_light)),
          s.specular * std::pow(std::cos(angle), s.shininess)};
}

TEST(GridReference, AShadedVoxelHasTheLightOfItsGradientInTheMiddleOfTheRay) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> any(-1, 1.2);
  const glm::dvec3 sides{1, 2, 0.5};
  scene::Grid grid;
  grid.geometry = lattice({2, 2, 2}, {0, 0, 0}, sides);
  std::vector<double> v(8);
  for (double& x : v) x = any(random);
  const auto field = [&](const glm::dvec3& p_world) {
    const glm::dvec3 p = p_world / sides;
    const auto mix = [](double a, double b, double u) { return a + (b - a) * u; };
    return mix(mix(mix(v[0], v[1], p.x), mix(v[2], v[3], p.x), p.y),
               mix(mix(v[4], v[5], p.x), mix(v[6], v[7], p.x), p.y), p.z);
  };
  const Source source = MemorySource::of(grid, v);
  for (const ProjectionKind projection : {ProjectionKind::orthographic, ProjectionKind::perspective})
    for (const bool camera_light : {true, false}) {
      const scene::Camera camera = looking({2, 3, 2.5}, {0.5, 1, 0.25}, projection, 0.9);
      const scene::Shading s{0.1, 0.7, 0.5, 11, {0.3, -0.4, 0.8}, camera_light};
      const GridReference plain(*source, camera, window, bumpy), shaded(*source, camera, window, bumpy, {}, s);
      const View view(camera, window);
      const scene::ViewBasis basis = scene::view_basis(camera);
      glm::dvec3 light = glm::normalize(s.to_light);
      if (camera_light) light = basis.right * light.x + basis.up * light.y - basis.forward * light.z;
      int met = 0;
      for (const PixelIndex p : all_pixels(window)) {
        const double x = p.x + 0.5, y = p.y + 0.5;
        const Pixel a = plain.pixel(x, y), b = shaded.pixel(x, y);
        if (!(a.length > 0)) continue;
        const View::Ray ray = view.ray(x, y);
        double enter = 0, leave = 1e9;
        for (int axis = 0; axis < 3; ++axis) {
          const double one = -ray.origin[axis] / ray.step[axis],
                       other = (sides[axis] - ray.origin[axis]) / ray.step[axis];
          enter = std::max(enter, std::min(one, other)), leave = std::min(leave, std::max(one, other));
        }
        const glm::dvec3 middle = ray.origin + ray.step * ((enter + leave) / 2);
        glm::dvec3 gradient;  // the field is linear along each axis
        for (int axis = 0; axis < 3; ++axis) {
          glm::dvec3 step(0);
          step[axis] = 0.1;
          gradient[axis] = (field(middle + step) - field(middle - step)) / 0.2;
        }
        const auto [own, white] = blinn_phong(glm::normalize(gradient), light, -glm::normalize(ray.step), s);
        EXPECT_NEAR(b.r, own * a.r + white * a.a, 1e-10);
        EXPECT_NEAR(b.g, own * a.g + white * a.a, 1e-10);
        EXPECT_NEAR(b.b, own * a.b + white * a.a, 1e-10);
        EXPECT_NEAR(b.a, a.a, rounding);
        ++met;
      }
      EXPECT_GT(met, 20);
    }
}

TEST(GridReference, WhereThereIsNoGradientNothingIsShaded) {
  const scene::Camera camera = looking({2, 3, 2.5}, {0, 0, 0}, ProjectionKind::orthographic, 1.6);
  const Source flat = sampled(lattice({4, 4, 4}, {-1, -1, -1}, {1, 1, 1}), [](auto&) { return 1e6 + 0.1; });
  scene::GridGeometry cells = lattice({4, 4, 4}, {-1, -1, -1}, {1, 1, 1});
  cells.association = Association::cell;
  const Source constant = sampled(cells, wave);
  for (const Source* source : {&flat, &constant}) {
    const GridReference plain(**source, camera, window, bumpy),
        shaded(**source, camera, window, bumpy, {}, scene::Shading());
    for (const PixelIndex p : all_pixels(window))
      expect_equal(shaded.pixel(p.x + 0.5, p.y + 0.5), plain.pixel(p.x + 0.5, p.y + 0.5), 0);
  }
  scene::Shading dark;
  dark.to_light = glm::dvec3(0);
  EXPECT_THROW(GridReference(*flat, camera, window, bumpy, {}, dark), scene::Error);
  EXPECT_THROW(GridReference(*flat, camera, window, bumpy, Emission::independent, scene::Shading()), scene::Error);
}

TEST(GridReference, RectilinearTurnedAndScaledGridsOfOneFieldAgree) {
  const scene::GridGeometry plain = lattice({7, 5, 6}, {-1, -1, -1}, {1, 1, 1});
  const Source source = sampled(plain, wave);
  std::vector<double> values(7 * 5 * 6);
  source->read(plain.all_samples(), std::span(values));
  scene::Grid listed;
  listed.geometry = plain;
  listed.geometry.origin = {0, 0, 0};
  for (std::size_t a = 0; a < 3; ++a)
    for (std::int64_t i = 0; i < plain.points[a]; ++i)
      listed.geometry.coordinates[a].push_back(-1 + plain.lattice(a, i));
  listed.scale = -2;
  std::vector<double> halved(values);
  for (double& v : halved) v /= -2;

  // Axes (i, j, k) along (y, z, x): the same samples in another order.
  scene::Grid turned;
  turned.geometry = plain;
  turned.geometry.points = {5, 6, 7};
  turned.geometry.spacing = {plain.spacing.y, plain.spacing.z, plain.spacing.x};
  turned.geometry.direction = {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
  std::vector<double> reordered;
  for (std::size_t x = 0; x < 7; ++x)
    for (std::size_t z = 0; z < 6; ++z)
      for (std::size_t y = 0; y < 5; ++y) reordered.push_back(values[(z * 5 + y) * 7 + x]);

  const Source a = MemorySource::of(listed, halved), b = MemorySource::of(turned, reordered);
  const scene::Camera camera = looking({2.1, 1.7, 3.3}, {0, 0, 0}, ProjectionKind::perspective, 1.6);
  const GridReference first(*source, camera, window, bumpy), second(*a, camera, window, bumpy),
      third(*b, camera, window, bumpy);
  for (const PixelIndex p : all_pixels(window)) {
    const Pixel truth = first.pixel(p.x + 0.5, p.y + 0.5);
    expect_equal(second.pixel(p.x + 0.5, p.y + 0.5), truth, 1e-10);  // other roundings, extinction 9
    expect_equal(third.pixel(p.x + 0.5, p.y + 0.5), truth, 1e-10);
  }
}

TEST(GridReference, CellDataIsConstantInVoxelsAndRaysInTheirFacesAreDecided) {
  scene::GridGeometry g = lattice({3, 3, 3}, {-1, -1, -1}, {1, 1, 1});
  g.association = Association::cell;
  const Source source = sampled(g, [](const glm::dvec3& p) { return (p.x < 0 ? 0 : 1) + (p.z < 0 ? 0 : 2.0); });
  std::vector<scene::Knot> knots;
  for (int v = 0; v < 4; ++v) knots.push_back({static_cast<double>(v), {1, 1, 1}, v + 1.0});
  const scene::Camera camera = looking({0, 0, 5}, {0, 0, 0}, ProjectionKind::orthographic, 1);
  const GridReference reference(*source, camera, {10, 10}, TransferFunction(knots));
  EXPECT_NEAR(reference.pixel(2, 3).a, -std::expm1(-(1 + 3)), rounding);
  EXPECT_NEAR(reference.pixel(7, 3).a, -std::expm1(-(2 + 4)), rounding);
  EXPECT_NEAR(reference.pixel(5, 5).a, -std::expm1(-(2 + 4)), rounding);  // in x = 0: the shift goes right
  EXPECT_NEAR(reference.pixel(0, 5).a, -std::expm1(-(1 + 3)), rounding);  // in the left boundary: the shift goes inside
  EXPECT_EQ(reference.pixel(10, 5).a, 0);                                 // in the right one: outside
}

TEST(GridReference, ABlankSampleBlanksItsVoxelsAndNoMore) {
  scene::GridGeometry g = lattice({4, 2, 2}, {0, 0, 0}, {3, 1, 1});
  scene::Grid grid;
  grid.geometry = g;
  std::vector<double> values(16, 0.5);
  values[2] = std::nan("");  // at (2, 0, 0): voxels 1 and 2 of three
  const Source source = MemorySource::of(grid, values);
  const scene::Camera camera = looking({-5, 0.5, 0.5}, {0, 0.5, 0.5}, ProjectionKind::orthographic, 1);
  const GridReference reference(*source, camera, {11, 11}, TransferFunction({{0, {1, 1, 1}, 0.7}}));
  const Pixel pixel = reference.pixel(5.5, 5.4);
  EXPECT_NEAR(pixel.length, 1, rounding);
  EXPECT_NEAR(pixel.a, -std::expm1(-0.7), rounding);
  EXPECT_NEAR(pixel.z, 5, rounding);
}

TEST(GridReference, KnotsNearerThanTheRoundingOfTheFieldHaveNoEffect) {
  // One function has knots from 1e-40 to 1. The other has only those from 1e-12 on, where colour and extinction are
  // constant.
  constexpr int count = 160;
  std::vector<scene::Knot> all, large;
  for (int n = 0; n <= count; ++n) {
    const double x = std::min(1.0, n / (0.7 * count));
    all.push_back({std::pow(10, 40.0 * n / count - 40), {x, 0.5 + 0.5 * std::sin(17 * x), 1 - x}, 2 * x});
    if (x == 1) large.push_back(all.back());
  }
  scene::Camera camera;
  camera.position = {1.8, -1.9, 2.1};
  camera.parallel_scale = 1.5;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> decade(-40, 0);
  for (int i = 0; i < 20; ++i) {
    // Every second sample is large, so that the field is small only at points.
    int n = 0;
    const Source grid = sampled(lattice({4, 5, 6}, glm::dvec3(-1), glm::dvec3(1)),
                                [&](const glm::dvec3&) { return ++n % 2 == 0 ? 1 : std::pow(10, decade(random)); });
    const GridReference one(*grid, camera, {16, 16}, TransferFunction(all)),
        other(*grid, camera, {16, 16}, TransferFunction(large));
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x) expect_equal(one.pixel(x + 0.5, y + 0.5), other.pixel(x + 0.5, y + 0.5), 1e-6);
  }
}

TEST(GridReference, ClippingCutsTheRay) {
  const Source source = sampled(lattice({4, 4, 4}, {-1, -1, -1}, {1, 1, 1}), [](auto&) { return 1.0; });
  scene::Camera camera = looking({0, 0, 5}, {0, 0, 0}, ProjectionKind::orthographic, 1);
  camera.clipping_range = scene::ClippingRange{4.5, 5.25};
  const GridReference reference(*source, camera, {10, 10}, TransferFunction({{0, {1, 1, 1}, 1}}));
  EXPECT_NEAR(reference.pixel(4.9, 5.2).length, 0.75, rounding);
}

TEST(GridReference, TheJudgeAcceptsIt) {
  const Source source = sampled(lattice({6, 6, 6}, {-1, -1, -1}, {1, 1, 1}), wave);
  const scene::Camera camera = looking({2, 1, 3}, {0, 0, 0}, ProjectionKind::orthographic, 1.6);
  const GridReference reference(*source, camera, window, bumpy);
  scene::Image image(window);
  const auto truth = reference.pixels(all_pixels(window));
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double rgba[4] = {truth[i].r, truth[i].g, truth[i].b, truth[i].a};
    for (std::size_t c = 0; c < 4; ++c) image.rgba[4 * i + c] = static_cast<float>(rgba[c]);
  }
  EXPECT_TRUE(judge(image, reference, 1e-7).passed);
  image.rgba[4 * image.index(10, 8) + 1] += 1e-3f;
  EXPECT_FALSE(judge(image, reference, 1e-4).passed);
}

}  // namespace
}  // namespace tessera::reference::grid_reference_test
