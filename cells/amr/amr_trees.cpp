// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <unordered_map>

#include "cells/amr/amr_leaves.hpp"
#include "cells/amr/amr_vertices.hpp"
#include "scene/error.hpp"

namespace tessera::cells {
namespace {

std::string piece_words(const AmrBlock& part, const std::string& source) {
  return part.name.empty() ? source : fmt::format("{}: piece '{}'", source, part.name);
}

scene::Error unfit(const AmrBlock& part, const std::string& source) {
  return scene::bad_input(fmt::format("{}: its trees do not match its grid; the file is damaged, write it again",
                                      piece_words(part, source)));
}

std::int64_t roots_along(const AmrBlock& part, std::size_t axis) { return part.extent[2 * axis + 1]; }

std::vector<double> coordinates_of(const AmrBlock& trees, std::size_t axis, const std::string& source) {
  std::vector<double> at = trees.coordinates(axis);
  if (at.size() < 2 || static_cast<std::int64_t>(at.size()) != roots_along(trees, axis) + 1) throw unfit(trees, source);
  return at;
}

/// Returns the number of finest cells along one of the coarsest cells.
std::int32_t steps_of(const AmrBlock& part, int levels, const std::string& source) {
  double steps = 1;
  for (int level = 1; level < levels && steps <= most_amr_corners; ++level) steps *= part.branching;
  for (std::size_t a = 0; a < 3; ++a)
    if (!(static_cast<double>(roots_along(part, a)) * steps <= most_amr_corners))
      throw scene::bad_input(
          fmt::format("{}: its finest level would be {} cells long, but the limit is {}; leave out levels",
                      piece_words(part, source), static_cast<double>(roots_along(part, a)) * steps, most_amr_corners));
  return static_cast<std::int32_t>(steps);
}

/// Throws unless all corners of cells along an axis are distinct and ascending.
void require_rising(std::span<const double> at, std::int32_t steps, std::size_t axis, const std::string& source) {
  for (std::size_t n = 0; n + 1 < at.size(); ++n) {
    const double size = std::max(std::abs(at[n]), std::abs(at[n + 1])), step = (at[n + 1] - at[n]) / steps;
    if (!std::isfinite(at[n]) || !std::isfinite(at[n + 1]) ||
        !(step > 4 * std::numeric_limits<double>::epsilon() * size))
      throw scene::bad_input(
          fmt::format("{}: its coordinates along {} go from {} to {}, which is too short for {} cells of the finest "
                      "level; give increasing coordinates, or fewer levels",
                      source, "xyz"[axis], at[n], at[n + 1], steps));
  }
}

/// Finds the leaves, part by part.
class TreeLeaves {
 public:
  TreeLeaves(AmrLeaves& amr, bool several, const std::string& source) : amr_(amr), source_(source), several_(several) {}

  void add(const AmrBlock& part, const std::array<std::int64_t, 3>& grid) {
    const std::optional<AmrTreeLeaves> read = part.leaves();
    if (!read) throw unfit(part, source_);
    const auto& [lows, levels] = *read;
    if (lows.size() != 3 * levels.size() || levels.size() > std::numeric_limits<std::uint32_t>::max())
      throw unfit(part, source_);
    const std::vector<std::uint8_t> ghost = part.ghosts(levels.size());
    // Size of the part's finest cells; it is not 1 if other parts have deeper trees.
    const std::int32_t scale = amr_.size[static_cast<std::size_t>(part.levels) - 1];
    const auto number = static_cast<std::uint32_t>(amr_.parts.size());
    amr_.parts.push_back({.name = part.name});
    for (std::size_t l = 0; l < levels.size(); ++l) {
      if (!ghost.empty() && amr_.leaves_out(ghost[l])) continue;
      if (levels[l] >= part.levels) throw unfit(part, source_);
      AmrLeaf leaf{{}, static_cast<std::uint32_t>(l), number, levels[l]};
      const std::int32_t size = amr_.size[levels[l]];
      for (std::size_t a = 0; a < 3; ++a) {
        const std::int64_t low = std::int64_t{lows[3 * l + a]} * scale;
        if (low < 0 || low % size != 0 || low + size > grid[a] * amr_.size[0]) throw unfit(part, source_);
        leaf.low[a] = static_cast<std::int32_t>(low);
      }
      require_new(leaf, grid, part);
      amr_.leaves.push_back(leaf);
    }
  }

 private:
  /// Throws if two leaves begin at the same place, or if two parts contain the same tree.
  void require_new(const AmrLeaf& leaf, const std::array<std::int64_t, 3>& grid, const AmrBlock& part) {
    if (several_) require_own_tree(leaf, grid, part);
    if (lows_.add(leaf.low) != amr_.leaves.size()) throw unfit(part, source_);
  }

  void require_own_tree(const AmrLeaf& leaf, const std::array<std::int64_t, 3>& grid, const AmrBlock& part) {
    std::int64_t root = 0;
    for (std::size_t a = 3; a-- > 0;) root = root * grid[a] + leaf.low[a] / amr_.size[0];
    const auto [owner, is_new] = owners_.emplace(root, leaf.part);
    if (!is_new && owner->second != leaf.part)
      throw scene::bad_input(
          fmt::format("{}: cell {} of its grid is also in piece '{}'; write each tree once, or mark "
                      "ghosts by vtkGhostType",
                      piece_words(part, source_), root, amr_.parts[owner->second].name));
  }

  AmrLeaves& amr_;
  const std::string& source_;
  bool several_;
  AmrVertices lows_;
  std::unordered_map<std::int64_t, std::uint32_t> owners_;  ///< the part that contains each tree
};

}  // namespace

AmrLeaves leaves_of_trees(std::span<const AmrBlock> trees, const std::string& source) {
  AmrLeaves amr;
  const AmrBlock& first = trees.front();
  int levels = 1;
  for (const AmrBlock& part : trees) {
    if (part.levels < 1 || part.levels > 64 || part.branching < 2) throw unfit(part, source);
    if (part.branching != first.branching || part.extent != first.extent)
      throw scene::bad_input(
          fmt::format("{}: its grid differs from that of piece '{}'; write all pieces from the same data set",
                      piece_words(part, source), first.name));
    levels = std::max(levels, part.levels);
  }
  amr.size.assign(static_cast<std::size_t>(levels), 1);
  amr.lattice.coarsest = steps_of(first, levels, source);
  for (std::size_t level = amr.size.size() - 1; level-- > 0;) amr.size[level] = amr.size[level + 1] * first.branching;
  std::array<std::int64_t, 3> grid{};
  for (std::size_t a = 0; a < 3; ++a) {
    grid[a] = roots_along(first, a);
    amr.lattice.corners[a] = coordinates_of(trees.front(), a, source);
    require_rising(amr.lattice.corners[a], amr.lattice.coarsest, a, source);
    for (std::size_t p = 1; p < trees.size(); ++p)
      if (coordinates_of(trees[p], a, source) != amr.lattice.corners[a])
        throw scene::bad_input(fmt::format(
            "{}: its coordinates along {} differ from those of piece '{}'; write all pieces from the same data set",
            piece_words(trees[p], source), "xyz"[a], first.name));
  }
  TreeLeaves leaves(amr, trees.size() > 1, source);
  for (const AmrBlock& block : trees) leaves.add(block, grid);
  return amr;
}

}  // namespace tessera::cells
