// SPDX-License-Identifier: BSD-3-Clause
// Surfaces of triangles, including a mesh's boundary, compared with positions and colours known in closed form and with
// the reference.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>

#include "api/random_cases.hpp"
#include "cells/mesh_selection.hpp"
#include "datasets/boxes.hpp"
#include "datasets/modify.hpp"
#include "datasets/shapes.hpp"
#include "datasets/transfer_functions.hpp"
#include "frame/mesh/boundary_faces.hpp"
#include "frame/mesh/render.hpp"
#include "frame/random_clips.hpp"
#include "frame/shared_meshes.hpp"
#include "frame/surface_scenes.hpp"
#include "projection/lattice/lattice_rasterizer.hpp"
#include "reference/judge.hpp"
#include "scene/error.hpp"
#include "support/deep_pixels.hpp"
#include "support/read_files.hpp"

namespace tessera::frame::face_surfaces_test {
namespace {

using scene::ProjectionKind;
using scene::TransferFunction;

constexpr double promised_error = 2e-5;  // docs/ACCURACY.md: of exact
constexpr SurfaceLight even_light{1, 0, 0, 1};

std::shared_ptr<const TriangleMesh> triangles(std::vector<glm::dvec3> points) {
  auto mesh = std::make_shared<TriangleMesh>();
  for (std::uint32_t i = 0; i + 2 < points.size(); i += 3) mesh->triangles.push_back({i, i + 1, i + 2});
  mesh->points = std::move(points);
  return mesh;
}

/// A square perpendicular to the z axis.
std::shared_ptr<const TriangleMesh> square(double half, double z) {
  return triangles(
      {{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, -half, z}, {half, half, z}, {-half, half, z}});
}

TEST(BoundaryFaces, OfACubeAreItsSidesTurnedOutwardOnceEach) {
  const scene::TetMesh mesh = datasets::regular_split(3, 4, 5, {1, 1, 1}, {0, 0, 0});
  const BoundaryFaces boundary = boundary_faces(mesh);
  EXPECT_EQ(boundary.mesh.triangles.size(), 2u * 2 * (3 * 4 + 4 * 5 + 5 * 3));
  double volume = 0;  // a third of the flux of the position through the surface
  for (const auto& t : boundary.mesh.triangles) {
    const glm::dvec3 &a = boundary.mesh.points[t[0]], &b = boundary.mesh.points[t[1]], &c = boundary.mesh.points[t[2]];
    volume += glm::dot(a, glm::cross(b, c)) / 6;
  }
  EXPECT_NEAR(volume, 60, 1e-9);
}

TEST(BoundarySurface, IsTheSidesOfACubeInTheFieldsColour) {
  scene::TetMesh mesh = datasets::cube(4);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) mesh.scalars[i] = mesh.positions[i].z / 2 + 0.5;
  const TransferFunction ramp({{0, {0, 0, 0}, 0}, {1, {1, 0.5, 0.25}, 0}});
  Surfaces surfaces;
  surfaces.boundary = {{{}, 0.4}};
  const auto image =
      Renderer(mesh, exact(surfaces)).render(view(ProjectionKind::orthographic, {0, 0, 4}), {16, 16}, ramp);
  // Seen face on, ambient and diffuse parts sum to 1 and the highlight is 0.2. The far side has only the highlight.
  const std::size_t middle = image.index(8, 8);
  EXPECT_NEAR(image.rgba[4 * middle], 0.4 * 1.2 + 0.6 * 0.4 * 0.2, 1e-6);
  EXPECT_NEAR(image.rgba[4 * middle + 1], 0.4 * 0.7 + 0.6 * 0.4 * 0.2, 1e-6);
  EXPECT_NEAR(image.rgba[4 * middle + 3], 1 - 0.6 * 0.6, 1e-6);
  EXPECT_NEAR(image.depth[middle], 3, 1e-6);
}

TEST(BoundarySurface, OfCellDataHasEachCellsColour) {
  scene::TetMesh mesh = datasets::cube(2);
  mesh.association = scene::Association::cell;
  mesh.scalars.assign(mesh.tets.size(), 0.25);
  const TransferFunction ramp({{0, {0, 0, 0}, 0}, {1, {1, 1, 1}, 0}});
  Surfaces surfaces;
  surfaces.boundary = {{}};
  surfaces.light = even_light;
  const auto image =
      Renderer(mesh, exact(surfaces)).render(view(ProjectionKind::orthographic, {0, 0, 4}), {8, 8}, ramp);
  EXPECT_NEAR(image.rgba[4 * image.index(4, 4)], 0.25, 1e-6);
}

TEST(TriangleSurface, IsBetweenTheDataInFrontAndBehind) {
  Surfaces surfaces;
  surfaces.light = even_light;
  const scene::TetMesh mesh = datasets::cube(3, 0.2);
  for (const double z : {0.0, 0.5, 1.5, -1.5}) {
    surfaces.triangles = {{square(1.4, z), glm::dvec3(1, 0, 0), 1}};
    const auto image =
        Renderer(mesh, exact(surfaces)).render(view(ProjectionKind::orthographic, {0, 0, 4}), {8, 8}, grey_fog());
    const std::size_t middle = 4 * image.index(4, 4);
    const double fog = -std::expm1(-0.7 * std::clamp(1 - z, 0.0, 2.0));
    EXPECT_NEAR(image.rgba[middle], 0.5 * fog + (1 - fog), 2e-6) << z;
    EXPECT_NEAR(image.rgba[middle + 1], 0.5 * fog, 2e-6);
    EXPECT_EQ(image.rgba[middle + 3], 1.0f);
    // Outside the mesh, where there are no cells.
    const std::size_t beside = 4 * image.index(0, 4);
    EXPECT_EQ(image.rgba[beside], 1.0f);
  }
}

TEST(TriangleSurface, HasNeitherGapsNorDuplicateHitsAtItsEdges) {
  Surfaces surfaces;
  surfaces.light = even_light;
  // Pixel centres are on the diagonal, and rows and columns of them on the sides of inner squares.
  std::vector<glm::dvec3> points;
  for (int i = -6; i < 6; ++i)
    for (int k = -6; k < 6; ++k) {
      const glm::dvec3 a(i / 8., k / 8., 0.1 * ((i + k) & 1)), b(a.x + 0.125, a.y, 0.1 * ((i + k + 1) & 1));
      const glm::dvec3 c(a.x + 0.125, a.y + 0.125, a.z), d(a.x, a.y + 0.125, b.z);
      for (const glm::dvec3& p : {a, b, c, a, c, d}) points.push_back(p);
    }
  surfaces.triangles = {{triangles(points), glm::dvec3(1), 0.5}};
  const scene::TetMesh mesh = datasets::cube(2);
  scene::Camera camera = view(ProjectionKind::orthographic, {1 / 16., 1 / 16., 4});
  camera.focal_point = {1 / 16., 1 / 16., 0};
  camera.parallel_scale = 1;
  for (const int n : {16, 32}) {  // pixels with a side of 1/8 or 1/16
    const auto image = Renderer(mesh, exact(surfaces)).render(camera, {n, n}, clear());
    int covered = 0;
    for (std::size_t p = 0; p < image.depth.size(); ++p) {
      const float alpha = image.rgba[4 * p + 3];
      EXPECT_TRUE(alpha == 0.0f || std::abs(alpha - 0.5f) < 1e-6f) << alpha;
      covered += alpha > 0 ? 1 : 0;
    }
    EXPECT_EQ(covered, (12 * n / 16) * (12 * n / 16));
  }
}

TEST(BoundarySurface, OfCellsThatOverlapIsInTheOrderOfDepth) {
  // Two boxes of one colour each, from z = -1.9 to 0.1 and -0.1 to 1.9.
  std::vector<scene::TetMesh> boxes(2, datasets::cube(1));
  for (std::size_t box = 0; box < 2; ++box) {
    for (glm::dvec3& p : boxes[box].positions) p.z += box == 0 ? -0.9 : 0.9;
    boxes[box].association = scene::Association::cell;
    boxes[box].scalars.assign(boxes[box].tets.size(), static_cast<double>(box));
  }
  const scene::TetMesh mesh = datasets::merged(boxes);
  const TransferFunction two({{0, {1, 0, 0}, 0}, {1, {0, 1, 0}, 0}});
  Surfaces surfaces;
  surfaces.light = even_light;
  surfaces.boundary = {{{}, 0.5}};
  const scene::Camera camera = view(ProjectionKind::orthographic, {0, 0, 4});
  const scene::ImageSize size{8, 8};
  const auto image = Renderer(mesh, exact(surfaces)).render(camera, size, two);
  const auto truth = reference::Reference(mesh, camera, size, two, Emission::absorption, surfaces).pixel(4.5, 4.5);
  // Green, red, green, red.
  const double red = 1. / 4 + 1. / 16, green = 1. / 2 + 1. / 8;
  EXPECT_NEAR(image.rgba[4 * image.index(4, 4)], red, 1e-6);
  EXPECT_NEAR(image.rgba[4 * image.index(4, 4) + 1], green, 1e-6);
  EXPECT_NEAR(truth.r, red, 1e-12);
  EXPECT_NEAR(truth.g, green, 1e-12);
}

TEST(BoundarySurface, ThatTouchesItselfIsTheLimitOfShiftedRays) {
  const TransferFunction fog = grey_fog();
  Surfaces surfaces;
  surfaces.boundary = {{glm::dvec3(1, 0, 0), 0.6}};
  scene::TetMesh all = datasets::cube(2, 0);
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    Random random(seed);
    std::vector<std::uint32_t> some;
    for (std::uint32_t t = 0; t < all.tets.size(); ++t)
      if (random.chance(0.4)) some.push_back(t);
    const scene::TetMesh mesh = scene::subset(all, some);
    // Pixel centres are on edges and corners of the lattice.
    scene::Camera camera = view(ProjectionKind::orthographic, {0, 0, 4});
    camera.parallel_scale = 17.0 / 16;
    const scene::ImageSize size{17, 17};
    const auto image = Renderer(mesh, exact(surfaces)).render(camera, size, fog);
    scene::TetMesh shifted = mesh;
    const double pixel = 2 * camera.parallel_scale / size.height;
    for (glm::dvec3& p : shifted.positions) p.x -= 1e-6 * pixel, p.y += 1e-9 * pixel;
    const auto limit = Renderer(shifted, exact(surfaces)).render(camera, size, fog);
    for (std::size_t i = 0; i < image.rgba.size(); ++i) ASSERT_NEAR(image.rgba[i], limit.rgba[i], 1e-5) << seed;
    const reference::Reference truth(mesh, camera, size, fog, Emission::absorption, surfaces);
    EXPECT_LE(reference::judge(image, truth, promised_error).max_error_not_excused, promised_error) << seed;
  }
}

