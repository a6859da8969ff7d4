// SPDX-License-Identifier: BSD-3-Clause
#include "tessera/shading.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <tuple>

#include "api/query_data.hpp"
#include "api/random_cases.hpp"
#include "datasets/modify.hpp"
#include "frame/image_difference.hpp"
#include "frame/surface_scenes.hpp"
#include "scene/error.hpp"
#include "support/deep_pixels.hpp"
#include "tessera/field_queries.hpp"
#include "tessera/session.hpp"

/// Meshes whose matter is lit by the field's gradient, compared with light known in closed form and with the reference.
namespace tessera::shading_test {
namespace {

using frame::Random;
using frame::RandomCase;

/// A cube in [-1, 1]^3 with a field that increases along (1, 2, 2) / 3.
constexpr glm::dvec3 normal{1 / 3.0, 2 / 3.0, 2 / 3.0};
scene::TetMesh ramp() {
  return tests::with_field(datasets::cube(6), [](const glm::dvec3& p) { return glm::dot(p, normal); });
}

const TransferFunction fog({{-2, {0.5, 0.3, 0.1}, 0.6}, {2, {0.5, 0.3, 0.1}, 0.6}});

View view_from(const glm::dvec3& eye, ProjectionKind kind) { return {frame::view(kind, eye), {32, 24}}; }

Settings shaded(const Shading& shading = {}) {
  Settings settings;
  settings.integrator.kind = IntegratorKind::exact;
  settings.mesh.shading = shading;
  return settings;
}

/// The direction of a pixel's ray, with unit length.
glm::dvec3 ray_of(const View& view, int x, int y) {
  const ViewBasis basis = view_basis(view.camera);
  if (view.camera.projection == ProjectionKind::orthographic) return basis.forward;
  const double half = std::tan(glm::radians(view.camera.view_angle) / 2);
  return glm::normalize(basis.forward + basis.right * ((x + 0.5 - 16) / 12 * half) +
                        basis.up * ((12 - y - 0.5) / 12 * half));
}

TEST(MeshShading, OfARampIsLitByItsAngle) {
  const Dataset data = Dataset::of(datasets::arrays_of(ramp()));
  Shading from_the_side;
  from_the_side.to_light = {0.5, 1, 0.7};
  Shading in_the_world = from_the_side;
  in_the_world.camera_light = false;
  in_the_world.shininess = 7.5;
  for (const Shading& shading : {Shading(), from_the_side, in_the_world})
    for (const auto kind : {ProjectionKind::orthographic, ProjectionKind::perspective}) {
      const View view = view_from({2, 1, 4}, kind);
      const ViewBasis basis = view_basis(view.camera);
      const glm::dvec3 l = glm::normalize(shading.to_light);
      const glm::dvec3 light = shading.camera_light ? basis.right * l.x + basis.up * l.y - basis.forward * l.z : l;
      const Image image = Session(data, shaded(shading)).render(view, fog).image;
      int seen = 0;
      for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 32; ++x) {
          const float* pixel = &image.rgba[4 * image.index(x, y)];
          const glm::dvec3 half = glm::normalize(light - ray_of(view, x, y));
          const double own = shading.ambient + shading.diffuse * std::abs(glm::dot(normal, light));
          const double white = shading.specular * std::pow(std::abs(glm::dot(normal, half)), shading.shininess);
          for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(pixel[c], (own * fog.knots()[0].color[c] + white) * pixel[3], 1e-6) << x << ' ' << y;
          seen += pixel[3] > 0.1 ? 1 : 0;
        }
      EXPECT_GT(seen, 100);
    }
}

TEST(MeshShading, LeavesWhatHasNoGradientAsItIs) {
  scene::TetMesh flat = tests::with_field(datasets::cube(4), [](const glm::dvec3&) { return 0.25; });
  scene::TetMesh nearly = flat;
  for (std::size_t i = 0; i < nearly.scalars.size(); i += 2) nearly.scalars[i] = std::nextafter(0.25, 1);
  const View view = view_from({2, 1, 4}, ProjectionKind::orthographic);
  for (const scene::TetMesh& mesh : {flat, nearly, datasets::with_cell_data(datasets::cube(4))}) {
    const Dataset data = Dataset::of(datasets::arrays_of(mesh));
    Settings dark = shaded();
    dark.mesh.shading.reset();
    EXPECT_EQ(Session(data, shaded()).render(view, fog).image.rgba, Session(data, dark).render(view, fog).image.rgba);
  }
}

/// Cubes, slivers and seams, in random views and light, sometimes with surfaces.
RandomCase random_case(Random& random) {
  RandomCase c;
  const int kind = random.below(4);
  c.mesh = kind == 0   ? datasets::slivers(3, random.power(1.5, 4))
           : kind == 1 ? datasets::graded(4, random.power(0, 4))
           : kind == 2 ? datasets::regular_split(3, 3, 3)
                       : datasets::cube(2 + random.below(4), random.uniform(0, 0.25));
  if (kind == 3 && random.chance(0.3)) c.mesh = datasets::with_seam(c.mesh, 0, 0);
  if (random.chance(0.3))  // equal values: cells without gradient
    for (double& s : c.mesh.scalars) s = std::round(s * 4) / 4;
  if (random.chance(0.3)) c.mesh = datasets::transformed(c.mesh, random.power(-3, 3), {0, 0, 0});
  const Box box = scene::bounds(c.mesh);
  const double size = diagonal(box);
  c.camera.focal_point = 0.5 * (box.low + box.high);
  c.camera.position = c.camera.focal_point + random.direction() * (random.chance(0.2) ? 0.2 : 1.5) * size;
  c.camera.view_up = random.direction();
  c.camera.projection = random.chance(0.5) ? ProjectionKind::perspective : ProjectionKind::orthographic;
  c.camera.parallel_scale = 0.5 * size;
  c.camera.view_angle = random.uniform(15, 100);
  const auto range = scene::scalar_range(c.mesh);
  c.function = frame::random_function(random, range);
  std::vector<Knot> knots(c.function.knots().begin(), c.function.knots().end());
  for (Knot& knot : knots) knot.extinction *= 3 / size;
  c.function = TransferFunction(knots);
  c.shading.emplace();
  if (random.chance(0.7)) c.shading->to_light = random.direction();
  c.shading->camera_light = random.chance(0.5);
  if (random.chance(0.3)) c.shading->shininess = random.uniform(0, 60);
  if (random.chance(0.2)) c.shading->diffuse = random.uniform(0, 2);
  if (random.chance(0.3)) c.surfaces.iso = {{std::lerp(range[0], range[1], random.uniform(0, 1)), {}, 0.4}};
  if (random.chance(0.2)) c.surfaces.boundary = {{{}, 0.3}};
  c.words = "kind " + std::to_string(kind);
  return c;
}

TEST(MeshShading, OfRandomMeshesMatchesTheReference) { frame::expect_random_cases_right(22, 100, random_case); }

TEST(MeshShading, OfSeveralRanksMatchesOne) {
  const scene::TetMesh mesh = datasets::cube(7);
  const TransferFunction function({{0, {0, 0, 0.3}, 0}, {0.5, {0.2, 0.9, 0.3}, 0.2}, {1, {1, 0.4, 0.2}, 2}});
  for (const auto kind : {ProjectionKind::orthographic, ProjectionKind::perspective}) {
    const View view = view_from({2, 1, 4}, kind);
    Settings settings = shaded();
    settings.surfaces.iso = {{0.5, {}, 0.3}};
    settings.threads = 1;
    Session alone(Dataset::of(datasets::arrays_of(mesh)), settings);
    const RenderedFrame of_lanes = alone.render(view, function),
                        of_depth = alone.render(view, function, {.deep = true});
    EXPECT_TRUE(of_lanes.statistics.on_lattice);
    EXPECT_FALSE(of_depth.statistics.on_lattice);
    EXPECT_LT(frame::difference(of_lanes.image, of_depth.image), 2e-5);
    settings.mesh.shading.reset();
    EXPECT_GT(frame::difference(Session(alone.dataset(), settings).render(view, function).image, of_lanes.image), 0.05);
    settings.mesh.shading.emplace();
    for (const auto exchange : {Exchange::segments, Exchange::runs})
      for (const bool deep : {false, true}) {
        if (deep && exchange == Exchange::runs) continue;
        const RenderedFrame& expected = deep ? of_depth : of_lanes;
        run_ranks(3, [&](const Communicator& communicator) {
          Settings mine = settings;
          mine.ranks.exchange = exchange;
          Session session(tests::part_of(mesh, communicator), mine, communicator);
          const RenderedFrame frame = session.render(view, function, {.deep = deep});
          if (!session.assembles()) return;
          if (exchange == Exchange::runs) {
            EXPECT_LT(frame::difference(frame.image, expected.image), 2e-6);
            return;
          }
          EXPECT_EQ(frame.image.rgba, expected.image.rgba);
          EXPECT_EQ(frame.image.depth, expected.image.depth);
          if (!deep) return;
          EXPECT_EQ(frame.deep.begin, expected.deep.begin);
          EXPECT_EQ(std::memcmp(frame.deep.samples.data(), expected.deep.samples.data(),
                                expected.deep.samples.size() * sizeof(DeepImageSample)),
                    0);
        });
      }
  }
}

/// A deep image cut at any depth equals the image that ends there.
TEST(MeshShading, OfDeepPicturesMayBeCut) {
  const Dataset data = Dataset::of(datasets::arrays_of(datasets::cube(6)));
  const TransferFunction function({{0, {0, 0, 0.3}, 0}, {0.5, {0.2, 0.9, 0.3}, 3}, {1, {1, 0.4, 0.2}, 1}});
  Session session(data, shaded());
  const View view = view_from({2, 1, 4}, ProjectionKind::perspective);
  const RenderedFrame whole = session.render(view, function, {.deep = true, .deep_accuracy = 1e-3});
  for (const double z : {3.8, 4.3, 4.9, 9.0}) {
    View cut = view;
    cut.camera.clipping_range = {0, z};
    const Image image = session.render(cut, function).image;
    for (std::size_t p = 0; p < image.depth.size(); ++p) {
      const auto seen = tests::composited(whole.deep.pixel(p), z, {0, 0, 0});
      // Only colours are compared: with the black plane, alpha is 1.
      for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(seen[c], image.rgba[4 * p + c], 1e-3) << z << ' ' << p;
    }
  }
}

TEST(MeshShading, IsProbedToo) {
  const Dataset data = Dataset::of(datasets::arrays_of(datasets::cube(6)));
  const View view = view_from({2, 1, 4}, ProjectionKind::perspective);
  const Image image = Session(data, shaded()).render(view, fog).image;
  const ReferencePixel pixel = probe(data, view, fog, {16, 12}, 2, shaded()).pixel;
  EXPECT_NEAR(pixel.r, image.rgba[4 * image.index(16, 12)], 2e-5);
}

TEST(MeshShading, IsRefusedWhereItCannotBe) {
  const Dataset data = Dataset::of(datasets::arrays_of(datasets::cube(2)));
  const auto refused = [&](const Settings& settings, const char* words) {
    try {
      const Session session(data, settings);
      ADD_FAILURE() << "not refused: " << words;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_input);
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  };
  Settings settings = shaded();
  settings.emission = Emission::independent;
  refused(settings, "`shade`: shading does not support `emission` independent");
  settings = shaded();
  settings.mesh.rasterizer = Rasterizer::scanline;
  refused(settings, "`shade`: `rasterizer` scanline");
  settings = shaded();
  settings.mesh.shading->to_light = glm::dvec3(0);
  refused(settings, "`light`: the direction to the light has no length");
  settings = shaded();
  settings.mesh.shading->specular = -1;
  refused(settings, "`shade`: the components of the lighting");
}

}  // namespace
}  // namespace tessera::shading_test
