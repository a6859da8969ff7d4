// SPDX-License-Identifier: BSD-3-Clause
#include "datasets/transfer_functions.hpp"

#include <algorithm>
#include <vector>

#include "datasets/random.hpp"
#include "scene/error.hpp"

namespace tessera::datasets {
namespace {

scene::Knot random_knot(Random& random, double value, double extinction) {
  scene::Knot knot;
  knot.value = value;
  for (int i = 0; i < 3; ++i) knot.color[i] = random.uniform();
  // The number is squared, so that most knots have a low extinction and a few a high one, as in functions drawn by
  // hand.
  const double u = random.uniform();
  knot.extinction = random.below(4) == 0 ? 0 : extinction * u * u;
  return knot;
}

/// Returns `n` increasing values strictly inside (0, 1), unevenly spaced.
std::vector<double> places(Random& random, int n) {
  std::vector<double> at;
  at.reserve(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) at.push_back((i + random.uniform(0.1, 0.9)) / n);
  return at;
}

}  // namespace

scene::TransferFunction smooth_knots(int knots, std::array<double, 2> range, double extinction, std::uint64_t seed) {
  if (knots < 1) throw scene::bad_input("a transfer function needs at least one knot");
  Random random(seed);
  std::vector<double> at = places(random, knots);
  at.front() = 0;
  if (knots > 1) at.back() = 1;
  std::vector<scene::Knot> out;
  out.reserve(at.size());
  for (const double u : at) out.push_back(random_knot(random, range[0] + (range[1] - range[0]) * u, extinction));
  if (std::none_of(out.begin(), out.end(), [](const scene::Knot& k) { return k.extinction > 0; }))
    out.back().extinction = extinction;
  return scene::TransferFunction(out);
}

scene::TransferFunction step_knots(int steps, std::array<double, 2> range, double extinction, std::uint64_t seed) {
  if (steps < 1) throw scene::bad_input("a step function needs at least one step");
  Random random(seed);
  std::vector<scene::Knot> out;
  scene::Knot level = random_knot(random, 0, extinction);
  for (const double u : places(random, steps)) {
    level.value = range[0] + (range[1] - range[0]) * u;
    out.push_back(level);
    level = random_knot(random, level.value, extinction);
    out.push_back(level);
  }
  if (std::none_of(out.begin(), out.end(), [](const scene::Knot& k) { return k.extinction > 0; }))
    out.back().extinction = extinction;
  return scene::TransferFunction(out);
}

scene::TransferFunction scaled(const scene::TransferFunction& transfer_function, double factor) {
  std::vector<scene::Knot> knots(transfer_function.knots().begin(), transfer_function.knots().end());
  for (scene::Knot& k : knots) k.extinction *= factor;
  return scene::TransferFunction(knots);
}

scene::TransferFunction benchmark_transfer_function() {
  return scene::TransferFunction({{0.0, {0.0, 0.0, 0.3}, 0.0},
                                  {0.3, {0.1, 0.3, 0.9}, 0.4},
                                  {0.5, {0.2, 0.9, 0.3}, 0.0},
                                  {0.7, {0.9, 0.8, 0.1}, 3.0},
                                  {0.8, {1.0, 0.3, 0.0}, 0.2},
                                  {1.0, {1.0, 1.0, 1.0}, 8.0}});
}

}  // namespace tessera::datasets
