// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include "scene/transfer_function.hpp"

/// Transfer functions for tests and benchmarks. Colours are in [0, 1], values in `range`; the same arguments give the
/// same bits.
namespace tessera::datasets {

/// Returns a continuous function with `knots` knots (>= 1) at non-uniform values from end to end of the range, and
/// extinctions up to `extinction`. About a quarter of the knots, sometimes two in a row, have zero extinction, so that
/// some cells are invisible.
scene::TransferFunction smooth_knots(int knots, std::array<double, 2> range = {0, 1}, double extinction = 4,
                                     std::uint64_t seed = 1);

/// Returns a piecewise constant function: `steps` steps (>= 1), hence 2 * steps knots, at non-uniform values inside the
/// range; constant outside.
scene::TransferFunction step_knots(int steps, std::array<double, 2> range = {0, 1}, double extinction = 4,
                                   std::uint64_t seed = 1);

/// Returns a function with every extinction multiplied by `factor`: optically thin to thick, or the inverse of a mesh's
/// scale.
scene::TransferFunction scaled(const scene::TransferFunction& transfer_function, double factor);

/// Returns the six knots used by all performance figures of bench/, for a field in [0, 1]: a blue haze, an orange
/// shell, a white core.
scene::TransferFunction benchmark_transfer_function();

}  // namespace tessera::datasets
