// SPDX-License-Identifier: BSD-3-Clause
#include "compositor/deep/deep_fragments.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "compositor/deep/deep_pieces.hpp"
#include "compositor/deep/deep_sink.hpp"
#include "integrals/segment_batch.hpp"
#include "integrals/segment_integrator.hpp"
#include "support/deep_pixels.hpp"

namespace tessera::compositor::deep_fragments_test {
namespace {

using scene::Emission;

struct Light {
  std::array<double, 3> color{};
  double transmittance = 1;
  void behind(const std::array<double, 3>& light, double optical_depth) {
    for (int c = 0; c < 3; ++c) color[c] += transmittance * light[c];
    transmittance *= std::exp(-optical_depth);
  }
};

struct Medium {
  scene::TransferFunction function;
  Emission emission = Emission::absorption;
  double length_per_depth = 1;
  [[nodiscard]] integrals::SegmentIntegrator integrator() const {
    return {function, {.kind = scene::IntegratorKind::exact}, emission};
  }
};

std::vector<DeepSample> integrated(const std::vector<DeepPiece>& pieces, const Medium& medium) {
  integrals::SegmentBatch batch;
  batch.reserve(pieces.size());
  batch.size = pieces.size();
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    batch.length[k] = (pieces[k].back - pieces[k].front) * medium.length_per_depth;
    batch.scalar_front[k] = pieces[k].scalar_front;
    batch.scalar_back[k] = pieces[k].scalar_back;
  }
  medium.integrator().integrate(batch);
  std::vector<DeepSample> out;
  for (std::size_t k = 0; k < pieces.size(); ++k)
    out.push_back({pieces[k].front,
                   pieces[k].back,
                   {batch.red[k], batch.green[k], batch.blue[k]},  // The integrator's depth ends at opaque matter.
                   pieces[k].optical_depth > 0 ? pieces[k].optical_depth : batch.optical_depth[k]});
  return out;
}

std::vector<DeepPiece> cut(const std::vector<DeepPiece>& segments, const Medium& medium, double accuracy) {
  const PieceCutter cutter(medium.function, medium.emission, accuracy);
  std::vector<DeepPiece> pieces;
  double transmittance = 1;
  for (const DeepPiece& s : segments) cutter.cut(s, medium.length_per_depth, transmittance, pieces);
  return pieces;
}

std::vector<DeepSample> samples_of(const std::vector<DeepPiece>& segments, const Medium& medium, double accuracy) {
  DeepMerger merger(accuracy);
  std::vector<DeepSample> samples;
  for (const DeepSample& piece : integrated(cut(segments, medium, accuracy), medium)) merger.add(piece, samples);
  merger.end(samples);
  return samples;
}

/// The exact light in front of depth z: segments cut there, integrated exactly.
Light truth(const std::vector<DeepPiece>& segments, const Medium& medium, double z) {
  std::vector<DeepPiece> before;
  for (DeepPiece s : segments) {
    if (s.front >= z) break;
    if (s.back > z) {
      s.scalar_back = s.scalar_front + (s.scalar_back - s.scalar_front) * (z - s.front) / (s.back - s.front);
      s.back = z;
    }
    before.push_back(s);
  }
  Light light;
  for (const DeepSample& s : integrated(before, medium)) light.behind(s.light, s.optical_depth);
  return light;
}

/// The light of samples in front of depth z, cut by OpenEXR's rule.
Light cut_samples(const std::vector<DeepSample>& samples, double z) {
  Light light;
  for (const DeepSample& s : samples) {
    if (s.front >= z) break;
    const double x = std::min(1.0, (z - s.front) / (s.back - s.front));
    const double part = s.optical_depth > 0 ? std::expm1(-s.optical_depth * x) / std::expm1(-s.optical_depth) : x;
    light.behind({s.light[0] * part, s.light[1] * part, s.light[2] * part}, s.optical_depth * x);
  }
  return light;
}

double error(const Light& a, const Light& b) {
  double light = 0;
  for (int c = 0; c < 3; ++c) light = std::max(light, std::abs(a.color[c] - b.color[c]));
  return light + std::abs(a.transmittance - b.transmittance);
}

std::vector<DeepPiece> chain(std::mt19937& random, int count, double from, double to) {
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  std::vector<double> ends{from, to};
  for (int i = 1; i < count; ++i) ends.push_back(uniform(from, to));
  std::sort(ends.begin(), ends.end());
  std::vector<DeepPiece> segments;
  double scalar = uniform(-0.1, 1.1);
  for (int i = 0; i < count; ++i) {
    const double next = random() % 6 == 0 ? scalar : uniform(-0.1, 1.1);
    if (random() % 9 == 0) scalar = next;  // cell data's jump
    segments.push_back({ends[i], ends[i + 1], scalar, next});
    scalar = next;
  }
  return segments;
}

TEST(DeepFragments, CuttingAnywhereErrsLessThanTheAccuracy) {
  std::mt19937 random(1);
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  for (int round = 0; round < 600; ++round) {
    Medium medium;
    medium.emission = round % 3 == 2 ? Emission::independent : Emission::absorption;
    medium.length_per_depth = round % 5 == 0 ? 1.7 : 1;
    const double thickness = std::pow(10.0, uniform(-2, 4));
    std::vector<scene::Knot> knots;
    const int count = 1 + static_cast<int>(random() % 8);
    for (int k = 0; k < count; ++k) {
      const double value = k > 0 && random() % 4 == 0 ? knots.back().value : k / 8.0 + uniform(0, 0.12);
      const bool clear = random() % 3 == 0;
      knots.push_back({k > 0 ? std::max(value, knots.back().value) : value,
                       {uniform(0, 1), uniform(0, 1), random() % 2 == 0 ? 0 : uniform(0, 1)},
                       clear ? 0 : thickness * uniform(0, 1)});
    }
    medium.function = scene::TransferFunction(knots);
    const auto segments = chain(random, 1 + static_cast<int>(random() % 30), 2, 2 + uniform(0.1, 3));
    const double accuracy = std::array{1e-2, 1e-3, 1e-4}[round % 3 == 0 ? 0 : random() % 3];
    const auto samples = samples_of(segments, medium, accuracy);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      ASSERT_LT(samples[i].front, samples[i].back);
      if (i > 0) {
        ASSERT_LE(samples[i - 1].back, samples[i].front);
      }
    }
    std::vector<scene::DeepImageSample> floats;
    append_tidy(samples, floats);
    for (int k = 0; k < 60; ++k) {
      const double z = k == 0 ? 100 : uniform(segments.front().front, segments.back().back);
      const Light right = truth(segments, medium, z);
      const double wrong = error(cut_samples(samples, z), right);
      // 1e-7: the integrator's own error. No other tolerance: the bounds are proven.
      ASSERT_LE(wrong, (k == 0 ? 0 : accuracy) + 1e-7)
          << "round " << round << " z " << z << " accuracy " << accuracy << " thickness " << thickness
          << (medium.emission == Emission::independent ? " independent" : "");
      // Depths rounded to float move the cut by 2e-7 for depths up to 5. The effect grows with the extinction, so it is
      // checked only where it is small.
      if (thickness > 10) continue;
      const auto cut_floats = tests::composited(floats, z), in_front_of_white = tests::composited(floats, z, {1, 1, 1});
      double light = 0, brightest = 1;
      for (int c = 0; c < 3; ++c) {
        light = std::max(light, std::abs(cut_floats[c] - right.color[c]));
        brightest = std::max(brightest, right.color[c]);
      }
      const double through = in_front_of_white[0] - cut_floats[0];
      const double wrong_floats = light + std::abs(through - right.transmittance);
      ASSERT_LE(wrong_floats, (k == 0 ? 0 : accuracy) + 2e-5 * brightest) << "round " << round << " z " << z;
    }
  }
}

