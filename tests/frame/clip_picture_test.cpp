// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cstdio>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "api/random_cases.hpp"
#include "cells/mesh_selection.hpp"
#include "datasets/boxes.hpp"
#include "datasets/modify.hpp"
#include "datasets/transfer_functions.hpp"
#include "frame/mesh/render.hpp"
#include "frame/random_clips.hpp"
#include "frame/shared_meshes.hpp"
#include "reference/grid/grid_reference.hpp"
#include "reference/judge.hpp"
#include "reference/reference.hpp"
#include "scene/error.hpp"
#include "support/read_files.hpp"
#include "tessera/reference.hpp"
#include "tessera/session.hpp"
#include "volume/render.hpp"

/// Images of meshes whose cells are cut, compared with the reference's images of the uncut mesh, in which rays are
/// limited to the parts that are kept.
namespace tessera::frame::clip_picture_test {
namespace {

constexpr double promised_error = 2e-5;  // of the exact integrator (include/tessera/session.hpp)
constexpr scene::ImageSize size{40, 40};

scene::Camera random_camera(Random& random, const glm::dvec3& centre, double extent) {
  scene::Camera camera;
  const double distance = 4 * extent;
  camera.focal_point = centre;
  camera.position = centre + distance * random.direction();
  camera.view_up = random.direction();
  camera.projection = random.chance(0.5) ? scene::ProjectionKind::perspective : scene::ProjectionKind::orthographic;
  camera.parallel_scale = extent * random.uniform(0.4, 0.8);
  camera.view_angle = random.uniform(12, 26);
  return camera;
}

TEST(ClipPicture, MatchesShortenedRays) {
  const int first = wanted("TESSERA_RANDOM_FIRST", 0), last = first + wanted("TESSERA_RANDOM_CASES", 60);
  double worst = 0;
  std::size_t excused = 0, pixels = 0, empty = 0;
  for (int number = first; number < last; ++number) {
    Random random(2000003u + static_cast<std::uint64_t>(number));
    scene::TetMesh mesh = datasets::cube(2 + random.below(4), random.uniform(0, 0.2), random.bits());
    if (random.chance(0.3)) mesh = datasets::with_cell_data(std::move(mesh), random.chance(0.5) ? 1 : 6);
    std::string words;
    const std::vector<HalfSpace> clip = random_clip(random, mesh, words);
    scene::TetMesh cut = mesh;
    MeshCounts counts;
    cells::select(cut, {clip}, counts, "mesh");
    if (cut.tets.empty()) {
      ++empty;
      continue;
    }
    const scene::Box box = scene::bounds(cut);
    const glm::dvec3 centre = (box.low + box.high) / 2.0;
    const double extent = glm::length(box.high - box.low);
    const scene::Camera camera = random_camera(random, centre, extent);
    const scene::TransferFunction function =
        random.chance(0.5) ? datasets::smooth_knots(20, scene::scalar_range(mesh), random.power(-0.5, 2) / extent, 3)
                           : datasets::step_knots(10, scene::scalar_range(mesh), random.power(-0.5, 2) / extent, 3);
    Settings settings;
    settings.integrator.kind = scene::IntegratorKind::exact;
    settings.use.lattice = number % 4 != 3;
    const scene::Image image = Renderer(cut, settings).render(camera, size, function);
    const reference::Reference reference(mesh, camera, size, function, Emission::absorption, {}, clip);
    const reference::Judgement judged = reference::judge(image, reference, promised_error);
    EXPECT_LE(judged.max_error_not_excused, promised_error)
        << "case " << number << ", " << words << ", at (" << judged.worst_x << ", " << judged.worst_y << ')';
    worst = std::max(worst, judged.max_error_not_excused), excused += judged.excused, pixels += judged.pixels_checked;
  }
  EXPECT_LE(static_cast<double>(excused), 1e-4 * static_cast<double>(pixels) + 3);
  EXPECT_LT(2 * empty, static_cast<std::size_t>(last - first));
  std::printf("cases %d to %d, %zu empty: largest error %.3g, %zu of %zu pixels excused\n", first, last - 1, empty,
              worst, excused, pixels);
}

/// Rays in the sides of a box and in faces of cells: a fixed rule, not rounding, decides which of them are inside.
TEST(ClipPicture, HoldsAlongTheAxes) {
  const scene::TetMesh mesh = datasets::regular_split(4, 4, 4, glm::dvec3(0.25), glm::dvec3(-0.5));
  scene::TetMesh cut = mesh;
  const auto sides = half_spaces_of({{-0.25, -0.375, -0.1}, {0.25, 0.125, 0.3}});
  const std::vector<HalfSpace> clip(sides.begin(), sides.end());
  MeshCounts counts;
  cells::select(cut, {clip}, counts, "mesh");
  const scene::TransferFunction function = datasets::smooth_knots(12, scene::scalar_range(mesh), 3, 5);
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {-1.0, 1.0}) {
      scene::Camera camera;
      camera.position = glm::dvec3(0), camera.focal_point = glm::dvec3(0), camera.view_up = glm::dvec3(0);
      camera.position[axis] = 3 * sign;
      camera.view_up[(axis + 1) % 3] = 1;
      camera.projection = scene::ProjectionKind::orthographic;
      camera.parallel_scale = 17.0 / 32;  // 16 pixels are 0.5: planes contain their centres
      const scene::ImageSize odd{35, 34};
      Settings settings;
      settings.integrator.kind = scene::IntegratorKind::exact;
      const scene::Image image = Renderer(cut, settings).render(camera, odd, function);
      const reference::Reference reference(mesh, camera, odd, function, Emission::absorption, {}, clip);
      const reference::Judgement judged = reference::judge(image, reference, promised_error);
      EXPECT_LE(judged.max_error, promised_error)
          << "axis " << axis << ", at (" << judged.worst_x << ", " << judged.worst_y << ')';
    }
}

class ClippedData : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(SharedData, ClippedData, shared_meshes());

TEST_P(ClippedData, IsWithinThePromise) {
  if (const std::string missing = missing_mesh(GetParam()); !missing.empty()) GTEST_SKIP() << missing;
  const scene::TetMesh mesh = io::read_mesh(shared_mesh(GetParam())).mesh;
  const scene::Box box = scene::bounds(mesh);
  const double diagonal = glm::length(box.high - box.low);
  const glm::dvec3 middle = (box.low + box.high) / 2.0 + 0.05 * (box.high - box.low);
  std::vector<HalfSpace> clip{{middle, {1, 0.4, -0.3}}};
  for (const HalfSpace& side : half_spaces_of({box.low + 0.1 * (box.high - box.low), box.high})) clip.push_back(side);
  scene::TetMesh cut = mesh;
  MeshCounts counts;
  cells::select(cut, {clip}, counts, "mesh");
  ASSERT_FALSE(cut.tets.empty());
  EXPECT_GT(counts.cells_cut, 0u);
  Settings settings;
  settings.integrator.kind = scene::IntegratorKind::exact;
  Renderer renderer(cut, settings);
  const scene::ImageSize wide{120, 90};
  const scene::Camera camera = scene::frame_box(scene::bounds(cut), wide);
  const auto pixels = reference::random_pixels(wide, 400, 5);
  for (const double extinction : {3.0, 3000.0}) {
    const scene::TransferFunction function =
        extinction < 100 ? datasets::smooth_knots(40, scene::scalar_range(mesh), extinction / diagonal, 3)
                         : datasets::step_knots(20, scene::scalar_range(mesh), extinction / diagonal, 3);
    const scene::Image image = renderer.render(camera, wide, function);
    const auto judged =
        reference::judge(image, reference::Reference(mesh, camera, wide, function, Emission::absorption, {}, clip),
                         promised_error, pixels);
    EXPECT_TRUE(judged.passed) << "extinction " << extinction << ": max " << judged.max_error << " at "
                               << judged.worst_x << ',' << judged.worst_y;
    std::printf("%s, extinction %g: largest error %.3g, %zu excused\n", GetParam(), extinction,
                judged.max_error_not_excused, judged.excused);
  }
}

/// A grid of random values, spacings and axes, in memory.
scene::Grid random_grid(Random& random, std::vector<float>& samples) {
  scene::Grid grid;
  scene::GridGeometry& g = grid.geometry;
  g.points = {3 + random.below(7), 3 + random.below(7), 3 + random.below(7)};
  g.origin = random.uniform(0, 3) * random.direction();
  for (int axis = 0; axis < 3; ++axis) g.spacing[axis] = random.uniform(0.2, 0.6);
  if (random.chance(0.3)) {  // rotated
    const glm::dvec3 x = random.direction(), y = glm::normalize(glm::cross(x, random.direction()));
    g.direction = {x, y, glm::cross(x, y)};
  }
  if (random.chance(0.3))
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double place = 0;
      g.coordinates[axis].clear();
      for (std::int64_t n = 0; n < g.points[axis]; ++n, place += random.uniform(0.1, 0.5))
        g.coordinates[axis].push_back(place);
    }
  if (random.chance(0.3)) g.association = scene::Association::cell;
  grid.type = scene::SampleType::float32;
  grid.field_name = std::string("f");
  const scene::GridIndex n = g.samples();
  for (std::int64_t sample = 0; sample < n[0] * n[1] * n[2]; ++sample)
    samples.push_back(static_cast<float>(random.uniform(0, 1)));
  return grid;
}

