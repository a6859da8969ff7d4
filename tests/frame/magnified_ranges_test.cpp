// SPDX-License-Identifier: BSD-3-Clause
// Functions that are too steep for the lattice in some ranges of scalars, such as those over a logarithm.
#include "frame/mesh/magnified_ranges.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "api/random_cases.hpp"
#include "datasets/boxes.hpp"
#include "datasets/modify.hpp"
#include "frame/image_difference.hpp"
#include "frame/mesh/render.hpp"
#include "frame/random_clips.hpp"
#include "frame/render_parts.hpp"
#include "frame/surface_scenes.hpp"
#include "reference/judge.hpp"
#include "reference/reference.hpp"

namespace tessera::frame::magnified_ranges_test {
namespace {

using scene::TransferFunction;

constexpr scene::ImageSize size{32, 24};

const scene::Camera oblique = view(scene::ProjectionKind::orthographic, {3.1, 2.3, 4.2});

/// A function whose colour and extinction are waves over the logarithm of the scalar, from 10^-decades to 1. If
/// `stepped`, it has a step in the steepest part.
TransferFunction logarithmic(double decades, std::size_t count, double dense, bool stepped = false) {
  std::vector<scene::Knot> knots;
  for (std::size_t n = 0; n < count; ++n) {
    const double x = static_cast<double>(n) / static_cast<double>(count - 1);
    const double wave = 0.5 + 0.5 * std::sin(17 * x);
    knots.push_back({std::pow(10, decades * (x - 1)), {x, wave, 1 - x}, dense * (0.2 + wave)});
    if (stepped && n == 2) knots.push_back({knots.back().value, {1, 0, 0}, 2 * dense});
  }
  return TransferFunction(knots);
}

/// The pieces of a function, with the change of extinction as the change of a pixel.
std::vector<FunctionPiece> pieces_of(const TransferFunction& function) {
  std::vector<FunctionPiece> pieces;
  const auto knots = function.knots();
  for (std::size_t i = 1; i < knots.size(); ++i)
    if (knots[i - 1].value < knots[i].value)
      pieces.push_back(
          {knots[i - 1].value, knots[i].value, std::abs(knots[i].extinction - knots[i - 1].extinction), false});
  return pieces;
}

TEST(MagnifiedRanges, HaveTheFunctionOnceAndAreFineEnoughForIt) {
  for (const double decades : {5.0, 8.0, 12.0}) {
    for (const bool stepped : {false, true}) {
      SCOPED_TRACE(decades);
      constexpr double low = -0.1, high = 1.2, most_error = 1e-5;
      TransferFunction function = logarithmic(decades, 200, 1, stepped);
      if (stepped) {  // a step at the highest scalar, too
        std::vector<scene::Knot> knots(function.knots().begin(), function.knots().end());
        knots.push_back({high, {0, 1, 0}, 0.5}), knots.push_back({high, {0, 0, 1}, 0});
        function = TransferFunction(knots);
      }
      const auto found = magnify({}, {low, high}, pieces_of(function), most_error, function);
      ASSERT_TRUE(found);
      ASSERT_FALSE(found->magnified.empty());
      double end = low, place = high;
      for (const scene::MagnifiedRange& range : found->magnified) {
        EXPECT_GE(range.low, end);
        EXPECT_GT(range.place, place);
        end = range.high, place = range.moved(range.high);
      }
      // The lattice contains the mesh's scalars and all ranges.
      for (const double s : {low, place})
        EXPECT_LT(std::abs(s - found->lattice.scalar_origin), scene::Lattice::limit * found->lattice.scalar_unit);
      double most = 0;
      Random random(1);
      for (int i = 0; i < 20'000; ++i) {
        const double s = i == 0               ? high
                         : random.chance(0.5) ? random.power(-decades - 0.5, 0.07)
                                              : random.uniform(low, high);
        const auto range = std::ranges::find_if(found->magnified, [&](const auto& r) { return r.contains(s); });
        const double at = range == found->magnified.end() ? s : range->moved(s);
        const scene::Knot expected = function.evaluate(s), knot = found->function.evaluate(at);
        EXPECT_NEAR(knot.extinction, expected.extinction, 1e-9);
        EXPECT_NEAR(knot.color.y, expected.color.y, 1e-9);
        // `moved` is further by half of a float's last place or more. Cells with scalars so near to the end of a range,
        // or to a step, are cut at that end or step.
        const double moved = at + std::abs(at - found->lattice.scalar_origin) * 0x1p-24;
        const auto cut = [&](double end) { return at <= end && end <= moved; };
        const double step = function.knots()[2].value;
        if (range == found->magnified.end()
                ? std::ranges::any_of(found->magnified, [&](const auto& r) { return cut(r.low); })
                : cut(range->moved(range->high)) || (stepped && cut(range->moved(step))))
          continue;
        most = std::max(most, std::abs(found->function.evaluate(moved).extinction - knot.extinction));
      }
      EXPECT_LT(most, most_error);
      EXPECT_GT(most, 0);
    }
  }
}

TEST(MagnifiedRanges, NeedScalarsThatDifferByAFiniteAmount) {
  const TransferFunction function = logarithmic(8, 60, 1);
  for (const auto& [low, high] : {std::array{1e-7, 1e-7}, {-1e308, 1e308}})
    EXPECT_FALSE(magnify({}, {low, high}, pieces_of(function), 1e-5, function)) << low;
}

TEST(MagnifiedRanges, AreAtMostEight) {
  std::vector<scene::Knot> knots;
  for (int i = 0; i < 20; ++i) {
    const double at = 0.05 * (i + 0.5);
    for (const double dense : {0.0, 1.0}) knots.push_back({at + 1e-6 * dense, {1, 1, 1}, dense});
    knots.push_back({at + 0.02, {1, 1, 1}, 0});
  }
  const TransferFunction function(knots);
  EXPECT_FALSE(magnify({}, {0, 1}, pieces_of(function), 1e-5, function));
  const TransferFunction few(std::vector<scene::Knot>(knots.begin(), knots.begin() + 15));
  const auto found = magnify({}, {0, 1}, pieces_of(few), 1e-5, few);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->magnified.size(), 5u);
}

/// Scalars over `decades`, some of them negative, zero in half of the mesh if `level`.
scene::TetMesh mesh_over(double decades, bool level, bool cells, std::uint64_t seed) {
  scene::TetMesh mesh = datasets::cube(4, 0.2);
  Random random(seed);
  const auto field = [&](const glm::dvec3& p) {
    const double u = 0.5 + 0.4 * p.x + 0.1 * std::sin(3 * p.y);
    if (level && p.y < 0) return 0.0;
    return random.chance(0.05) ? -0.01 : std::pow(10, decades * (std::clamp(u, 0.0, 1.0) - 1));
  };
  if (cells) {
    mesh.association = scene::Association::cell;
    mesh.scalars.clear();
    for (const scene::Tet& tet : mesh.tets) mesh.scalars.push_back(field(mesh.positions[tet[0]]));
  } else {
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) mesh.scalars[v] = field(mesh.positions[v]);
  }
  return mesh;
}

