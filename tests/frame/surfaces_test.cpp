// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "api/random_cases.hpp"
#include "datasets/boxes.hpp"
#include "datasets/modify.hpp"
#include "datasets/shapes.hpp"
#include "datasets/transfer_functions.hpp"
#include "frame/mesh/render.hpp"
#include "frame/plateaus.hpp"
#include "frame/shared_meshes.hpp"
#include "frame/surface_scenes.hpp"
#include "reference/judge.hpp"
#include "scene/error.hpp"
#include "support/deep_pixels.hpp"
#include "support/instruction_sets.hpp"
#include "support/read_files.hpp"

/// Surfaces in the volume, compared with positions and colours known in closed form and with the reference.
namespace tessera::frame::surfaces_test {
namespace {

using scene::ProjectionKind;
using scene::TransferFunction;

constexpr double promised_error = 2e-5;  // docs/ACCURACY.md: of exact

/// A cube in [-1, 1]^3 with the field z / 2 + 1 / 2, which is constant along all rows of vertices.
scene::TetMesh ramp(double jitter) {
  scene::TetMesh mesh = datasets::cube(8, jitter);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) mesh.scalars[i] = mesh.positions[i].z / 2 + 0.5;
  return mesh;
}

TEST(IsoSurface, OfARampIsAPlaneLitByItsAngleAtTheDepthWhereTheFieldHasItsValue) {
  const scene::ImageSize size{24, 24};
  Surfaces surfaces;
  surfaces.iso = {{0.625, glm::dvec3(0.5, 0.25, 0), 0.4}};
  for (const double jitter : {0.0, 0.2})  // without jitter, the plane coincides with faces
    for (const bool lattice : {true, false}) {
      const scene::TetMesh mesh = ramp(jitter);
      const scene::Camera camera = view(ProjectionKind::orthographic, {2, 0, 4});
      Renderer renderer(mesh, exact(surfaces, lattice));
      const scene::Image image = renderer.render(camera, size, clear());
      const std::size_t middle = image.index(12, 12);
      // Along the middle ray, n.d = 4 / sqrt(20); the depth follows from similar triangles.
      const double cosine = 4 / std::sqrt(20.0);
      const double matte = 0.2 + 0.8 * cosine, shine = 0.2 * std::pow(cosine, 32);
      EXPECT_NEAR(image.rgba[4 * middle], 0.4 * (0.5 * matte + shine), 1e-6);
      EXPECT_NEAR(image.rgba[4 * middle + 1], 0.4 * (0.25 * matte + shine), 1e-6);
      EXPECT_NEAR(image.rgba[4 * middle + 2], 0.4 * shine, 1e-6);
      EXPECT_NEAR(image.rgba[4 * middle + 3], 0.4, 1e-6);
      // The middle pixel's centre is half a pixel (1.5 / 24) to the right of and above the axis; up is not along z.
      const glm::dvec3 forward = glm::normalize(glm::dvec3(-2, 0, -4)), right = glm::cross(forward, {0, 1, 0});
      const glm::dvec3 start = glm::dvec3(2, 0, 4) + (right - glm::cross(right, forward)) * (1.5 / 24);
      EXPECT_NEAR(image.depth[middle], (0.25 - start.z) / forward.z, 1e-6);
    }
}

TEST(IsoSurface, IsBetweenTheDataInFrontAndBehind) {
  const scene::ImageSize size{8, 8};
  Surfaces surfaces;
  surfaces.iso = {{0.5, glm::dvec3(1, 0, 0), 1}};
  surfaces.light = {1, 0, 0, 1};
  const scene::TetMesh mesh = ramp(0.2);
  for (const double side : {1.0, -1.0}) {
    Renderer renderer(mesh, exact(surfaces, true));
    const auto image = renderer.render(view(ProjectionKind::orthographic, {0, 0, 4 * side}), size, grey_fog());
    const std::size_t middle = 4 * image.index(4, 4);
    const double fog = 1 - std::exp(-0.7);  // opacity of one unit of fog in front of the plane; half of it is grey
    EXPECT_NEAR(image.rgba[middle], 0.5 * fog + (1 - fog), 2e-6);
    EXPECT_NEAR(image.rgba[middle + 1], 0.5 * fog, 2e-6);
    EXPECT_EQ(image.rgba[middle + 3], 1.0f);
  }
}

TEST(IsoSurface, AtTheValueOfVerticesFacesAndWholeCellsIsHitOnce) {
  const scene::ImageSize size{33, 33};
  Surfaces surfaces;
  surfaces.iso = {{0.5, glm::dvec3(1), 0.5}};
  surfaces.light = {1, 0, 0, 1};
  scene::TetMesh plateau = datasets::regular_split(8, 8, 8, glm::dvec3(0.25), glm::dvec3(-1));
  scene::TetMesh level = plateau;
  for (std::size_t i = 0; i < plateau.positions.size(); ++i) {
    const double z = plateau.positions[i].z / 2 + 0.5;
    level.scalars[i] = z;  // the surface's value is on a layer of faces
    // The surface's value is in all cells between two layers.
    plateau.scalars[i] = z < 0.25 ? z * 2 : z <= 0.75 ? 0.5 : 2 * (z - 0.5);
  }
  for (const auto* mesh : {&level, &plateau})
    for (const bool lattice : {true, false})
      for (const double side : {1.0, -1.0}) {
        Renderer renderer(*mesh, exact(surfaces, lattice));
        const auto image = renderer.render(view(ProjectionKind::orthographic, {0, 0, 4 * side}), size, clear());
        for (int y = 6; y < 27; ++y)
          for (int x = 6; x < 27; ++x) EXPECT_NEAR(image.rgba[4 * image.index(x, y) + 3], 0.5, 1e-6) << x << ' ' << y;
      }
}

TEST(IsoSurface, OutsideTheFieldsRangeOrOnTheBoundaryIsEmpty) {
  Surfaces surfaces;
  surfaces.iso = {{-0.1, {}, 1}, {1.1, {}, 1}, {0, {}, 1}};
  const scene::TetMesh mesh = ramp(0);
  Renderer renderer(mesh, exact(surfaces, true));
  const auto image = renderer.render(view(ProjectionKind::orthographic, {2, 1, 4}), {16, 16}, clear());
  for (const float v : image.rgba) EXPECT_EQ(v, 0.0f);
}

Surfaces random_surfaces(Random& random, const scene::TetMesh& mesh) {
  const auto range = scene::scalar_range(mesh);
  Surfaces surfaces;
  const int n = 1 + random.below(random.chance(0.2) ? 30 : 5);
  for (int i = 0; i < n; ++i) {
    IsoSurface iso;
    // The value of a vertex, a double adjacent to it, or any value.
    const double of_vertex =
        mesh.scalars[static_cast<std::size_t>(random.below(static_cast<int>(mesh.scalars.size())))];
    iso.value = of_vertex;
    if (random.chance(0.1)) iso.value = std::nextafter(of_vertex, random.chance(0.5) ? 1e9 : -1e9);
    if (random.chance(0.5)) iso.value = random.uniform(range[0], range[1]);
    if (random.chance(0.7)) iso.color = glm::dvec3(random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1));
    if (random.chance(0.8)) iso.opacity = random.uniform(0.01, 1);
    surfaces.iso.push_back(iso);
  }
  return surfaces;
}

