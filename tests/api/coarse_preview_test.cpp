// SPDX-License-Identifier: BSD-3-Clause
#include "tessera/coarse_preview.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <stop_token>

#include "api/dataset.hpp"
#include "api/query_data.hpp"
#include "datasets/modify.hpp"
#include "scene/error.hpp"
#include "tessera/session.hpp"

namespace tessera::coarse_preview_test {
namespace {

using tests::grid_of;
using tests::part_of;
using tests::with_field;

double waves(const glm::dvec3& p) { return std::sin(2.5 * p.x) * std::cos(2 * p.y) + 0.5 * p.z; }

double mean_difference(const Image& a, const Image& b) {
  double all = 0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) all += std::abs(double{a.rgba[i]} - b.rgba[i]);
  return all / static_cast<double>(a.rgba.size());
}

std::vector<float> samples_of(const Dataset& data) {
  const scene::SampleSource& source = *StateAccess::of(data).samples;
  std::vector<float> samples(static_cast<std::size_t>(source.geometry().all_samples().count()));
  source.read(source.geometry().all_samples(), std::span(samples));
  return samples;
}

bool same_samples(const Dataset& a, const Dataset& b) {
  const auto p = samples_of(a), q = samples_of(b);
  return a.grid_geometry() == b.grid_geometry() && p.size() == q.size() &&
         std::memcmp(p.data(), q.data(), p.size() * sizeof(float)) == 0;
}

TEST(CoarsePreview, LooksLikeAMesh) {
  const Dataset data = Dataset::of(datasets::arrays_of(with_field(datasets::cube(20), waves)));
  const Dataset coarse = *coarse_preview(data, {.samples = 40 * 40 * 40});
  EXPECT_TRUE(coarse.is_grid());
  EXPECT_LE(coarse.grid_geometry().all_samples().count(), 40 * 40 * 40);
  EXPECT_GT(coarse.grid_geometry().all_samples().count(), 30 * 30 * 30);
  EXPECT_EQ(coarse.bounds(), data.bounds());
  EXPECT_EQ(coarse.field_name(), data.field_name());
  EXPECT_EQ(coarse.blank_samples(), 0u);
  const TransferFunction function = data.transfer_function("viridis").function;
  const View view = data.default_view({200, 200});
  const Image truth = Session(data).render(view, function).image, seen = Session(coarse).render(view, function).image;
  EXPECT_LT(mean_difference(truth, seen), 2e-3);
}

/// A ball, whose boundary is nowhere on the samples' lattice.
TEST(CoarsePreview, HasTheVolumeOfAMesh) {
  scene::TetMesh mesh = datasets::cube(24, 0);
  std::vector<std::uint32_t> kept;
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
    glm::dvec3 centre(0);
    for (const std::uint32_t v : mesh.tets[t]) centre += mesh.positions[v] / 4.0;
    if (glm::dot(centre, centre) < 0.7) kept.push_back(t);
  }
  mesh = with_field(scene::subset(mesh, kept), waves);
  double volume = 0;
  for (const scene::Tet& t : mesh.tets) {
    const auto& p = mesh.positions;
    volume += std::abs(glm::dot(p[t[1]] - p[t[0]], glm::cross(p[t[2]] - p[t[0]], p[t[3]] - p[t[0]]))) / 6;
  }
  const Dataset data = Dataset::of(datasets::arrays_of(mesh));
  for (const std::uint64_t samples : {17 * 17 * 17, 33 * 33 * 33, 71 * 71 * 71}) {
    const Dataset coarse = *coarse_preview(data, {.samples = samples});
    const auto values = samples_of(coarse);
    const GridIndex n = coarse.grid_geometry().points;
    std::size_t voxels = 0;
    for (std::int64_t k = 0; k + 1 < n[2]; ++k)
      for (std::int64_t j = 0; j + 1 < n[1]; ++j)
        for (std::int64_t i = 0; i + 1 < n[0]; ++i) {
          bool whole = true;
          for (int corner = 0; corner < 8; ++corner)
            whole = whole && std::isfinite(values[static_cast<std::size_t>(
                                 i + (corner & 1) + n[0] * (j + (corner >> 1 & 1) + n[1] * (k + (corner >> 2))))]);
          voxels += whole ? 1 : 0;
        }
    const glm::dvec3 side = coarse.grid_geometry().spacing;
    EXPECT_NEAR(static_cast<double>(voxels) * side.x * side.y * side.z / volume, 1, 0.08) << samples;
  }
}

