#include "io/higher_order_plan.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>

namespace tessera::io {
namespace {

constexpr scene::Box no_box{glm::dvec3(std::numeric_limits<double>::infinity()),
                            glm::dvec3(-std::numeric_limits<double>::infinity())};

}  // namespace

scene::Box higher_order_box(std::span<const CellBlock> blocks) {
  scene::Box box = no_box;
  if (std::none_of(blocks.begin(), blocks.end(), has_curved_cells)) return box;
  for (const CellBlock& block : blocks)
    for (const glm::dvec3& p : block.positions)
      if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z))
        box.low = glm::min(box.low, p), box.high = glm::max(box.high, p);
  return box;
}

scene::Box joined(const scene::Box& a, const scene::Box& b) {
  return {glm::min(a.low, b.low), glm::max(a.high, b.high)};
}

CurvedSettings asked_tolerance(const MeshOptions& options, const scene::Box& box, const FieldChoice& choice,
                               std::span<const FieldSummary> fields) {
  CurvedSettings asked;
  if (box.low.x > box.high.x || options.higher_order_tets == 0) return asked;
  asked.limit = std::numeric_limits<std::size_t>::max();
  const double diagonal = glm::length(box.high - box.low);
  if (diagonal > 0) asked.tolerance.position = options.higher_order_tolerance * diagonal;
  const auto summary = std::find_if(fields.begin(), fields.end(), [&](const FieldSummary& s) {
    return s.name == choice.name && s.association == choice.association;
  });
  if (summary == fields.end() || choice.association != scene::Association::point) return asked;
  // Of one component of a vector the lengths' range says only that it lies within them, either sign.
  const double range =
      summary->components > 1 && choice.component != magnitude ? 2 * summary->high : summary->high - summary->low;
  if (range > 0) asked.tolerance.field = options.higher_order_tolerance * range;
  return asked;
}

ExcessTally tally_excess(std::span<const CellBlock> blocks, const FieldChoice& choice, const CurvedSettings& asked) {
  ExcessTally tally{};
  if (asked.limit == 0) return tally;
  std::vector<double> values;
  for (const CellBlock& block : blocks) {
    if (!has_curved_cells(block)) continue;
    values.clear();
    const BlockField* const field = find_field(block, choice.name, choice.association);
    if (choice.association == scene::Association::point && field != nullptr) {
      values.resize(block.positions.size());
      field->read(std::min(choice.component, field->components - 1), 0, values);
    }
    const CurvedCells cells(block, block.positions, values, choice.association, asked);
    cells.tally_excess([&](double excess) {
      const double bin = excess > 1 ? std::min(2 * std::log2(excess), static_cast<double>(tally.size() - 1)) : 0;
      ++tally[static_cast<std::size_t>(bin)];
    });
  }
  return tally;
}

double tolerance_factor(const ExcessTally& tally, std::uint64_t most_tets) {
  for (std::size_t step = 0; step < tally.size(); ++step) {
    double tets = 0;
    for (std::size_t bin = 0; bin < tally.size(); ++bin) {
      const double excess = std::exp2((static_cast<double>(bin) + 0.5 - static_cast<double>(step)) / 2);
      tets += static_cast<double>(tally[bin]) * (bin <= step ? 1 : excess * std::sqrt(excess));
    }
    if (tets <= static_cast<double>(most_tets)) return std::exp2(static_cast<double>(step) / 2);
  }
  return std::exp2(static_cast<double>(tally.size()) / 2);
}

HigherOrderPlan planned(const MeshOptions& options, const CurvedSettings& asked, const ExcessTally& tally) {
  HigherOrderPlan plan{asked, 0};
  if (asked.limit == 0) return plan;
  const double factor = tolerance_factor(tally, options.higher_order_tets);
  plan.tolerance = factor * options.higher_order_tolerance;
  plan.settings.tolerance.position *= factor;
  plan.settings.tolerance.field *= factor;
  plan.settings.limit = std::max<std::size_t>(options.higher_order_tets / 2 * 3, 1 << 16);
  return plan;
}

HigherOrderPlan plan_higher_order(std::span<const CellBlock> blocks, const MeshOptions& options,
                                  const FieldChoice& choice, std::span<const FieldSummary> fields) {
  const CurvedSettings asked = asked_tolerance(options, higher_order_box(blocks), choice, fields);
  return planned(options, asked, tally_excess(blocks, choice, asked));
}

}  // namespace tessera::io
