// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <optional>
#include <random>
#include <string>

#include "frame/mesh/render.hpp"
#include "reference/judge.hpp"
#include "support/some_cases.hpp"

/// Random cases of a class of scenes, checked against the promised accuracy. TESSERA_RANDOM_CASES=N sets their number
/// instead of the test's default, TESSERA_RANDOM_FIRST=N the first one.
namespace tessera::frame {

struct Random {
  std::mt19937_64 bits;
  explicit Random(std::uint64_t seed) : bits(seed) {}
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(bits); }
  double power(double low, double high) { return std::pow(10, uniform(low, high)); }
  int below(int n) { return std::uniform_int_distribution<int>(0, n - 1)(bits); }
  bool chance(double p) { return uniform(0, 1) < p; }
  template <class T, std::size_t n>
  T of(const T (&list)[n]) {
    return list[static_cast<std::size_t>(below(static_cast<int>(n)))];
  }
  glm::dvec3 direction() {
    for (;;) {
      const glm::dvec3 v(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
      if (glm::length(v) > 0.1 && glm::length(v) < 1) return glm::normalize(v);
    }
  }
};

inline int wanted(const char* name, int otherwise) {
  const char* value = std::getenv(name);
  return value != nullptr ? std::atoi(value) : otherwise;
}

struct RandomCase {
  scene::TetMesh mesh;
  scene::Camera camera;
  scene::TransferFunction function;
  std::string words;
  Surfaces surfaces{};
  std::optional<Shading> shading{};
};

/// Renders each case with `exact`, and automatically with the accuracies 1e-4 and 1e-5, on the lattice if it can
/// represent the scene. Every fourth case is rendered in double precision throughout. The fraction 1e-4 of the pixels,
/// plus three standard deviations, may be excused.
template <class Make>
void expect_random_cases_right(std::uint64_t seed, int cases, Make make) {
  constexpr scene::ImageSize size{20, 20};
  const int first = wanted("TESSERA_RANDOM_FIRST", 0), last = first + wanted("TESSERA_RANDOM_CASES", cases);
  std::size_t pixels = 0, excused = 0, on_lattice = 0;
  double worst = 0;
  test::SomeCases some(5);
  for (int number = first; number < last; ++number) {
    if (!some.next()) continue;
    Random random(seed * 1000003 + static_cast<std::uint64_t>(number));
    const RandomCase c = make(random);
    const reference::Reference reference(c.mesh, c.camera, size, c.function, Emission::absorption, c.surfaces, {},
                                         c.shading);
    for (const double bound : {2e-5, 1e-4, 1e-5}) {
      Settings settings;
      settings.threads = 1;
      settings.use.lattice = number % 4 != 3;
      settings.surfaces = c.surfaces;
      settings.mesh.shading = c.shading;
      settings.integrator.kind = bound == 2e-5 ? scene::IntegratorKind::exact : scene::IntegratorKind::automatic;
      settings.integrator.accuracy = bound;
      FrameStatistics statistics;
      const scene::Image image = Renderer(c.mesh, settings).render(c.camera, size, c.function, &statistics);
      const reference::Judgement judgement = reference::judge(image, reference, bound);
      pixels += judgement.pixels_checked, excused += judgement.excused, on_lattice += statistics.on_lattice ? 1u : 0u;
      worst = std::max(worst, judgement.max_error_not_excused / bound);
      EXPECT_LE(judgement.max_error_not_excused, bound)
          << "case " << number << " of seed " << seed << ", " << c.words << ": " << judgement.over_bound << " over at ("
          << judgement.worst_x << ", " << judgement.worst_y << ')' << (statistics.on_lattice ? ", lattice" : "");
    }
  }
  const double share = 1e-4 * static_cast<double>(pixels);
  EXPECT_LE(static_cast<double>(excused), share + 3 * std::sqrt(share)) << "of " << pixels;
  testing::Test::RecordProperty("worst", std::to_string(worst));
  std::printf(
      "seed %d, cases %d to %d: largest error %.3g of what was promised, %zu of %zu pixels excused, %zu frames on the "
      "lattice\n",
      static_cast<int>(seed), first, last - 1, worst, excused, pixels, on_lattice);
}

}  // namespace tessera::frame
