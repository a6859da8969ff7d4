// SPDX-License-Identifier: BSD-3-Clause
#include "frame/ranks/curved_parts.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <vector>

#include "cells/curved/higher_order_plan.hpp"
#include "cells/duplicate_cells.hpp"
#include "exchange/collectives.hpp"
#include "frame/ranks/shared_repetitions.hpp"

namespace tessera::frame {
namespace {

using exchange::MessageKind;

constexpr double infinite = std::numeric_limits<double>::infinity();

/// Facts of a rank's part.
struct Part {
  scene::Box box;  ///< io::higher_order_box()
  double low = infinite, high = -infinite;
  double tolerance = 0;
  std::uint64_t most_tets = 0;
};
static_assert(sizeof(Part) == 80);

struct Became {
  MeshCounts counts;
  HigherOrderCells higher_order;
};

cells::HigherOrderPlan plan_together(exchange::Transport& transport, std::span<const cells::CellBlock> blocks,
                                     ReadOptions options, cells::FieldChoice choice,
                                     std::span<const cells::FieldSummary> fields) {
  Part whole{cells::higher_order_box(blocks), infinite, -infinite, options.higher_order_tolerance,
             options.higher_order_tets};
  if (!fields.empty() && fields.front().low <= fields.front().high)
    whole.low = fields.front().low, whole.high = fields.front().high;
  for (const Part& part : exchange::gather_values(transport, MessageKind::curved_part, whole)) {
    whole.box = cells::joined(whole.box, part.box);
    whole.low = std::min(whole.low, part.low), whole.high = std::max(whole.high, part.high);
    whole.tolerance = std::min(whole.tolerance, part.tolerance);
    whole.most_tets = std::min(whole.most_tets, part.most_tets);
  }
  options.higher_order_tolerance = whole.tolerance, options.higher_order_tets = whole.most_tets;
  cells::FieldSummary field;
  if (!fields.empty()) field = fields.front();
  field.name = choice.name, field.association = choice.association;
  field.low = whole.low, field.high = whole.high;
  const cells::CurvedSettings asked = cells::asked_tolerance(options, whole.box, choice, std::span(&field, 1));
  cells::ExcessTally tally{};
  for (const cells::ExcessTally& part :
       exchange::gather_values(transport, MessageKind::higher_order, cells::tally_excess(blocks, choice, asked)))
    for (std::size_t bin = 0; bin < part.size(); ++bin) tally[bin] += part[bin];
  return cells::planned(options, asked, tally);
}

}  // namespace

ArrayMesh mesh_of_part(const MeshArrays& part, exchange::Transport& transport) {
  ArrayMesh mesh = mesh_of_arrays(part, true,
                                  [&](std::span<const cells::CellBlock> blocks, const ReadOptions& options,
                                      const cells::FieldChoice& choice, std::span<const cells::FieldSummary> fields) {
                                    return plan_together(transport, blocks, options, choice, fields);
                                  });
  std::vector<int> ranks(static_cast<std::size_t>(transport.size()));
  std::iota(ranks.begin(), ranks.end(), 0);
  mesh.counts.cells_duplicate = count_shared_repetitions(transport, cells::duplicate_keys(mesh.mesh), ranks);
  const Became own{mesh.counts, mesh.higher_order};
  mesh.counts = {}, mesh.higher_order = {};
  for (const Became& other : exchange::gather_values(transport, MessageKind::curved_part, own)) {
    mesh.counts += other.counts;
    mesh.higher_order += other.higher_order;
  }
  return mesh;
}

}  // namespace tessera::frame