/// Boxes, balls and bars, some with vertices and edges on pixel centres, with fields of many values, or of few that are
/// then constant over faces and cells.
RandomCase random_surface_case(Random& random) {
  scene::TetMesh mesh;
  const int kind_of_mesh = random.below(6);
  switch (kind_of_mesh) {
    case 0:
      mesh = datasets::cube(1 + random.below(5), 0.2, random.bits());
      break;
    case 1:
      mesh = datasets::regular_split(4, 4, 4, glm::dvec3(0.5), glm::dvec3(-1));
      break;
    case 2:
      mesh = datasets::ball(1 + random.below(2));
      break;
    case 3:
      mesh = datasets::slivers(3, random.power(1, 6));
      break;
    case 4:
      mesh = datasets::annulus(12, true);
      break;
    default:
      mesh = datasets::cyclic_bars(6);
      break;
  }
  if (mesh.association == scene::Association::cell) mesh = datasets::cube(3, 0.2, random.bits());
  const int values = random.chance(0.4) ? 1 + random.below(5) : 0;
  const double scale = random.chance(0.2) ? random.power(-8, 8) : 1,
               offset = random.chance(0.2) ? random.uniform(-3, 3) : 0;
  for (double& s : mesh.scalars) {
    if (values > 0) s = std::round(s * values) / values;
    s = (s + offset) * scale;
  }
  RandomCase c{std::move(mesh),
               {},
               {},
               "surfaces in mesh " + std::to_string(kind_of_mesh) + ", values " + std::to_string(values) + ", scale " +
                   std::to_string(scale) + ", offset " + std::to_string(offset)};
  const auto kind = random.chance(0.5) ? ProjectionKind::orthographic : ProjectionKind::perspective;
  c.camera = view(kind, random.chance(0.3) ? glm::dvec3(1 / 20., 1 / 20., 4.5) : 4.5 * random.direction());
  if (random.chance(0.3)) c.camera.parallel_scale = 1;
  if (random.chance(0.15)) c.camera.position *= 0.1;
  const auto range = scene::scalar_range(c.mesh);
  c.function = random_function(random, range);
  c.surfaces = random_surfaces(random, c.mesh);
  return c;
}

