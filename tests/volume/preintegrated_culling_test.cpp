// SPDX-License-Identifier: BSD-3-Clause
// What pre-integration may skip: a step shows values between its ends, even if neither end is visible.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "support/some_cases.hpp"
#include "volume/bricks/cell_ranges.hpp"
#include "volume/small_volume.hpp"

namespace tessera::preintegrated_culling_test {
namespace {

using namespace tests;

/// Mostly empty: two blobs, one smooth, one with a steep side.
Volume blobs(bool cell_data, bool blanks) {
  Volume v = make_volume({71, 60, 65}, Field::smooth, cell_data);
  const scene::GridIndex n = v.grid.geometry.samples();
  for (std::int64_t k = 0; k < n[2]; ++k)
    for (std::int64_t j = 0; j < n[1]; ++j)
      for (std::int64_t i = 0; i < n[0]; ++i) {
        const glm::dvec3 p(i, j, k);
        const double far = glm::length(p - glm::dvec3(20, 22, 30)), near = glm::length(p - glm::dvec3(50, 40, 32));
        float& value = v.values[static_cast<std::size_t>(i + n[0] * (j + n[1] * k))];
        value = static_cast<float>(std::max(std::exp(-far * far / 40), near < 9.5 ? 1.0 : 0.0));
        if (blanks && k == 32 && i < 12) value = std::numeric_limits<float>::quiet_NaN();
      }
  v.source = scene::MemorySource::of(v.grid, v.values);
  return v;
}

/// Neither of the steep side's two values is visible, but values between them are.
scene::TransferFunction between() {
  return scene::TransferFunction(
      {{0.3, {0, 0, 0}, 0}, {0.4, {0.2, 0.9, 0.3}, 20}, {0.6, {0.9, 0.3, 0.1}, 20}, {0.7, {1, 1, 1}, 0}});
}

scene::TransferFunction top() { return scene::TransferFunction({{0.6, {0.2, 0.9, 0.3}, 0}, {1, {0.9, 0.3, 0.1}, 20}}); }

TEST(PreintegratedCulling, ChangesNoBit) {
  test::SomeCases some(5);
  for (const bool cell_data : {false, true})
    for (const bool blanks : {false, true}) {
      const Volume v = blobs(cell_data, blanks);
      for (const auto& function : {between(), top()})
        for (const double step : {0.5, 2.7, 25.0})
          for (const char* name : {"oblique", "from y", "inside"}) {
            if (!some.next()) continue;
            volume::RenderSettings s;
            s.integrator.kind = IntegratorKind::preintegrated, s.grid.step = step, s.grid.brick_size = 8;
            volume::RenderStatistics culled, all;
            const scene::Image image = render(v, view(name), function, s, &culled);
            s.use.culling = s.use.skipping = false;
            EXPECT_TRUE(same_bits(image, render(v, view(name), function, s, &all)))
                << name << ", step " << step << (cell_data ? ", cells" : "") << (blanks ? ", blanks" : "");
            EXPECT_LE(culled.samples, all.samples);
            EXPECT_EQ(all.bricks_invisible, 0u);
            EXPECT_LE(culled.bricks_loaded, all.bricks_loaded);
          }
    }
}

TEST(PreintegratedCulling, LoadsLittleMoreThanWhatShows) {
  const Volume v = blobs(false, false);
  volume::RenderSettings s;
  s.grid.brick_size = 8;
  volume::RenderStatistics exact, culled;
  render(v, view("oblique"), between(), s, &exact);
  s.integrator.kind = IntegratorKind::preintegrated;
  const scene::Image image = render(v, view("oblique"), between(), s, &culled);
  EXPECT_GT(*std::max_element(image.rgba.begin(), image.rgba.end()), 0.1f);
  EXPECT_GT(culled.bricks_invisible, culled.bricks_total / 2);
  EXPECT_LT(culled.bricks_loaded, culled.bricks_total / 2);
  EXPECT_LE(culled.bricks_invisible, exact.bricks_invisible);
}

}  // namespace
}  // namespace tessera::preintegrated_culling_test