TEST(ClipPicture, OfVolumesMatchesShortenedRays) {
  const int first = wanted("TESSERA_RANDOM_FIRST", 0), last = first + wanted("TESSERA_RANDOM_CASES", 60);
  double worst = 0;
  std::size_t excused = 0, pixels = 0;
  for (int number = first; number < last; ++number) {
    Random random(3000017u + static_cast<std::uint64_t>(number));
    std::vector<float> samples;
    const scene::Grid grid = random_grid(random, samples);
    const scene::MemorySource source(grid, std::as_bytes(std::span<const float>(samples)), nullptr, "grid");
    const scene::GridGeometry& g = grid.geometry;
    const scene::Box box = scene::bounds(g);
    const glm::dvec3 extent = box.high - box.low;
    const auto inside = [&] {
      return box.low +
             extent * glm::dvec3(random.uniform(0.1, 0.9), random.uniform(0.1, 0.9), random.uniform(0.1, 0.9));
    };
    std::vector<HalfSpace> clip;
    const int kind = random.below(4);
    if (kind == 0) clip.push_back({inside(), random.power(-2, 2) * random.direction()});
    if (kind == 1)
      for (int plane = 0; plane < 2; ++plane) clip.push_back({inside(), random.direction()});
    if (kind == 2) {  // along a plane of the lattice
      const auto axis = static_cast<std::size_t>(random.below(3));
      glm::dvec3 local(0);
      local[static_cast<int>(axis)] = g.lattice(axis, 1);
      clip.push_back(
          {g.origin + g.direction * local, g.direction[static_cast<int>(axis)] * (random.chance(0.5) ? 1. : -1.)});
    }
    if (kind == 3) {
      const glm::dvec3 a = inside(), b = inside();
      for (const HalfSpace& side : half_spaces_of({glm::min(a, b), glm::max(a, b)})) clip.push_back(side);
    }
    scene::Camera camera = random_camera(random, (box.low + box.high) / 2.0, glm::length(extent));
    if (random.chance(0.3)) {  // along an axis, so that some rays are in the planes
      const int axis = random.below(3);
      camera.position = camera.focal_point;
      camera.position[axis] += 4 * glm::length(extent);
      camera.view_up = glm::dvec3(0);
      camera.view_up[(axis + 1) % 3] = 1;
    }
    const scene::TransferFunction function =
        random.chance(0.5) ? datasets::smooth_knots(20, {0, 1}, random.power(-0.5, 2) / glm::length(extent), 3)
                           : datasets::step_knots(10, {0, 1}, random.power(-0.5, 2) / glm::length(extent), 3);
    volume::RenderSettings settings;
    settings.integrator.kind = IntegratorKind::exact;
    settings.clip = clip;
    settings.threads = 1;
    if (random.chance(0.3)) settings.grid.shading.emplace();
    const scene::Image image = volume::Renderer(source, settings).render(camera, size, function).image;
    const reference::GridReference reference(source, camera, size, function, Emission::absorption,
                                             settings.grid.shading, clip);
    const reference::Judgement judged = reference::judge(image, reference, 1e-5);
    EXPECT_LE(judged.max_error_not_excused, 1e-5)
        << "case " << number << ", kind " << kind << ", at (" << judged.worst_x << ", " << judged.worst_y << ')'
        << (g.rectilinear() ? " rectilinear" : "") << (settings.grid.shading ? " shaded" : "");
    worst = std::max(worst, judged.max_error_not_excused), excused += judged.excused, pixels += judged.pixels_checked;
  }
  EXPECT_LE(static_cast<double>(excused), 1e-4 * static_cast<double>(pixels) + 3);
  std::printf("cases %d to %d: largest error %.3g, %zu of %zu pixels excused\n", first, last - 1, worst, excused,
              pixels);
}