TEST(LogarithmicFunctions, AreRenderedOnTheLatticeWithinThePromise) {
  int on_lattice = 0, frames = 0;
  for (const bool cells : {false, true}) {
    for (const bool level : {false, true}) {
      for (const double decades : {4.0, 7.0, 10.0}) {
        const scene::TetMesh mesh = mesh_over(decades, level, cells, 3);
        for (const bool stepped : {false, true}) {
          const TransferFunction function = logarithmic(decades, 60, 2, stepped);
          Random random(static_cast<std::uint64_t>(decades) + (stepped ? 100 : 0));
          for (const double accuracy : {0.0, 1e-4}) {  // 0: exact
            Settings settings;
            settings.threads = 1;
            settings.integrator.kind = accuracy == 0 ? scene::IntegratorKind::exact : scene::IntegratorKind::automatic;
            if (accuracy > 0) settings.integrator.accuracy = accuracy;
            if (random.chance(0.3)) settings.emission = scene::Emission::independent;
            if (!cells && settings.emission == scene::Emission::absorption && random.chance(0.3))
              settings.mesh.shading = scene::Shading();
            if (!cells && random.chance(0.4))
              settings.surfaces.iso = {{function.knots()[4].value * 1.01, {}, 0.5}, {0.03, glm::dvec3(1, 0, 0), 0.4}};
            const scene::Camera camera = random_view(random, mesh).camera;
            FrameStatistics statistics;
            const scene::Image image = Renderer(mesh, settings).render(camera, size, function, &statistics);
            ++frames;
            if (!statistics.on_lattice) continue;
            ++on_lattice;
            const reference::Reference reference(mesh, camera, size, function, settings.emission, settings.surfaces, {},
                                                 settings.mesh.shading);
            const double promise = accuracy == 0 ? 2e-5 : accuracy;
            const reference::Judgement judged = reference::judge(image, reference, promise);
            EXPECT_TRUE(judged.passed) << decades << ' ' << level << ' ' << cells << ' ' << stepped << ": "
                                       << judged.max_error;
          }
        }
      }
    }
  }
  EXPECT_GT(on_lattice, frames * 3 / 4);
}