TEST(IsoSurface, RandomSurfacesKeepThePromise) { expect_random_cases_right(7, 200, random_surface_case); }

TEST(IsoSurface, ManyInACellKeepThePromiseOnEveryInstructionSet) {
  const scene::TetMesh mesh = datasets::cube(3, 0.2);
  const auto range = scene::scalar_range(mesh);
  Surfaces surfaces;
  for (int i = 0; i < 40; ++i)
    surfaces.iso.push_back({range[0] + (range[1] - range[0]) * (i + 0.5) / 40, {}, 0.02 + 0.01 * (i % 5)});
  const scene::ImageSize size{36, 28};
  tests::for_each_instruction_set([&](const char* name) {
    for (const double shininess : {32.0, 7.5})
      for (const auto kind : {ProjectionKind::orthographic, ProjectionKind::perspective}) {
        surfaces.light.shininess = shininess;
        const auto camera = view(kind, {2.9, 2.1, 4.3});
        const auto image = Renderer(mesh, exact(surfaces, true)).render(camera, size, grey_fog());
        const reference::Reference reference(mesh, camera, size, grey_fog(), Emission::absorption, surfaces);
        const auto judgement = reference::judge(image, reference, promised_error);
        EXPECT_LE(judgement.max_error_not_excused, promised_error) << name << ", shininess " << shininess;
        EXPECT_EQ(judgement.excused, 0u) << name << ", shininess " << shininess;
      }
  });
}

TEST(IsoSurface, AtAPlateausLevelKeepsThePromise) {
  for (const auto kind : {LastPlace::of_float, LastPlace::of_double})
    for (const int places : {0, 1, 16, 256, 10000})
      for (const bool lattice : {true, false}) {
        const scene::TetMesh mesh = plateau(0.7, places, kind, false, 3);
        Surfaces surfaces;
        surfaces.iso = {{0.7, glm::dvec3(1, 0.5, 0), 0.5}, {beside(0.7, 1, kind), glm::dvec3(0, 0.5, 1), 0.3}};
        const auto camera = view(ProjectionKind::perspective, {2.9, 2.1, 4.3});
        const scene::ImageSize size{32, 24};
        const auto image = Renderer(mesh, exact(surfaces, lattice)).render(camera, size, grey_fog());
        const reference::Reference reference(mesh, camera, size, grey_fog(), Emission::absorption, surfaces);
        EXPECT_LE(reference::judge(image, reference, promised_error).max_error_not_excused, promised_error)
            << places << (kind == LastPlace::of_float ? " float" : " double") << (lattice ? " lattice" : "");
      }
}