TEST(TriangleSurface, ThatCoincidesWithTheBoundaryComesFirstHoweverNearTheEyeItIs) {
  Surfaces surfaces;
  surfaces.light = even_light;
  surfaces.boundary = {{glm::dvec3(0, 1, 0), 1}};
  surfaces.triangles = {{square(0.97, 1), glm::dvec3(1, 0, 0), 0.5}};
  // The eye is slightly above the side z = 1, so that the plane of the eye cuts the side in a line that is 1/20 pixel
  // away from the centres of a row.
  const scene::ImageSize size{40, 40};
  scene::Camera camera = view(ProjectionKind::orthographic, {0.013, -0.3, 1});
  camera.parallel_scale = 0.5;
  camera.view_up = {0, 0, 1};
  const scene::TetMesh mesh = datasets::cube(3, 0.2);
  for (const double slope : {0.3, 0.7, 1.9}) {
    const double pixel = 2 * camera.parallel_scale / size.height;
    camera.position.z = 1 + (0.5 + 0.05) * pixel / std::sqrt(1 + slope * slope);
    camera.focal_point = camera.position + glm::dvec3(0, 1, -slope);
    const auto image = Renderer(mesh, exact(surfaces)).render(camera, size, clear());
    const reference::Reference reference(mesh, camera, size, clear(), Emission::absorption, surfaces);
    for (int x = 4; x < 36; ++x) {
      const int y = 20;
      EXPECT_NEAR(image.depth[image.index(x, y)], 0.05 * pixel / slope, 1e-8);
      EXPECT_NEAR(image.rgba[4 * image.index(x, y)], 0.5, 1e-6) << x << ' ' << slope;
      EXPECT_NEAR(reference.pixel(x + 0.5, y + 0.5).r, 0.5, 1e-12) << x << ' ' << slope;
    }
  }
}