TEST(LogarithmicFunctions, CutOnlyTheCellsThatReachASteepRange) {
  const TransferFunction function = logarithmic(8, 60, 2);
  const auto in_double = [&](const scene::TetMesh& mesh) {
    FrameStatistics statistics;
    Settings settings;
    Renderer(mesh, settings).render(oblique, size, function, &statistics);
    EXPECT_TRUE(statistics.on_lattice);
    return std::pair(statistics.segments_in_double_precision, statistics.segments);
  };
  scene::TetMesh mesh = datasets::cube(4, 0.2);
  for (double& s : mesh.scalars) s = 0.3 + 0.5 * s;
  mesh.scalars[0] = 0;  // so that the mesh's range contains the function's steep part
  EXPECT_LT(in_double(mesh).first * 4, in_double(mesh).second);
  // Zero is below the smallest knot, at a distance that is smaller than a step of the lattice's scalars.
  mesh.association = scene::Association::cell;
  mesh.scalars.assign(mesh.tets.size(), 0);
  for (std::size_t t = 0; t < mesh.tets.size(); t += 3) mesh.scalars[t] = 1;
  EXPECT_EQ(in_double(mesh).first, 0u);
}

TEST(LogarithmicFunctions, HaveTheSameImageOnRanks) {
  const scene::TetMesh mesh = mesh_over(8, false, false, 5);
  const TransferFunction function = logarithmic(8, 60, 2, true);
  DistributedSettings settings;
  settings.render.threads = 1;
  const FrameJob job{oblique, size};
  FrameStatistics statistics;
  const scene::Image expected = Renderer(mesh, settings.render).render(job.camera, size, function, &statistics);
  ASSERT_TRUE(statistics.on_lattice);
  const auto parts = datasets::parts(mesh, 3, datasets::Partition::random_blobs, 5);
  for (const bool sharing : {false, true}) {
    for (const Exchange exchange : {Exchange::segments, Exchange::runs}) {
      settings.render.use.sharing = sharing;
      settings.exchange = exchange;
      const auto frames = render_parts(parts, settings, job, function);
      ASSERT_EQ(frames.size(), 1u);
      ASSERT_EQ(frames[0].image.rgba.size(), expected.rgba.size());
      // Runs are rounded to float.
      EXPECT_LE(difference(frames[0].image, expected), exchange == Exchange::segments ? 0 : 2e-6) << sharing;
    }
  }
}

}  // namespace
}  // namespace tessera::frame::magnified_ranges_test
