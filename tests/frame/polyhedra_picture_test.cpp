// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <glm/vec3.hpp>

#include "api/random_cases.hpp"
#include "cells/mesh_assembly.hpp"
#include "frame/mesh/render.hpp"
#include "reference/judge.hpp"
#include "reference/small_meshes.hpp"
#include "support/polyhedral_meshes.hpp"

/// Images of polyhedra that fill a box with a linear field, compared with the reference's images of the same box and
/// field, divided into a few tets.
namespace tessera::frame::polyhedra_picture_test {
namespace {

constexpr double promised_error = 2e-5;  // of the exact integrator (include/tessera/session.hpp)
constexpr scene::ImageSize size{40, 40};

double field_at(const glm::dvec3& p) { return p.x + 2 * p.y + 3 * p.z; }

cells::CellBlock random_polyhedra(Random& random, unsigned seed, std::string& words) {
  switch (random.below(4)) {
    case 0:
      words = std::string("Voronoi cells");
      return io::testing::voronoi_mesh(20 + random.below(60), seed);
    case 1:
      words = std::string("polyominoes");
      return io::testing::polyominoes(3 + random.below(3), 1 + random.below(3), seed);
    case 2:
      words = std::string("joined cubes");
      return io::testing::agglomerates(4, 2 + random.below(5), 0, seed);
    default:
      words = std::string("joined warped cubes");
      return io::testing::agglomerates(4, 2 + random.below(5), 0.2, seed);
  }
}

scene::Camera random_camera(Random& random) {
  scene::Camera camera;
  camera.focal_point = {random.uniform(0.3, 0.7), random.uniform(0.3, 0.7), random.uniform(0.3, 0.7)};
  camera.position = camera.focal_point + 4.0 * random.direction();
  camera.view_up = random.direction();
  camera.projection = random.chance(0.5) ? scene::ProjectionKind::perspective : scene::ProjectionKind::orthographic;
  camera.parallel_scale = random.uniform(0.5, 0.9);
  camera.view_angle = random.uniform(12, 26);
  return camera;
}

scene::TransferFunction random_function(Random& random) {
  std::vector<scene::Knot> knots;
  for (double value = 0; value < 6; value += random.uniform(0.2, 2))
    knots.push_back({value,
                     {random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)},
                     random.chance(0.2) ? 0 : random.power(-1, 1)});
  return scene::TransferFunction(knots);
}

TEST(PolyhedraPicture, IsThatOfTheBoxTheyFill) {
  const int first = wanted("TESSERA_RANDOM_FIRST", 0), last = first + wanted("TESSERA_RANDOM_CASES", 20);
  const scene::TetMesh box = reference::box_of_tets(1, glm::dvec3(0), glm::dvec3(1), field_at);
  double worst = 0;
  std::size_t excused = 0, pixels = 0;
  MeshCounts counts;
  for (int number = first; number < last; ++number) {
    Random random(1000003u + static_cast<std::uint64_t>(number));
    std::string words;
    ReadOptions options;
    options.field = std::string("f");
    const cells::MeshFile file =
        cells::assemble_mesh({random_polyhedra(random, static_cast<unsigned>(number), words)}, options, "mesh");
    EXPECT_EQ(file.counts.cells_tangled + file.counts.cells_open, 0u) << words << ", case " << number;
    counts += file.counts;
    const scene::Camera camera = random_camera(random);
    const scene::TransferFunction function = random_function(random);
    Settings settings;
    settings.integrator.kind = scene::IntegratorKind::exact;
    settings.use.lattice = number % 4 != 3;
    const scene::Image image = Renderer(file.mesh, settings).render(camera, size, function);
    const reference::Judgement judgement =
        reference::judge(image, reference::Reference(box, camera, size, function), promised_error);
    EXPECT_LE(judgement.max_error_not_excused, promised_error)
        << words << ", case " << number << ": " << judgement.over_bound << " over at (" << judgement.worst_x << ", "
        << judgement.worst_y << ')';
    worst = std::max(worst, judgement.max_error_not_excused);
    excused += judgement.excused, pixels += judgement.pixels_checked;
  }
  EXPECT_LE(static_cast<double>(excused), 1e-4 * static_cast<double>(pixels) + 3);
  std::printf("cases %d to %d: %zu polyhedra, %zu from inside, %zu in pieces; largest error %.3g, %zu of %zu excused\n",
              first, last - 1, static_cast<std::size_t>(counts.cells_polyhedra),
              static_cast<std::size_t>(counts.polyhedra_from_inside),
              static_cast<std::size_t>(counts.polyhedra_in_pieces), worst, excused, pixels);
}

TEST(PolyhedraPicture, OfCellDataIsThatOfTheCubesTheyAreMadeOf) {
  constexpr int n = 4;
  std::size_t excused = 0, pixels = 0;
  for (int number = 0; number < 10; ++number) {
    Random random(77u + static_cast<std::uint64_t>(number));
    std::vector<std::size_t> cell_of_cube;
    ReadOptions options;
    options.field = std::string("c");
    const cells::MeshFile file = cells::assemble_mesh(
        {io::testing::agglomerates(n, 6, 0, static_cast<unsigned>(number), &cell_of_cube)}, options, "mesh");
    const scene::TetMesh cubes = reference::with_cell_data(
        reference::box_of_tets(n, glm::dvec3(0), glm::dvec3(1), field_at), [&](const glm::dvec3& centre) {
          const glm::ivec3 at(centre * static_cast<double>(n));
          return static_cast<double>(cell_of_cube[static_cast<std::size_t>(at.x + n * (at.y + n * at.z))]);
        });
    const scene::Camera camera = random_camera(random);
    std::vector<scene::Knot> knots;
    for (int k = 0; k < 30; ++k)
      knots.push_back({static_cast<double>(k),
                       {random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)},
                       random.power(-1, 1)});
    const scene::TransferFunction function{knots};
    Settings settings;
    settings.integrator.kind = scene::IntegratorKind::exact;
    const scene::Image image = Renderer(file.mesh, settings).render(camera, size, function);
    const reference::Judgement judgement =
        reference::judge(image, reference::Reference(cubes, camera, size, function), promised_error);
    EXPECT_LE(judgement.max_error_not_excused, promised_error) << "case " << number;
    excused += judgement.excused, pixels += judgement.pixels_checked;
  }
  EXPECT_LE(static_cast<double>(excused), 1e-4 * static_cast<double>(pixels) + 3);
}

}  // namespace
}  // namespace tessera::frame::polyhedra_picture_test
