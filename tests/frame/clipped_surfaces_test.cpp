// SPDX-License-Identifier: BSD-3-Clause
// Iso-surfaces in meshes whose cells are cut, compared with the reference's in the whole mesh along the kept parts of
// rays.
#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "api/random_cases.hpp"
#include "cells/mesh_selection.hpp"
#include "datasets/boxes.hpp"
#include "datasets/transfer_functions.hpp"
#include "frame/mesh/render.hpp"
#include "frame/random_clips.hpp"
#include "reference/judge.hpp"

namespace tessera::frame::clipped_surfaces_test {
namespace {

constexpr double promised_error = 2e-5;  // docs/ACCURACY.md: of exact
constexpr scene::ImageSize size{40, 40};

scene::TetMesh clipped(const scene::TetMesh& mesh, const std::vector<HalfSpace>& clip, const Surfaces& surfaces) {
  scene::TetMesh cut = mesh;
  MeshCounts counts;
  scene::Selection selection{clip};
  for (const IsoSurface& iso : surfaces.iso) selection.levels.push_back(iso.value);
  cells::select(cut, selection, counts, "mesh");
  return cut;
}

struct Clipping {
  scene::TetMesh mesh;
  std::vector<HalfSpace> clip;
  std::string words;
  Surfaces surfaces;
};

Clipping random_clipping(Random& random) {
  Clipping c;
  c.mesh = datasets::cube(2 + random.below(4), random.uniform(0, 0.2), random.bits());
  c.clip = random_clip(random, c.mesh, c.words);
  if (random.chance(0.3)) {  // the field is the distance from the plane, so its iso-surfaces are parallel planes
    const HalfSpace plane = c.clip.front();
    const glm::dvec3 normal = glm::normalize(plane.normal);
    const double offset = random.uniform(-1, 1), scale = random.chance(0.5) ? 1 : random.power(-3, 3);
    for (std::size_t v = 0; v < c.mesh.positions.size(); ++v)
      c.mesh.scalars[v] = (offset + glm::dot(normal, c.mesh.positions[v] - plane.point)) * scale;
    // Iso-surfaces in the plane, where they are the cut face or nothing, and close to it, where pieces may be very
    // thin.
    for (const double distance : {0.0, 1e-2, 1e-4, 1e-6, -1e-3})
      if (random.chance(0.7))
        c.surfaces.iso.push_back({(offset + distance) * scale, glm::dvec3(random.uniform(0, 1)), 0.6});
    c.words += ", of which the field is the distance";
  }
  const auto range = scene::scalar_range(c.mesh);
  for (int n = 1 + random.below(4); n > 0; --n)
    c.surfaces.iso.push_back(
        {random.chance(0.5)
             ? random.uniform(range[0], range[1])
             : c.mesh.scalars[static_cast<std::size_t>(random.below(static_cast<int>(c.mesh.scalars.size())))],
         glm::dvec3(random.uniform(0, 1), random.uniform(0, 1), 1), random.uniform(0.2, 1)});
  return c;
}

TEST(ClippedSurfaces, MatchShortenedRays) {
  const int first = wanted("TESSERA_RANDOM_FIRST", 0), last = first + wanted("TESSERA_RANDOM_CASES", 100);
  double worst = 0;
  std::size_t excused = 0, pixels = 0;
  for (int number = first; number < last; ++number) {
    Random random(5000011u + static_cast<std::uint64_t>(number));
    const Clipping c = random_clipping(random);
    const scene::TetMesh cut = clipped(c.mesh, c.clip, c.surfaces);
    if (cut.tets.empty()) continue;
    const auto [camera, extent] = random_view(random, cut);
    const scene::TransferFunction function =
        datasets::smooth_knots(20, scene::scalar_range(c.mesh), random.power(-1, 1) / extent, 3);
    Settings settings;
    settings.integrator.kind = scene::IntegratorKind::exact;
    settings.use.lattice = number % 4 != 3;
    settings.surfaces = c.surfaces;
    const scene::Image image = Renderer(cut, settings).render(camera, size, function);
    const reference::Reference reference(c.mesh, camera, size, function, Emission::absorption, c.surfaces, c.clip);
    const reference::Judgement judged = reference::judge(image, reference, promised_error);
    EXPECT_LE(judged.max_error_not_excused, promised_error)
        << "case " << number << ", " << c.words << ", at (" << judged.worst_x << ", " << judged.worst_y << ") of "
        << judged.over_bound;
    worst = std::max(worst, judged.max_error_not_excused), excused += judged.excused, pixels += judged.pixels_checked;
  }
  EXPECT_LE(static_cast<double>(excused), 1e-4 * static_cast<double>(pixels) + 3);
  std::printf("cases %d to %d: largest error %.3g, %zu of %zu pixels excused\n", first, last - 1, worst, excused,
              pixels);
}

}  // namespace
}  // namespace tessera::frame::clipped_surfaces_test
