// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <sys/mman.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/glm.hpp>
#include <memory>
#include <random>
#include <vector>

#include "scene/error.hpp"
#include "support/instruction_sets.hpp"
#include "support/some_cases.hpp"
#include "volume/bricks/brick_cache.hpp"
#include "volume/double_caster.hpp"
#include "volume/render.hpp"
#include "volume/small_volume.hpp"

namespace tessera::caster_test {
namespace {

using namespace tests;  // small volumes and views

/// Largest difference from double precision over pixels of a coarse lattice.
double error_of(const scene::Image& image, const Volume& v, const scene::Camera& camera,
                const scene::TransferFunction& function, Emission emission = Emission::absorption) {
  const tests::DoubleCaster caster{v.grid.geometry, [&](auto i, auto j, auto k) { return v.at(i, j, k); }, function,
                                   emission};
  double worst = 0;
  for (int y = 3; y < size.height; y += 11)
    for (int x = 2; x < size.width; x += 9) {
      const auto pixel = caster.cast(camera, size, x + 0.5, y + 0.5);
      for (int c = 0; c < 4; ++c)
        worst =
            std::max(worst, std::abs(pixel.rgba[c] - image.rgba[4 * image.index(x, y) + static_cast<std::size_t>(c)]));
      if (pixel.rgba[3] > 1e-6) {
        EXPECT_NEAR(image.depth[image.index(x, y)], pixel.depth, 2e-5) << x << ' ' << y;
      }
    }
  return worst;
}

TEST(VolumeCaster, ExactIsWithin1e5OfDoublePrecisionFromAllSides) {
  const Volume v = make_volume({37, 30, 26}, Field::smooth);
  test::SomeCases some(4);
  for (const char* name : views) {
    if (!some.next()) continue;
    EXPECT_LT(error_of(render(v, view(name), smooth_function(), exact()), v, view(name), smooth_function()), 1e-5)
        << name;
  }
}

TEST(VolumeCaster, ExactIsWithin1e5InNoise) {
  // Every voxel's field is as nonlinear as possible.
  const Volume v = make_volume({21, 18, 17}, Field::noise);
  test::SomeCases some(5);
  for (const char* name : views)
    for (const auto& function : {smooth_function(), sharp_function(), many_knots()}) {
      if (!some.next()) continue;
      EXPECT_LT(error_of(render(v, view(name), function, exact()), v, view(name), function), 1e-5)
          << name << ", " << function.knots().size() << " knots";
    }
}

// The function of a logarithm, as created by `--log`, over eight decades of data: most knots are within a thousandth of
// the range.
TEST(VolumeCaster, LogarithmicFunctionsEndWithin1e5) {
  Volume v = make_volume({9, 8, 7}, Field::smooth);
  for (float& value : v.values) value = std::pow(10.0F, 8 * (value - 1));
  v.source = scene::MemorySource::of(v.grid, v.values);
  std::vector<scene::Knot> knots;
  constexpr int count = 700;
  for (int n = 0; n <= count; ++n) {
    const double x = static_cast<double>(n) / count;
    knots.push_back({std::pow(10.0, 8 * (x - 1)), {x, 0.5, 1 - x}, 2 * x});
  }
  const scene::TransferFunction function(knots);
  test::SomeCases some(2);
  for (const char* name : {"oblique", "perspective"})
    if (some.next()) {
      EXPECT_LT(error_of(render(v, view(name), function, exact()), v, view(name), function), 1e-5) << name;
    }
}

TEST(VolumeCaster, AutomaticMeetsItsAccuracyInNoise) {
  const Volume v = make_volume({21, 18, 17}, Field::noise);
  test::SomeCases some(5);
  for (const double accuracy : {1e-3, 1e-4, 1e-5}) {
    volume::RenderSettings s;
    s.integrator.accuracy = accuracy;
    for (const auto& function : {smooth_function(), sharp_function()}) {
      if (!some.next()) continue;
      EXPECT_LT(error_of(render(v, view("oblique"), function, s), v, view("oblique"), function), accuracy);
    }
  }
}

scene::TransferFunction bright_function(double light) {
  const scene::TransferFunction smooth = smooth_function();
  std::vector<scene::Knot> knots(smooth.knots().begin(), smooth.knots().end());
  for (scene::Knot& knot : knots) knot.color *= light, knot.extinction = 0.1;
  return scene::TransferFunction(std::move(knots));
}

TEST(VolumeCaster, UncertainRaysAreCastInDoublePrecision) {
  const Volume v = make_volume({13, 11, 9}, Field::noise);
  const auto expect_kept = [&](double accuracy, const scene::TransferFunction& function, Emission emission) {
    volume::RenderSettings s;
    s.integrator.accuracy = accuracy;
    s.emission = emission;
    volume::RenderStatistics statistics;
    const scene::Image image = render(v, view("oblique"), function, s, &statistics);
    EXPECT_LT(error_of(image, v, view("oblique"), function, emission), accuracy) << accuracy;
    EXPECT_GT(statistics.pixels_again, 0u) << accuracy;
  };
  for (const double accuracy : {1e-6, 4e-6})
    for (const auto& function : {smooth_function(), sharp_function()})
      expect_kept(accuracy, function, Emission::absorption);
  // Light of magnitude in the hundreds, which lanes reproduce to 1e-6.
  expect_kept(1e-4, bright_function(200), Emission::independent);
}

TEST(VolumeCaster, EveryInstructionSetIsWithin1e5) {
  const Volume v = make_volume({21, 18, 17}, Field::noise);
  tests::for_each_instruction_set([&](const char* name) {
    volume::RenderStatistics statistics;
    EXPECT_LT(error_of(render(v, view("perspective"), smooth_function(), exact(), &statistics), v, view("perspective"),
                       smooth_function()),
              1e-5)
        << name;
    EXPECT_EQ(statistics.instruction_set, name);
  });
}

TEST(VolumeCaster, CellDataAreConstantVoxels) {
  const Volume v = make_volume({19, 17, 20}, Field::noise, true);
  for (const char* name : {"oblique", "from -x", "perspective"})
    EXPECT_LT(error_of(render(v, view(name), smooth_function(), exact()), v, view(name), smooth_function()), 1e-5)
        << name;
}

TEST(VolumeCaster, IndependentEmission) {
  const Volume v = make_volume({21, 18, 17}, Field::noise);
  volume::RenderSettings s = exact();
  s.emission = Emission::independent;
  EXPECT_LT(
      error_of(render(v, view("oblique"), smooth_function(), s), v, view("oblique"), smooth_function(), s.emission),
      1e-5);
}

TEST(VolumeCaster, VerySmallDoublesLookLikeOthers) {
  const Volume v = make_volume({21, 18, 17}, Field::noise);
  // All numbers are normal, and scales are powers of two, so that no sample and no knot is rounded.
  const auto picture = [&](double scale) {
    std::vector<double> values;
    for (const float value : v.values) values.push_back(std::max(static_cast<double>(value), 0x1p-12) * scale);
    const scene::TransferFunction function = smooth_function();
    std::vector<scene::Knot> knots(function.knots().begin(), function.knots().end());
    for (scene::Knot& knot : knots) knot.value *= scale;
    scene::Grid grid = v.grid;
    const auto source = scene::MemorySource::of(grid, values);
    return volume::Renderer(*source, exact()).render(view("oblique"), size, scene::TransferFunction(knots)).image;
  };
  const scene::Image expected = picture(1);
  for (const double scale : {0x1p-900, 0x1p-975, 0x1p-1009}) EXPECT_TRUE(same_bits(picture(scale), expected)) << scale;
}

TEST(VolumeCaster, BlankSamplesBlankTheirVoxels) {
  Volume v = make_volume({21, 18, 17}, Field::noise);
  std::mt19937 random(3);
  for (int n = 0; n < 200; ++n) v.values[random() % v.values.size()] = n % 3 == 0 ? -HUGE_VALF : NAN;
  v.source = scene::MemorySource::of(v.grid, v.values);
  std::uint64_t blanks = 0;
  for (const float value : v.values) blanks += std::isfinite(value) ? 0 : 1;
  volume::RenderStatistics statistics;
  EXPECT_LT(error_of(render(v, view("oblique"), smooth_function(), exact(), &statistics), v, view("oblique"),
                     smooth_function()),
            1e-5);
  EXPECT_EQ(statistics.blank_samples, blanks);
}

TEST(VolumeCaster, SameBitsForAnyBricksThreadsAndCache) {
  const Volume v = make_volume({37, 30, 26}, Field::smooth);
  test::SomeCases some(5);
  for (const char* name : {"oblique", "from -x", "inside"}) {
    const scene::Image image = render(v, view(name), sharp_function());
    for (const int brick : {2, 3, 8, 11, 64})
      for (const int threads : {1, 2}) {
        if (!some.next()) continue;
        volume::RenderSettings s;
        s.grid.brick_size = brick, s.threads = threads;
        EXPECT_TRUE(same_bits(render(v, view(name), sharp_function(), s), image)) << name << ' ' << brick;
        s.memory_bytes = static_cast<std::uint64_t>(4 * std::pow(brick + 1, 3)) * 3;
        s.grid.cache = brick % 2 == 0 ? CachePolicy::proximity : CachePolicy::lru;
        volume::RenderStatistics statistics;
        EXPECT_TRUE(same_bits(render(v, view(name), sharp_function(), s, &statistics), image)) << name << ' ' << brick;
        EXPECT_LE(statistics.peak_bytes, s.memory_bytes);
      }
  }
}

TEST(VolumeCaster, ARegionHasThePixelsOfTheWhole) {
  const Volume v = make_volume({37, 30, 26}, Field::smooth);
  const scene::Image whole = render(v, view("oblique"), smooth_function());
  volume::Renderer renderer(*v.source, {});
  const scene::PixelRect region{13, 7, 61, 50};
  const scene::Image part = renderer.render(view("oblique"), size, smooth_function(), {.regions = {region}}).image;
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const bool inside = x >= region.x0 && x < region.x1 && y >= region.y0 && y < region.y1;
      for (std::size_t c = 0; c < 4; ++c)
        ASSERT_EQ(part.rgba[4 * part.index(x, y) + c], inside ? whole.rgba[4 * whole.index(x, y) + c] : 0.0f);
    }
}

// Packets many voxels wide read their samples from memory.
TEST(VolumeCaster, PacketsManyVoxelsWideAreWithin1e5) {
  const Volume v = make_volume({56, 56, 48}, Field::smooth);
  for (const char* const from : {"oblique", "perspective"}) {
    const scene::Camera camera = view(from);
    const scene::ImageSize coarse{8, 7};
    const tests::DoubleCaster caster{v.grid.geometry, [&](auto i, auto j, auto k) { return v.at(i, j, k); },
                                     smooth_function()};
    const scene::Image image = volume::Renderer(*v.source, exact()).render(camera, coarse, smooth_function()).image;
    for (int y = 0; y < coarse.height; ++y)
      for (int x = 0; x < coarse.width; ++x) {
        const auto pixel = caster.cast(camera, coarse, x + 0.5, y + 0.5);
        for (int c = 0; c < 4; ++c)
          EXPECT_NEAR(image.rgba[4 * image.index(x, y) + static_cast<std::size_t>(c)], pixel.rgba[c], 1e-5);
      }
  }
}

TEST(VolumeCaster, InvisibleBricksAreNotLoaded) {
  Volume v = make_volume({65, 65, 65}, Field::smooth);
  for (std::size_t n = 0; n < v.values.size(); ++n) v.values[n] = n % 65 > 40 ? 0.9f : 0.1f;
  v.source = scene::MemorySource::of(v.grid, v.values);
  const scene::TransferFunction function({{0.5, {1, 1, 1}, 0}, {1, {1, 1, 1}, 3}});
  volume::RenderSettings s;
  s.grid.brick_size = 16;
  volume::RenderStatistics statistics;
  EXPECT_LT(error_of(render(v, view("oblique"), function, s, &statistics), v, view("oblique"), function), 1e-4);
  EXPECT_EQ(statistics.bricks_total, 64u);
  EXPECT_EQ(statistics.bricks_invisible, 32u);
  EXPECT_LE(statistics.bricks_loaded, 32u);
}

TEST(VolumeCaster, AHomogeneousBoxFollowsBeerAndLambert) {
  Volume v = make_volume({5, 4, 3}, Field::smooth);
  std::fill(v.values.begin(), v.values.end(), 0.5f);
  v.source = scene::MemorySource::of(v.grid, v.values);
  const scene::Image image = render(v, view("along z"), scene::TransferFunction({{0, {0.25, 0.5, 1}, 2}}), exact());
  const std::size_t middle = 4 * image.index(48, 40);
  const double alpha = -std::expm1(-2 * 1.2);  // extinction 2 over a box 1.2 thick
  EXPECT_NEAR(image.rgba[middle + 3], alpha, 1e-6);
  EXPECT_NEAR(image.rgba[middle], 0.25 * alpha, 1e-6);
  EXPECT_NEAR(image.depth[middle / 4], 4.4, 1e-5);
}

/// Largest error of RGBA over a coarse lattice of pixels, at decreasing steps.
std::vector<double> errors_of(IntegratorKind method, const Volume& v, const scene::TransferFunction& function,
                              std::initializer_list<double> steps) {
  const scene::Image truth = render(v, view("perspective"), function, exact());
  std::vector<double> errors;
  for (const double step : steps) {
    volume::RenderSettings s;
    s.integrator.kind = method, s.grid.step = step;
    const scene::Image image = render(v, view("perspective"), function, s);
    double sum = 0;
    for (std::size_t n = 0; n < image.rgba.size(); ++n) sum += std::pow(double(image.rgba[n]) - truth.rgba[n], 2);
    errors.push_back(std::sqrt(sum / static_cast<double>(image.rgba.size())));
  }
  return errors;
}

TEST(VolumeCaster, SampledConvergesWithTheSquareOfTheStep) {
  const Volume v = make_volume({37, 30, 26}, Field::smooth);
  const auto e = errors_of(IntegratorKind::sampled, v, smooth_function(), {1, 0.5, 0.25, 0.125});
  // Convergence is of second order if a step crosses neither a knot nor a voxel face. Other steps vary the ratio
  // slightly.
  for (std::size_t n = 1; n < e.size(); ++n) EXPECT_GT(e[n - 1] / e[n], 3) << e[n];
  EXPECT_LT(e.back(), 1e-4);
}

TEST(VolumeCaster, PreintegratedIsBetterThanSampledWhereTheFunctionIsSharp) {
  const Volume v = make_volume({37, 30, 26}, Field::smooth);
  const auto table = errors_of(IntegratorKind::preintegrated, v, sharp_function(), {1, 0.5, 0.25});
  const auto samples = errors_of(IntegratorKind::sampled, v, sharp_function(), {1, 0.5, 0.25});
  for (std::size_t n = 0; n < table.size(); ++n) EXPECT_LT(5 * table[n], samples[n]) << table[n];
  const auto smooth = errors_of(IntegratorKind::preintegrated, v, smooth_function(), {1, 0.5, 0.25});
  for (std::size_t n = 1; n < smooth.size(); ++n) EXPECT_GT(smooth[n - 1] / smooth[n], 2.5) << smooth[n];
}

TEST(VolumeCaster, SteppingHasTheSameBitsForAnyBricksThreadsAndCache) {
  const Volume v = make_volume({37, 30, 65}, Field::smooth);
  for (const auto method : {IntegratorKind::sampled, IntegratorKind::preintegrated}) {
    volume::RenderSettings s;
    s.integrator.kind = method, s.grid.step = 1.7;
    const scene::Image image = render(v, view("inside"), sharp_function(), s);
    for (const int brick : {2, 11, 64}) {
      s.grid.brick_size = brick, s.threads = brick % 3;
      s.memory_bytes = static_cast<std::uint64_t>(4 * std::pow(brick + 1, 3)) * 4;
      EXPECT_TRUE(same_bits(render(v, view("inside"), sharp_function(), s), image)) << brick;
    }
  }
}

TEST(VolumeCaster, ShadingOfALinearFieldFollowsBlinnAndPhong) {
  // There is one normal everywhere. So a shaded pixel is the unshaded pixel times a factor, plus white in proportion to
  // its opacity.
  Volume v = make_volume({17, 14, 12}, Field::smooth);
  const glm::dvec3 gradient{0.21, 0.33, -0.17};
  const scene::GridIndex n = v.grid.geometry.samples();
  for (std::int64_t k = 0; k < n[2]; ++k)
    for (std::int64_t j = 0; j < n[1]; ++j)
      for (std::int64_t i = 0; i < n[0]; ++i)
        v.values[static_cast<std::size_t>(i + n[0] * (j + n[1] * k))] =
            static_cast<float>(0.5 + glm::dot(gradient, scene::world_of_index(v.grid.geometry, {i, j, k})));
  v.source = scene::MemorySource::of(v.grid, v.values);
  for (const char* name : {"oblique", "from -x", "from y", "perspective", "inside"})
    for (const bool camera_light : {true, false}) {
      volume::RenderSettings s = exact();
      const scene::Image plain = render(v, view(name), smooth_function(), s);
      s.grid.shading = Shading{0.3, 0.6, 0.4, 9, {0.4, -0.3, 0.8}, camera_light};
      const scene::Image shaded = render(v, view(name), smooth_function(), s);
      const scene::Camera camera = view(name);
      const scene::ViewBasis basis = scene::view_basis(camera);
      const bool perspective = camera.projection == scene::ProjectionKind::perspective;
      const glm::dvec3 l0 = glm::normalize(s.grid.shading->to_light);
      const glm::dvec3 l = camera_light ? basis.right * l0.x + basis.up * l0.y - basis.forward * l0.z : l0;
      const glm::dvec3 normal = glm::normalize(gradient);
      double worst = 0;
      for (int y = 0; y < size.height; y += 3)
        for (int x = 0; x < size.width; x += 3) {
          const double pixel = 2 * std::tan(glm::radians(camera.view_angle / 2)) / size.height;
          glm::dvec3 ray = basis.forward;
          if (perspective)
            ray += basis.right * ((x + 0.5 - size.width / 2.0) * pixel) -
                   basis.up * ((y + 0.5 - size.height / 2.0) * pixel);
          const glm::dvec3 half = glm::normalize(l - glm::normalize(ray));
          const double own = 0.3 + 0.6 * std::abs(glm::dot(normal, l)),
                       white = 0.4 * std::pow(std::abs(glm::dot(normal, half)), 9);
          const std::size_t at = 4 * plain.index(x, y);
          for (std::size_t c = 0; c < 3; ++c)
            worst = std::max(worst,
                             std::abs(shaded.rgba[at + c] - (own * plain.rgba[at + c] + white * plain.rgba[at + 3])));
          worst = std::max(worst, double(std::abs(shaded.rgba[at + 3] - plain.rgba[at + 3])));
        }
      // Gradients of samples that are rounded to float, one voxel apart, have a relative error of 1e-6. The power of
      // the highlight makes it 1e-5.
      EXPECT_LT(worst, 3e-5) << name << ' ' << camera_light;
    }
}

TEST(BrickCache, TheLastBrickOf2048CubedIsFound) {
  // Eight gibibytes of address space, but only a few pages are accessed.
  constexpr std::int64_t side = 2048;
  constexpr auto bytes = static_cast<std::size_t>(side * side * side);
  void* const memory = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (memory == MAP_FAILED) GTEST_SKIP() << "this system gives no 8 GiB of addresses";
  const std::shared_ptr<std::byte> owner(static_cast<std::byte*>(memory), [](std::byte* p) { munmap(p, bytes); });
  const auto at = [&](std::int64_t i, std::int64_t j, std::int64_t k) -> std::byte& {
    return owner.get()[i + side * (j + side * k)];
  };
  at(2047, 2047, 2047) = std::byte{201};
  at(2040, 2047, 2046) = std::byte{202};
  at(0, 0, 2047) = std::byte{203};
  scene::Grid grid;
  grid.geometry.points = {side, side, side};
  grid.type = scene::SampleType::uint8;
  const scene::MemorySource source(grid, {owner.get(), bytes}, owner, "large");
  const volume::BrickLayout layout(source.geometry(), 32, EdgeBricks::variable);
  ASSERT_EQ(layout.count(), 64u * 64u * 64u);
  volume::BrickCache cache(source, layout, 1 << 20, CachePolicy::lru);
  const auto sample = [&](std::int64_t i, std::int64_t j, std::int64_t k) {
    const auto brick = static_cast<std::size_t>(i / 32 + 64 * (j / 32 + 64 * (k / 32)));
    const scene::SampleBox box = layout.box(layout.place(brick));
    const scene::GridIndex room = layout.room(layout.place(brick));
    const std::byte* const values = cache.acquire(brick, nullptr);
    const std::byte value = values[i - box.low[0] + room[0] * (j - box.low[1] + room[1] * (k - box.low[2]))];
    cache.release(brick);
    return static_cast<int>(value);
  };
  EXPECT_EQ(sample(2046, 2046, 2046), 0);
  EXPECT_EQ(sample(2047, 2047, 2047), 201);
  EXPECT_EQ(sample(2040, 2047, 2046), 202);
  EXPECT_EQ(sample(0, 0, 2047), 203);
}

TEST(VolumeCaster, ABudgetBelowOneBrickIsRefused) {
  const Volume v = make_volume({37, 30, 26}, Field::smooth);
  volume::RenderSettings s;
  s.memory_bytes = 1000;
  EXPECT_THROW(volume::Renderer(*v.source, s), scene::Error);
}

}  // namespace
}  // namespace tessera::caster_test