/// Triangles of some kind in and around a mesh.
std::vector<glm::dvec3> random_triangles(Random& random, const scene::TetMesh& mesh, const glm::dvec3& eye,
                                         std::string& words) {
  std::vector<glm::dvec3> points;
  const int n = 1 + random.below(12);
  const auto anywhere = [&] { return random.uniform(0.1, 1.4) * random.direction(); };
  switch (random.below(6)) {
    case 0:
      words += ", triangles anywhere";
      for (int i = 0; i < 3 * n; ++i) points.push_back(anywhere());
      break;
    case 1:
      words += ", faces of cells";
      for (int i = 0; i < n; ++i) {
        const scene::Tet& tet = mesh.tets[static_cast<std::size_t>(random.below(static_cast<int>(mesh.tets.size())))];
        const auto out = static_cast<std::size_t>(random.below(4));
        for (std::size_t k = 0; k < 4; ++k)
          if (k != out) points.push_back(mesh.positions[tet[k]]);
      }
      break;
    case 2:
      words += ", triangles of vertices";
      for (int i = 0; i < 3 * n; ++i) points.push_back(any_vertex(random, mesh));
      break;
    case 3:
      words += ", triangles seen edge-on";
      for (int i = 0; i < n; ++i) {
        const glm::dvec3 a = anywhere(), b = anywhere();
        for (const glm::dvec3& p : {a, b, eye + (a + b - 2.0 * eye) * random.uniform(0.2, 0.7)}) points.push_back(p);
      }
      break;
    case 4: {
      words += ", squares across an axis";
      const int axis = random.below(3);
      for (int i = 0; i < n; ++i) {
        const double at = random.below(9) / 4. - 1, half = random.of({0.5, 1.0, 1.3});
        for (const auto& [u, v] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, -1}, {1, 1}, {-1, 1}}) {
          glm::dvec3 p;
          p[axis] = at, p[(axis + 1) % 3] = u * half, p[(axis + 2) % 3] = v * half;
          points.push_back(p);
        }
      }
      break;
    }
    default:
      words += ", large triangles about the eye";
      for (int i = 0; i < 3 * n; ++i) points.push_back(eye + random.power(-1, 2) * random.direction());
      break;
  }
  return points;
}

