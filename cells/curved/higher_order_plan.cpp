// SPDX-License-Identifier: BSD-3-Clause
#include "cells/curved/higher_order_plan.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>
#include <vector>

namespace tessera::cells {
namespace {

constexpr scene::Box no_box{glm::dvec3(std::numeric_limits<double>::infinity()),
                            glm::dvec3(-std::numeric_limits<double>::infinity())};

/// An error of the position, relative to the diagonal, changes pixels at rays along a surface about four times as much
/// as the same error of the field relative to its range. For a block of quadratic hexahedra, a relative position
/// tolerance of a quarter of the relative field tolerance needs the fewest tets for a given error.
constexpr double position_share = 0.25;

constexpr std::uint64_t unlimited = std::numeric_limits<std::uint64_t>::max();

/// Estimates the number of tets that an initial tet of a bin becomes if the tolerance is 2^(step/2) times as large.
double tets_of(std::size_t bin, std::size_t step) {
  const double excess = std::exp2((static_cast<double>(bin) + 0.5 - static_cast<double>(step)) / 2);
  return bin <= step ? 1 : excess * std::sqrt(excess);
}

/// Calls `use` with the higher-order cells of each block that has any.
template <class Use>
void for_curved_cells(std::span<const CellBlock> blocks, const FieldChoice& choice, const CurvedSettings& settings,
                      const Use& use) {
  if (settings.limit == 0) return;
  std::vector<double> values;
  for (const CellBlock& block : blocks) {
    if (!has_curved_cells(block)) continue;
    values.clear();
    const BlockField* const field = find_field(block, choice.name, choice.association);
    if (choice.association == scene::Association::point && field != nullptr) {
      values.resize(block.positions.size());
      field->read(std::min(choice.component, field->components - 1), 0, values);
    }
    use(CurvedCells(block, block.positions, values, choice.association, settings));
  }
}

/// Up to eight cells of six tets each meet at a node, and a folded cell takes about eight times the predicted tets.
bool may_take_too_many(const ReadOptions& options, const HigherOrderPlan& plan, const ExcessTally& tally) {
  std::size_t worst = tally.size() - 1;
  while (worst > 0 && tally[worst] == 0) --worst;
  const double excess = std::exp2((static_cast<double>(worst) + 0.5) / 2) * options.higher_order_tolerance;
  return 6 * 8 * 8 * std::pow(excess / plan.tolerance, 1.5) >= static_cast<double>(plan.settings.limit);
}

/// Whether dividing all cells takes about a second: the time per tet grows with the number of nodes of its cell.
bool is_quickly_divided(std::span<const CellBlock> blocks, const HigherOrderPlan& plan, const ExcessTally& tally) {
  constexpr std::uint64_t few_tets = 48;
  constexpr std::size_t most_nodes_of_tets = 1 << 24;
  std::size_t nodes = 1;
  for (const CellBlock& block : blocks)
    for (std::size_t c = 0; c < block.types.size(); ++c)
      nodes = std::max<std::size_t>(nodes, block.offsets[c + 1] - block.offsets[c]);
  return std::accumulate(tally.begin(), tally.end(), std::uint64_t{0}) <= few_tets &&
         plan.settings.limit <= most_nodes_of_tets / nodes;
}

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

CurvedSettings asked_tolerance(const ReadOptions& options, const scene::Box& box, const FieldChoice& choice,
                               std::span<const FieldSummary> fields) {
  CurvedSettings asked;
  if (box.low.x > box.high.x || options.higher_order_tets == 0) return asked;
  asked.limit = std::numeric_limits<std::size_t>::max();
  const double diagonal = glm::length(box.high - box.low);
  if (diagonal > 0) asked.tolerance.position = position_share * options.higher_order_tolerance * diagonal;
  const auto summary = std::find_if(fields.begin(), fields.end(), [&](const FieldSummary& s) {
    return s.name == choice.name && s.association == choice.association;
  });
  if (summary == fields.end() || choice.association != scene::Association::point) return asked;
  // For one component of a vector, only a bound of the absolute value is known: the range of the lengths.
  const double range =
      summary->components > 1 && choice.component != magnitude ? 2 * summary->high : summary->high - summary->low;
  if (range > 0) asked.tolerance.field = options.higher_order_tolerance * range;
  return asked;
}

ExcessTally tally_excess(std::span<const CellBlock> blocks, const FieldChoice& choice, const CurvedSettings& asked) {
  ExcessTally tally{};
  for_curved_cells(blocks, choice, asked, [&](const CurvedCells& cells) {
    cells.tally_excess([&](double excess) {
      const double bin = excess > 1 ? std::min(2 * std::log2(excess), static_cast<double>(tally.size() - 1)) : 0;
      ++tally[static_cast<std::size_t>(bin)];
    });
  });
  return tally;
}

std::uint64_t usual_tets(const ExcessTally& tally) {
  constexpr double least = 1 << 18, most = 1 << 21;
  std::uint64_t outliers = 48;  // eight hexahedra of six tets each meet at a node
  double tets = 0, first = 0;
  for (std::size_t bin = tally.size(); bin-- > 0;) {
    const std::uint64_t left_out = std::min(outliers, tally[bin]);
    outliers -= left_out;
    tets += static_cast<double>(tally[bin] - left_out) * tets_of(bin, 0);
    first += static_cast<double>(tally[bin]);
  }
  return static_cast<std::uint64_t>(std::min(std::max(most, 4 * first), least + 2 * tets));
}

double tolerance_factor(const ExcessTally& tally, std::uint64_t most_tets) {
  for (std::size_t step = 0; step < tally.size(); ++step) {
    double tets = 0;
    for (std::size_t bin = 0; bin < tally.size(); ++bin) tets += static_cast<double>(tally[bin]) * tets_of(bin, step);
    if (tets <= static_cast<double>(most_tets)) return std::exp2(static_cast<double>(step) / 2);
  }
  return std::exp2(static_cast<double>(tally.size()) / 2);
}

HigherOrderPlan planned(const ReadOptions& options, const CurvedSettings& asked, const ExcessTally& tally) {
  HigherOrderPlan plan{asked, 0};
  if (asked.limit == 0) return plan;
  const bool is_chosen = options.higher_order_tets != default_higher_order_tets;
  const std::uint64_t most = is_chosen ? options.higher_order_tets : usual_tets(tally);
  const double factor = tolerance_factor(tally, most);
  plan.settings.is_chosen = is_chosen;
  plan.tolerance = factor * options.higher_order_tolerance;
  plan.settings.tolerance.position *= factor;
  plan.settings.tolerance.field *= factor;
  // The plan predicts the number of tets within a factor of three, except for the folded cells of a damaged file.
  // Unless the user chose the number, twice the predicted number must be enough.
  plan.settings.limit = std::max<std::size_t>(most / 2 * 3, 1 << 16);
  const std::uint64_t all = std::max(std::min(most, unlimited / 8) * 3, std::uint64_t{1} << 17);
  plan.settings.all = is_chosen ? all : std::min(all, std::max(2 * most, std::uint64_t{1} << 22));
  return plan;
}

HigherOrderPlan plan_higher_order(std::span<const CellBlock> blocks, const ReadOptions& options,
                                  const FieldChoice& choice, std::span<const FieldSummary> fields) {
  const CurvedSettings asked = asked_tolerance(options, higher_order_box(blocks), choice, fields);
  const ExcessTally tally = tally_excess(blocks, choice, asked);
  HigherOrderPlan plan = planned(options, asked, tally);
  if (plan.tolerance == 0 || !may_take_too_many(options, plan, tally) || !is_quickly_divided(blocks, plan, tally))
    return plan;
  const auto takes_too_many = [&] {
    bool is_over = false;
    for_curved_cells(blocks, choice, plan.settings,
                     [&](const CurvedCells& cells) { is_over = is_over || cells.take_too_many(); });
    return is_over;
  };
  for (int tries = 0; tries < 20 && takes_too_many(); ++tries) {
    plan.settings.tolerance.position *= 2, plan.settings.tolerance.field *= 2;
    plan.tolerance *= 2;
  }
  return plan;
}

}  // namespace tessera::cells
