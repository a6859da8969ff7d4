// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "cells/cell_block.hpp"
#include "cells/curved/curved_cells.hpp"
#include "cells/field_choice.hpp"
#include "cells/field_summary.hpp"
#include "scene/camera.hpp"
#include "tessera/read_options.hpp"

namespace tessera::cells {

/// Histogram of the deviations of higher-order cells' initial tets. Bin b counts tets whose edges deviate by 2^(b/2)
/// times the tolerance; the first bin also counts smaller deviations. The histograms of parts of a mesh can be added.
using ExcessTally = std::array<std::uint64_t, 128>;

/// Returns the box of the points of blocks with higher-order cells; low > high if there are none.
scene::Box higher_order_box(std::span<const CellBlock> blocks);
scene::Box joined(const scene::Box& a, const scene::Box& b);

/// Returns the settings requested for a mesh. The tolerance is in the units of the mesh, computed from its box and the
/// range of its field.
CurvedSettings asked_tolerance(const ReadOptions& options, const scene::Box& box, const FieldChoice& choice,
                               std::span<const FieldSummary> fields);

/// Tallies the deviations of the higher-order cells of some blocks, as multiples of the tolerance of `asked`.
ExcessTally tally_excess(std::span<const CellBlock> blocks, const FieldChoice& choice, const CurvedSettings& asked);

/// Returns the approximate default limit of the number of a mesh's tets. It is 2^18 plus twice the number of tets that
/// are required if the worst 48 of the initial tets are ignored, but at most the larger of 2^21 and four times the
/// initial number. 48 tets may meet at one damaged node, which may be so far away that they use the whole limit.
std::uint64_t usual_tets(const ExcessTally& tally);

/// Returns the factor, a power of the square root of 2, by which the tolerance must grow so that at most about
/// `most_tets` tets are made. The error decreases with the square of a tet's size.
double tolerance_factor(const ExcessTally& tally, std::uint64_t most_tets);

/// The complete plan for a mesh that is read as a whole.
struct HigherOrderPlan {
  CurvedSettings settings;
  double tolerance = 0;  ///< relative tolerance, like ReadOptions::higher_order_tolerance
};
HigherOrderPlan plan_higher_order(std::span<const CellBlock> blocks, const ReadOptions& options,
                                  const FieldChoice& choice, std::span<const FieldSummary> fields);

/// Returns the plan for a mesh in parts, given the combined results of all parts.
HigherOrderPlan planned(const ReadOptions& options, const CurvedSettings& asked, const ExcessTally& tally);

}  // namespace tessera::cells