RandomCase random_face_case(Random& random) {
  scene::TetMesh mesh;
  const int kind_of_mesh = random.below(5);
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
      mesh = datasets::annulus(12, true);
      break;
    default:
      mesh = datasets::cyclic_bars(6);
      break;
  }
  if (random.chance(0.2)) mesh = datasets::with_cell_data(std::move(mesh), 1);
  RandomCase c{std::move(mesh), {}, {}, "faces in mesh " + std::to_string(kind_of_mesh)};
  const auto kind = random.chance(0.5) ? ProjectionKind::orthographic : ProjectionKind::perspective;
  c.camera = view(kind, random.chance(0.3) ? glm::dvec3(1 / 20., 1 / 20., 4.5) : 4.5 * random.direction());
  if (random.chance(0.3)) c.camera.parallel_scale = 1;
  if (random.chance(0.2)) c.camera.position *= 0.1;  // inside
  const auto range = scene::scalar_range(c.mesh);
  c.function = random_function(random, range);
  const auto color = [&]() -> std::optional<glm::dvec3> {
    if (random.chance(0.5)) return std::nullopt;
    return glm::dvec3(random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1));
  };
  const auto opacity = [&] { return random.chance(0.2) ? 1 : random.uniform(0.05, 1); };
  if (random.chance(0.6)) c.surfaces.boundary.push_back({color(), opacity()});
  if (random.chance(0.1)) c.surfaces.boundary.push_back({color(), opacity()});
  if (random.chance(0.8) || c.surfaces.boundary.empty())
    for (int i = 1 + random.below(2); i > 0; --i)
      c.surfaces.triangles.push_back(
          {triangles(random_triangles(random, c.mesh, c.camera.position, c.words)), color(), opacity()});
  if (c.mesh.association == scene::Association::point && random.chance(0.4))
    for (int i = 1 + random.below(3); i > 0; --i)
      c.surfaces.iso.push_back({random.uniform(range[0], range[1]), color(), opacity()});
  return c;
}