TEST(DeepFragments, AHomogeneousRayIsOneSampleHoweverManyCellsItPasses) {
  for (const Emission emission : {Emission::absorption, Emission::independent}) {
    const Medium medium{scene::TransferFunction({{0, {0.2, 0.5, 0.9}, 1.5}}), emission};
    std::vector<DeepPiece> segments;
    for (int i = 0; i < 1000; ++i) segments.push_back({i / 500.0, (i + 1) / 500.0, 0.3, 0.4});
    const auto samples = samples_of(segments, medium, 1e-3);
    ASSERT_EQ(samples.size(), 1u);
    EXPECT_EQ(samples[0].front, 0);
    EXPECT_EQ(samples[0].back, 2);
    EXPECT_NEAR(samples[0].optical_depth, 3, 1e-9);
    const double light = emission == Emission::absorption ? -std::expm1(-3.0) : -std::expm1(-3.0) / 1.5;
    EXPECT_NEAR(samples[0].light[2], 0.9 * light, 1e-9);
  }
}

TEST(DeepFragments, GapsSeparateAndClearMatterCarriesNothing) {
  // Matter is clear below 0.5; the ray's scalar decreases to 0 and increases again.
  const Medium medium{scene::TransferFunction({{0, {1, 1, 1}, 0}, {0.5, {1, 1, 1}, 0}, {0.5, {1, 1, 1}, 2}})};
  const auto samples = samples_of({{1, 2, 1, 0}, {2, 3, 0, 1}, {3.5, 4, 1, 1}, {4, 5, 0.2, 0.4}}, medium, 1e-3);
  ASSERT_EQ(samples.size(), 3u);
  const double expected[3][2] = {{1, 1.5}, {2.5, 3}, {3.5, 4}};
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(samples[i].front, expected[i][0], 1e-12);
    EXPECT_NEAR(samples[i].back, expected[i][1], 1e-12);
    EXPECT_NEAR(samples[i].optical_depth, 2 * (expected[i][1] - expected[i][0]), 1e-9);
  }
}

