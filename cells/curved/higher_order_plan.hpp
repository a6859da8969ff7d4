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

/// How far the first tets of higher-order cells are off: of each bin b the number of tets whose edges are off by
/// 2^(b/2) tolerances, the first bin's by less too. Bins of several parts add up.
using ExcessTally = std::array<std::uint64_t, 128>;

/// The box of the points of blocks with higher-order cells; low > high if there is none.
scene::Box higher_order_box(std::span<const CellBlock> blocks);
scene::Box joined(const scene::Box& a, const scene::Box& b);

/// What is asked for of a mesh: the tolerance in the mesh's units, by its box and its field's range.
CurvedSettings asked_tolerance(const ReadOptions& options, const scene::Box& box, const FieldChoice& choice,
                               std::span<const FieldSummary> fields);

/// How far the higher-order cells of some blocks are off, in tolerances of `asked`.
ExcessTally tally_excess(std::span<const CellBlock> blocks, const FieldChoice& choice, const CurvedSettings& asked);

/// About how many tets a mesh may become where nobody says: 2^18, and twice as many as it takes without the worst 48 of
/// its first tets, at most 2^21 or four times the first, whichever is more. A damaged node may be so far away that the
/// cells around it take all there may be.
std::uint64_t usual_tets(const ExcessTally& tally);

/// The factor by which the tolerance has to be larger, a power of the root of 2, so that no more than about
/// `most_tets` are made. The error falls with the square of a tet's size.
double tolerance_factor(const ExcessTally& tally, std::uint64_t most_tets);

/// All of it for a mesh that is whole.
struct HigherOrderPlan {
  CurvedSettings settings;
  double tolerance = 0;  ///< relative, as ReadOptions::higher_order_tolerance
};
HigherOrderPlan plan_higher_order(std::span<const CellBlock> blocks, const ReadOptions& options,
                                  const FieldChoice& choice, std::span<const FieldSummary> fields);

/// The same from what the parts of a mesh have found.
HigherOrderPlan planned(const ReadOptions& options, const CurvedSettings& asked, const ExcessTally& tally);

}  // namespace tessera::cells