TEST(FaceSurfaces, RandomSurfacesKeepThePromise) { expect_random_cases_right(23, 150, random_face_case); }

/// The error of `exact`, seen along the z axis from z = 4.
double error_of(const scene::TetMesh& mesh, const Surfaces& surfaces, const TransferFunction& function,
                scene::Emission emission = scene::Emission::absorption, FrameStatistics* statistics = nullptr) {
  constexpr scene::ImageSize size{24, 24};
  const scene::Camera camera = view(ProjectionKind::orthographic, {0.013, 0.017, 4});
  Settings settings = exact(surfaces);
  settings.emission = emission;
  const scene::Image image = Renderer(mesh, settings).render(camera, size, function, statistics);
  return reference::judge(image, reference::Reference(mesh, camera, size, function, emission, surfaces), promised_error)
      .max_error;
}
TransferFunction fog(double extinction) {
  return TransferFunction({{0, {1, 1, 1}, extinction}, {1, {1, 1, 1}, extinction}});
}

TEST(TriangleSurface, IsInOrderAmongManyWhereThereAreNoCells) {
  Surfaces surfaces;
  std::vector<glm::dvec3> points;
  for (int i = 0; i < 70; ++i) {
    const auto sheet = square(0.9, 3 - 0.08 * i);
    points.insert(points.end(), sheet->points.begin(), sheet->points.end());
  }
  surfaces.triangles = {{triangles(points), glm::dvec3(1, 0.5, 0), 0.02}};
  EXPECT_LT(error_of(datasets::cube(2), surfaces, clear()), promised_error);  // no cell is visible
  scene::TetMesh aside = datasets::cube(2);
  for (glm::dvec3& p : aside.positions) p = 0.1 * p + glm::dvec3(1.2, 0, 0);
  EXPECT_LT(error_of(aside, surfaces, grey_fog()), promised_error);
}

TEST(TriangleSurface, MayHaveValuesBeyondThoseOfTheMesh) {
  auto wall = std::make_shared<TriangleMesh>(*square(0.9, 1.5));
  wall->values = {-3, -1, 4, 0, 2.7, 1};
  Surfaces surfaces;
  surfaces.triangles = {{wall, {}, 1}};
  EXPECT_LT(error_of(datasets::cube(2), surfaces,
                     TransferFunction({{-10, {1, 0, 0}, 1}, {0, {0, 1, 0}, 1}, {2.5, {0.5, 0.5, 1}, 1}, {9, {}, 1}})),
            promised_error);
}

TEST(TriangleSurface, FarLargerThanTheMeshDoesNotMakeItsDepthsCoarse) {
  // The lattice extends over the ground, so its step grows with the ground and becomes coarse for the cube.
  for (const double size : {1e2, 1e4, 1e6})
    for (const scene::Emission emission : {scene::Emission::absorption, scene::Emission::independent}) {
      Surfaces surfaces;
      surfaces.boundary = {{glm::dvec3(0, 0, 1), 0.5}};
      surfaces.triangles = {
          {triangles({{-size, -1.4, -size}, {size, -1.4, -size}, {0, -1.4, size}}), glm::dvec3(0, 1, 0)}};
      EXPECT_LT(error_of(datasets::cube(8), surfaces, fog(1e-4), emission), promised_error) << size;
    }
}

