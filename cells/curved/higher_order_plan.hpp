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

/// Histogram of the deviation of higher-order cells' initial tets: bin b counts tets whose edges deviate by 2^(b/2)
/// tolerances; the first bin includes smaller deviations. Bins of several parts add up.
using ExcessTally = std::array<std::uint64_t, 128>;

/// The box of the points of blocks with higher-order cells; low > high if there are none.
scene::Box higher_order_box(std::span<const CellBlock> blocks);
scene::Box joined(const scene::Box& a, const scene::Box& b);

/// The settings requested for a mesh: the tolerance in the mesh's units, from its box and its field's range.
CurvedSettings asked_tolerance(const ReadOptions& options, const scene::Box& box, const FieldChoice& choice,
                               std::span<const FieldSummary> fields);

/// Deviations of the higher-order cells of some blocks, in tolerances of `asked`.
ExcessTally tally_excess(std::span<const CellBlock> blocks, const FieldChoice& choice, const CurvedSettings& asked);

/// Approximate default limit of a mesh's tets: 2^18 plus twice the number required without the worst 48 of its initial
/// tets, but at most 2^21 or four times the initial number, whichever is more. A damaged node may be so far away that
/// the cells around it use the whole limit.
std::uint64_t usual_tets(const ExcessTally& tally);

/// The factor, a power of the square root of 2, by which the tolerance must grow so that no more than about `most_tets`
/// are made. The error decreases with the square of a tet's size.
double tolerance_factor(const ExcessTally& tally, std::uint64_t most_tets);

/// The complete plan for a mesh that is not in parts.
struct HigherOrderPlan {
  CurvedSettings settings;
  double tolerance = 0;  ///< relative, like ReadOptions::higher_order_tolerance
};
HigherOrderPlan plan_higher_order(std::span<const CellBlock> blocks, const ReadOptions& options,
                                  const FieldChoice& choice, std::span<const FieldSummary> fields);

/// The same, from the results of the parts of a mesh.
HigherOrderPlan planned(const ReadOptions& options, const CurvedSettings& asked, const ExcessTally& tally);

}  // namespace tessera::cells