TEST(DeepFragments, CoarserAccuracyTakesFewerSamples) {
  std::mt19937 random(8);
  const Medium medium{scene::TransferFunction({{0, {0, 0.2, 1}, 0.1}, {0.4, {1, 0.3, 0}, 3}, {1, {1, 1, 1}, 0.5}})};
  const auto segments = chain(random, 100, 0, 3);
  std::size_t last = samples_of(segments, medium, 1e-5).size();
  for (const double accuracy : {1e-4, 1e-3, 1e-2, 1e-1}) {
    const std::size_t count = samples_of(segments, medium, accuracy).size();
    EXPECT_LT(count, last) << accuracy;
    last = count;
  }
}

TEST(DeepFragments, OverlappingCellsComeOutOneBehindTheOther) {
  const Medium medium{scene::TransferFunction({{0, {1, 1, 1}, 0.7}})};
  const auto samples = samples_of({{1, 3, 0, 0}, {2, 2.5, 0, 0}, {2, 4, 0, 0}, {4, 5, 0, 0}}, medium, 1e-3);
  double optical_depth = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    optical_depth += samples[i].optical_depth;
    EXPECT_LE(samples[i].front, samples[i].back);
    if (i > 0) {
      EXPECT_LE(samples[i - 1].back, samples[i].front);
    }
  }
  EXPECT_NEAR(optical_depth, 0.7 * (2 + 0.5 + 2 + 1), 1e-9);
}

TEST(DeepFragments, FloatsStayTidyWhereDepthsAreIndistinguishable) {
  // Near 1.6e7, adjacent floats are 1 or 2 apart: samples with a length of about 0.1 get the length 0 or a whole number
  // of units.
  std::mt19937 random(3);
  std::vector<DeepSample> samples;
  double z = 16777200;
  for (int i = 0; i < 2000; ++i) {
    const double next = z + 0.001 * static_cast<double>(1 + random() % 300);
    samples.push_back({z, next, {0.001, 0.002, 0}, 1e-3});
    z = next;
  }
  samples.push_back({z, z + 1, {0, 0, 0}, 1e-60});  // vanishes in float
  std::vector<scene::DeepImageSample> tidy;
  append_tidy(samples, tidy);
  ASSERT_GT(tidy.size(), 10u);
  EXPECT_LT(tidy.size(), 2000u);
  for (std::size_t i = 0; i < tidy.size(); ++i) {
    EXPECT_LE(tidy[i].z, tidy[i].z_back);
    if (i == 0) continue;
    EXPECT_LE(tidy[i - 1].z_back, tidy[i].z);
    EXPECT_FALSE(tidy[i].z == tidy[i].z_back && tidy[i - 1].z == tidy[i - 1].z_back && tidy[i].z == tidy[i - 1].z);
  }
  // The composited result equals that of the samples up to 2000 roundings of 6e-8 each.
  const auto sum = tests::composited(tidy);
  EXPECT_NEAR(sum[3], -std::expm1(-2.0), 1e-4);
  EXPECT_NEAR(sum[1], -std::expm1(-2.0) * 0.002 / -std::expm1(-1e-3), 1e-4);
}

}  // namespace
}  // namespace tessera::compositor::deep_fragments_test