TEST(TriangleSurface, DoesNotMultiplyThinCellsBehindIt) {
  // There are forty cells, each as thick as a step of the lattice. The lattice extends to the second square.
  const scene::TetMesh mesh = datasets::regular_split(2, 2, 40, {1, 1, 2e-9}, {-1, -1, 0});
  Surfaces surfaces;
  surfaces.triangles = {{square(0.9, 8e-8), glm::dvec3(0, 0, 1), 0.5}, {square(0.5, -2), glm::dvec3(1, 0, 0), 0.5}};
  FrameStatistics statistics;
  EXPECT_LT(error_of(mesh, surfaces, fog(60), scene::Emission::absorption, &statistics), promised_error);
  EXPECT_EQ(statistics.on_lattice, projection::lattice_available());
}

TEST(TriangleSurface, OfBrightColourKeepsThePromise) {
  Surfaces surfaces;
  surfaces.triangles = {{square(0.9, 0.25), glm::dvec3(20, 20, 20), 1}};
  const TransferFunction dark({{0, {0, 0, 0}, 0}, {0.5, {0, 0, 0}, 0}, {0.5, {0, 0, 0}, 100}, {1, {0, 0, 0}, 100}});
  EXPECT_LT(error_of(datasets::cube(4), surfaces, dark), promised_error);
}

TEST(TriangleSurface, NearAnIsoSurfaceIsInTheOrderOfDepth) {
  scene::TetMesh mesh = datasets::cube(4);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) mesh.scalars[i] = mesh.positions[i].z / 2 + 0.5;
  for (const double z : {0.2 + 4e-9, 0.2 - 4e-9}) {
    Surfaces surfaces;
    surfaces.iso = {{0.6, glm::dvec3(0, 0, 1)}};
    surfaces.triangles = {{square(0.9, z), glm::dvec3(1, 0, 0)}};
    EXPECT_LT(error_of(mesh, surfaces, fog(1)), promised_error) << z - 0.2;
  }
}

TEST(FaceSurfaces, AreOnTheLatticeWithoutIsoSurfaces) {
  Surfaces surfaces;
  surfaces.boundary = {{{}, 0.5}};
  FrameStatistics statistics;
  EXPECT_LT(error_of(datasets::cube(4), surfaces, grey_fog(), scene::Emission::absorption, &statistics),
            promised_error);
  EXPECT_EQ(statistics.on_lattice, projection::lattice_available());
  surfaces.iso = {{0.5, {}, 0.5}};
  EXPECT_LT(error_of(datasets::cube(4), surfaces, grey_fog(), scene::Emission::absorption, &statistics),
            promised_error);
  EXPECT_FALSE(statistics.on_lattice);
}

TEST(BoundarySurface, OfAClippedMeshHasTheCutFaces) {
  const int first = wanted("TESSERA_RANDOM_FIRST", 0), last = first + wanted("TESSERA_RANDOM_CASES", 40);
  constexpr scene::ImageSize size{40, 40};
  std::size_t excused = 0, pixels = 0;
  for (int number = first; number < last; ++number) {
    Random random(7000003u + static_cast<std::uint64_t>(number));
    std::string words;
    const scene::TetMesh mesh = datasets::cube(2 + random.below(4), random.uniform(0, 0.2), random.bits());
    const auto clip = random_clip(random, mesh, words);
    scene::TetMesh cut = mesh;
    MeshCounts counts;
    cells::select(cut, {clip}, counts, "mesh");
    if (cut.tets.empty()) continue;
    const auto [camera, extent] = random_view(random, cut);
    const TransferFunction function =
        datasets::smooth_knots(20, scene::scalar_range(mesh), random.power(-1, 1) / extent, 3);
    Surfaces surfaces;
    surfaces.boundary = {{{}, random.uniform(0.2, 1)}};
    const auto image = Renderer(cut, exact(surfaces)).render(camera, size, function);
    const reference::Reference reference(mesh, camera, size, function, Emission::absorption, surfaces, clip);
    const auto judged = reference::judge(image, reference, promised_error);
    EXPECT_LE(judged.max_error_not_excused, promised_error)
        << "case " << number << ", " << words << ", at (" << judged.worst_x << ", " << judged.worst_y << ") of "
        << judged.over_bound;
    excused += judged.excused, pixels += judged.pixels_checked;
  }
  EXPECT_LE(static_cast<double>(excused), 1e-4 * static_cast<double>(pixels) + 3);
}