/// Another caller's use: a part of a data set of arrays, verified against the whole.
TEST(SelectedDataset, IsVerifiedAgainstTheWhole) {
  const scene::TetMesh mesh = datasets::cube(4);
  MeshArrays arrays;
  arrays.points = mesh.positions;
  std::vector<std::uint32_t> tets;
  for (const scene::Tet& tet : mesh.tets) tets.insert(tets.end(), tet.begin(), tet.end());
  arrays.tets = tets;
  arrays.scalars = mesh.scalars;
  const Dataset whole = Dataset::of(arrays);
  const auto range = whole.range();
  Selection selection{{{{0.1, 0, 0}, {1, 0.2, 0.1}}}, {{range[0], (range[0] + 3 * range[1]) / 4}}};
  const Dataset part = whole.selected(selection);
  EXPECT_LT(part.tet_count(), whole.tet_count());
  EXPECT_GT(part.mesh_counts().cells_out_of_range, 0u);
  EXPECT_GT(part.mesh_counts().cells_cut, 0u);
  EXPECT_GT(part.bounds().low.x, -0.5);
  const View view = part.default_view({50, 50});
  const TransferFunction function = whole.transfer_function("viridis").function;
  Settings settings;
  settings.integrator.kind = IntegratorKind::exact;
  Session session(part, settings);
  const RenderedFrame frame = session.render(view, function);
  const Verification verified = session.verify(frame, view, function, 2500);
  EXPECT_TRUE(verified.met) << verified.max_error;
  // Verification against the unclipped mesh fails: the test is able to fail.
  Session other(whole, settings);
  EXPECT_FALSE(other.verify(frame, view, function, 2500).met);
  EXPECT_THROW(static_cast<void>(whole.selected({{{{9, 0, 0}, {1, 0, 0}}}})), scene::Error);
}

}  // namespace
}  // namespace tessera::frame::clip_picture_test