TEST(CoarsePreview, OfCellDataHasTheCellsValues) {
  const Dataset data = Dataset::of(datasets::arrays_of(datasets::with_cell_data(datasets::cube(8))));
  const Dataset coarse = *coarse_preview(data, {.samples = 20 * 20 * 20});
  EXPECT_EQ(coarse.association(), Association::point);
  EXPECT_GE(coarse.range()[0], data.range()[0] - 1e-6);
  EXPECT_LE(coarse.range()[1], data.range()[1] + 1e-6);
}

TEST(CoarsePreview, LooksLikeAGrid) {
  const Dataset data = grid_of(65, waves);
  const Dataset coarse = *coarse_preview(data, {.samples = 32 * 32 * 32});
  const GridIndex n = coarse.grid_geometry().points;
  EXPECT_EQ(n, (GridIndex{32, 32, 32}));
  EXPECT_NEAR(glm::distance(coarse.bounds().high, data.bounds().high), 0, 1e-12);
  const TransferFunction function = data.transfer_function("viridis").function;
  const View view = data.default_view({200, 200});
  const Image truth = Session(data).render(view, function).image, seen = Session(coarse).render(view, function).image;
  EXPECT_LT(mean_difference(truth, seen), 3e-3);
}

TEST(CoarsePreview, OfFewSamplesIsTheGridItself) {
  const Dataset data = grid_of(9, waves);
  EXPECT_TRUE(coarse_preview(data, {})->is_copy_of(data));
}

TEST(CoarsePreview, IsTheSameForAnyNumberOfThreadsAndRanks) {
  const scene::TetMesh mesh = with_field(datasets::cube(9), waves);
  const Dataset data = Dataset::of(datasets::arrays_of(mesh));
  const PreviewSettings settings{.samples = 25 * 25 * 25, .threads = 1};
  const Dataset one = *coarse_preview(data, settings);
  EXPECT_TRUE(same_samples(one, *coarse_preview(data, {.samples = settings.samples, .threads = 4})));
  run_ranks(3, [&](const Communicator& communicator) {
    EXPECT_TRUE(same_samples(one, *coarse_preview(part_of(mesh, communicator), settings, {}, communicator)));
  });
  const Dataset grid = grid_of(41, waves);
  EXPECT_TRUE(same_samples(*coarse_preview(grid, settings),
                           *coarse_preview(grid, {.samples = settings.samples, .threads = 4})));
}

TEST(CoarsePreview, StopsOnAllRanksWhenOneIsStopped) {
  const scene::TetMesh mesh = with_field(datasets::cube(9), waves);
  std::stop_source stopped;
  stopped.request_stop();
  EXPECT_FALSE(coarse_preview(Dataset::of(datasets::arrays_of(mesh)), {}, stopped.get_token()));
  EXPECT_FALSE(coarse_preview(grid_of(41, waves), {.samples = 1000}, stopped.get_token()));
  run_ranks(2, [&](const Communicator& communicator) {
    const std::stop_token stop = communicator.rank() == 1 ? stopped.get_token() : std::stop_token();
    EXPECT_FALSE(coarse_preview(part_of(mesh, communicator), {}, stop, communicator));
  });
}

TEST(CoarsePreview, RefusesTooFewAndTooMany) {
  for (const std::uint64_t samples : {std::uint64_t{7}, std::uint64_t{1} << 40})
    EXPECT_THROW((void)coarse_preview(grid_of(9, waves), {.samples = samples}), Error);
}

TEST(CoarsePreview, OfASheetAlongTheBoxIsAsThick) {
  const Dataset sheet = Dataset::of(datasets::arrays_of(datasets::regular_split(8, 8, 1, {0.1, 0.1, 1e-6})));
  const Dataset coarse = *coarse_preview(sheet, {.samples = 1000});
  EXPECT_EQ(coarse.grid_geometry().points[2], 2);
  EXPECT_EQ(coarse.bounds(), sheet.bounds());
  EXPECT_EQ(coarse.blank_samples(), 0u);
}

}  // namespace
}  // namespace tessera::coarse_preview_test