TEST(FaceSurfaces, ArePointsAmongDeepSamples) {
  const scene::ImageSize size{24, 24};
  const scene::TetMesh mesh = datasets::cube(5, 0.2);
  Surfaces surfaces;
  surfaces.boundary = {{{}, 0.3}};
  surfaces.triangles = {{square(1.2, 0.1), {}, 0.5}};
  const scene::Camera camera = view(ProjectionKind::perspective, {2.9, 2.1, 4.3});
  scene::DeepImage deep;
  const auto image = Renderer(mesh, exact(surfaces)).render(camera, size, grey_fog(), nullptr, &deep);
  std::size_t points = 0;
  for (std::size_t p = 0; p < image.depth.size(); ++p) {
    const auto flat = tests::composited(deep.pixel(p));
    for (std::size_t c = 0; c < 4; ++c) EXPECT_NEAR(flat[c], image.rgba[4 * p + c], 1e-6);
    for (const auto& s : deep.pixel(p)) points += s.z == s.z_back ? 1u : 0u;
  }
  EXPECT_GT(points, 300u);
  // A plane inserted in front of a surface hides the surface: the samples are those of a frame whose far clipping plane
  // is at the same depth.
  const double plane = 5.3;
  scene::Camera clipped = camera;
  clipped.clipping_range = scene::ClippingRange{0.1, plane};
  const auto before = Renderer(mesh, exact(surfaces)).render(clipped, size, grey_fog());
  for (std::size_t p = 0; p < image.depth.size(); ++p) {
    const auto cut = tests::composited(deep.pixel(p), plane);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(cut[c], before.rgba[4 * p + c], 1e-3);  // deep_accuracy
  }
}

class RealMeshFaces : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(SharedData, RealMeshFaces, shared_meshes());

TEST_P(RealMeshFaces, KeepThePromise) {
  if (const std::string missing = missing_mesh(GetParam()); !missing.empty()) GTEST_SKIP() << missing;
  const scene::TetMesh mesh = io::read_mesh(shared_mesh(GetParam()), {}).mesh;
  const auto range = scene::scalar_range(mesh);
  const scene::Box box = scene::bounds(mesh);
  const glm::dvec3 middle = (box.low + box.high) / 2.0, half = (box.high - box.low) * 0.6;
  Surfaces surfaces;
  surfaces.boundary = {{{}, 0.3}};
  surfaces.triangles = {{triangles({middle - half, middle + glm::dvec3(half.x, -half.y, half.z), middle + half}),
                         glm::dvec3(1, 0.5, 0), 0.5}};
  const scene::ImageSize size{120, 90};
  const double extinction = 1 / glm::length(box.high - box.low);  // about one optical depth through the middle
  const TransferFunction function({{range[0], {0.1, 0.2, 0.9}, 0}, {range[1], {0.9, 0.5, 0.1}, 4 * extinction}});
  const auto pixels = reference::random_pixels(size, 300, 5);
  for (const auto kind : {ProjectionKind::orthographic, ProjectionKind::perspective}) {
    scene::Camera camera = scene::frame_box(box, size);
    camera.projection = kind;
    camera.view_angle = 40;
    const auto image = Renderer(mesh, exact(surfaces)).render(camera, size, function);
    const reference::Reference reference(mesh, camera, size, function, Emission::absorption, surfaces);
    const auto judgement = reference::judge(image, reference, promised_error, pixels);
    EXPECT_LE(judgement.max_error_not_excused, promised_error)
        << judgement.over_bound << " over, " << judgement.excused << " excused, at (" << judgement.worst_x << ", "
        << judgement.worst_y << ')';
    EXPECT_LE(judgement.excused, 1u);
  }
}

}  // namespace
}  // namespace tessera::frame::face_surfaces_test