TEST(IsoSurface, IsAPointAmongDeepSamples) {
  const scene::ImageSize size{24, 24};
  const scene::TetMesh mesh = datasets::cube(5, 0.2);
  Surfaces surfaces;
  surfaces.iso = {{0.4, glm::dvec3(1, 0.2, 0), 0.4}, {0.6, {}, 1}};
  const scene::Camera camera = view(ProjectionKind::perspective, {2.9, 2.1, 4.3});
  scene::DeepImage deep;
  const auto image = Renderer(mesh, exact(surfaces, true)).render(camera, size, grey_fog(), nullptr, &deep);
  std::size_t points = 0;
  for (std::size_t p = 0; p < image.depth.size(); ++p) {
    const auto flat = tests::composited(deep.pixel(p));
    for (std::size_t c = 0; c < 4; ++c) EXPECT_NEAR(flat[c], image.rgba[4 * p + c], 1e-6);
    for (const auto& s : deep.pixel(p)) points += s.z == s.z_back ? 1u : 0u;
  }
  EXPECT_GT(points, 100u);
  // A plane inserted in front of a surface hides the surface: the samples are those of a frame whose far clipping plane
  // is at the same depth.
  const double plane = 5.3;
  scene::Camera clipped = camera;
  clipped.clipping_range = scene::ClippingRange{0.1, plane};
  const auto before = Renderer(mesh, exact(surfaces, true)).render(clipped, size, grey_fog());
  for (std::size_t p = 0; p < image.depth.size(); ++p) {
    const auto cut = tests::composited(deep.pixel(p), plane);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(cut[c], before.rgba[4 * p + c], 1e-3);  // deep_accuracy
  }
}

class RealMeshSurfaces : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(SharedData, RealMeshSurfaces, shared_meshes());

TEST_P(RealMeshSurfaces, KeepThePromise) {
  if (const std::string missing = missing_mesh(GetParam()); !missing.empty()) GTEST_SKIP() << missing;
  ReadOptions read;
  read.smooth = true;
  const scene::TetMesh mesh = io::read_mesh(shared_mesh(GetParam()), read).mesh;
  if (mesh.association == scene::Association::cell) GTEST_SKIP() << "cell data";
  const auto range = scene::scalar_range(mesh);
  const auto value = [&](double part) { return range[0] + part * (range[1] - range[0]); };
  Surfaces surfaces;
  for (int i = 1; i < 10; ++i) surfaces.iso.push_back({value(0.1 * i), {}, 0.1 * i});
  surfaces.iso.push_back({mesh.scalars[mesh.scalars.size() / 2], glm::dvec3(1, 0, 0), 0.5});
  const scene::ImageSize size{120, 90};
  // About one optical depth through the middle.
  const double extinction = 1 / glm::length(scene::bounds(mesh).high - scene::bounds(mesh).low);
  const TransferFunction function({{range[0], {0.1, 0.2, 0.9}, 0}, {range[1], {0.9, 0.5, 0.1}, 4 * extinction}});
  const auto pixels = reference::random_pixels(size, 300, 5);
  for (const auto kind : {ProjectionKind::orthographic, ProjectionKind::perspective})
    for (const bool lattice : {true, false}) {
      scene::Camera camera = scene::frame_box(scene::bounds(mesh), size);
      camera.projection = kind;
      camera.view_angle = 40;
      const auto image = Renderer(mesh, exact(surfaces, lattice)).render(camera, size, function);
      const reference::Reference reference(mesh, camera, size, function, Emission::absorption, surfaces);
      const auto judgement = reference::judge(image, reference, promised_error, pixels);
      EXPECT_LE(judgement.max_error_not_excused, promised_error)
          << judgement.over_bound << " over, " << judgement.excused << " excused, at (" << judgement.worst_x << ", "
          << judgement.worst_y << ')' << (lattice ? " lattice" : "");
      EXPECT_LE(judgement.excused, 1u);
    }
}

}  // namespace
}  // namespace tessera::frame::surfaces_test
