// SPDX-License-Identifier: BSD-3-Clause
#include "cells/amr/amr_leaves.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "cells/ghost_bits.hpp"
#include "scene/error.hpp"

namespace tessera::cells {
namespace {

constexpr double most_corners = most_amr_corners;

struct Box {
  AmrIndex low, high;

  [[nodiscard]] bool meets(const Box& o) const {
    for (std::size_t a = 0; a < 3; ++a)
      if (high[a] <= o.low[a] || low[a] >= o.high[a]) return false;
    return true;
  }
  [[nodiscard]] bool holds(const Box& o) const {
    for (std::size_t a = 0; a < 3; ++a)
      if (o.low[a] < low[a] || o.high[a] > high[a]) return false;
    return true;
  }
};

Box cell_box(const AmrIndex& low, std::int32_t size) { return {low, {low[0] + size, low[1] + size, low[2] + size}}; }

std::string where(const AmrBlock& part, const std::string& source) {
  return part.name.empty() ? source : fmt::format("{}: block '{}'", source, part.name);
}

/// Number of cells along an axis.
std::int64_t cells_along(const AmrBlock& part, std::size_t axis) {
  return part.extent[2 * axis + 1] - part.extent[2 * axis];
}

double low_end(const AmrBlock& part, std::size_t axis) {
  return part.origin[axis] + part.spacing[axis] * static_cast<double>(part.extent[2 * axis]);
}

void require_block(const AmrBlock& part, const std::string& source) {
  const std::string name = where(part, source);
  if (!part.is_image)
    throw scene::bad_input(
        fmt::format("{}: a block of an AMR mesh has to be image data; write it as image data", name));
  constexpr std::array<double, 9> unturned{1, 0, 0, 0, 1, 0, 0, 0, 1};
  if (part.direction != unturned)
    throw scene::bad_input(fmt::format(
        "{}: it is rotated, but blocks of AMR meshes must be aligned with the axes; write it without the rotation",
        name));
  for (std::size_t a = 0; a < 3; ++a) {
    if (cells_along(part, a) < 1)
      throw scene::bad_input(
          fmt::format("{}: it is flat, so it has no volume cells; give a three-dimensional mesh", name));
    if (!(part.spacing[a] > 0) || !std::isfinite(part.spacing[a]) || !std::isfinite(low_end(part, a)))
      throw scene::bad_input(
          fmt::format("{}: its spacing along {} is {} and its origin {}; give finite numbers, with spacings above 0",
                      name, "xyz"[a], part.spacing[a], part.origin[a]));
  }
}

/// Returns one block for each distinct spacing, from the coarsest to the finest.
std::vector<const AmrBlock*> distinct_levels(std::span<const AmrBlock> blocks) {
  std::vector<const AmrBlock*> levels;
  for (const AmrBlock& block : blocks) levels.push_back(&block);
  std::stable_sort(levels.begin(), levels.end(),
                   [](const AmrBlock* a, const AmrBlock* b) { return a->spacing[0] > b->spacing[0]; });
  const auto same = [](const AmrBlock* a, const AmrBlock* b) { return b->spacing[0] > 0.9 * a->spacing[0]; };
  levels.erase(std::unique(levels.begin(), levels.end(), same), levels.end());
  return levels;
}

/// Returns the size of each level's cells on the lattice of the finest level.
std::vector<std::int32_t> level_sizes(std::span<const AmrBlock* const> levels, const std::string& source) {
  std::vector<std::int32_t> size(levels.size(), 1);
  for (std::size_t l = levels.size() - 1; l-- > 0;) {
    const auto &coarse = levels[l]->spacing, &fine = levels[l + 1]->spacing;
    const double ratio = std::round(coarse[0] / fine[0]);
    for (std::size_t a = 0; a < 3; ++a)
      if (!(std::abs(coarse[a] / fine[a] - ratio) <= 1e-3 * ratio))
        throw scene::bad_input(
            fmt::format("{}: cells of level {} are {} times as long as those of the next level along {}, and {} times "
                        "along x; only whole ratios that are the same along all axes are supported",
                        source, l, coarse[a] / fine[a], "xyz"[a], ratio));
    const double steps = ratio * size[l + 1];
    if (ratio > 64 || steps > most_corners)
      throw scene::bad_input(
          fmt::format("{}: cells of level {} are {} times as long as those of the next level, but only ratios up to 64 "
                      "are supported; write the levels between",
                      source, l, ratio));
    size[l] = static_cast<std::int32_t>(steps);
  }
  return size;
}

scene::Error too_long(double cells, const std::string& source) {
  return scene::bad_input(
      fmt::format("{}: its finest level would be {} cells long, but the limit is {}; leave out levels", source, cells,
                  most_corners));
}

/// Places the blocks on the lattice.
void place_blocks(std::span<const AmrBlock> blocks, AmrLeaves& amr, std::span<const AmrBlock* const> levels,
                  const std::string& source) {
  glm::dvec3 anchor;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<int>(a);
    amr.lattice.spacing[axis] = levels[0]->spacing[a] / amr.size[0];
    anchor[axis] = low_end(*levels[0], a);
  }
  std::array<std::int64_t, 3> first{}, last{};
  std::vector<std::array<std::int64_t, 3>> lows;
  for (const AmrBlock& part : blocks) {
    AmrLeaves::Part placed{.name = part.name};
    while (part.spacing[0] <= 0.9 * levels[static_cast<std::size_t>(placed.level)]->spacing[0]) ++placed.level;
    const std::int32_t size = amr.size[static_cast<std::size_t>(placed.level)];
    std::array<std::int64_t, 3> low{};
    for (std::size_t a = 0; a < 3; ++a) {
      const auto axis = static_cast<int>(a);
      const double own = amr.lattice.spacing[axis] * size, at = (low_end(part, a) - anchor[axis]) / own;
      if (!(std::abs(part.spacing[a] / own - 1) <= 1e-3))
        throw scene::bad_input(
            fmt::format("{}: its spacing along {} is {}, but that of its level is {}; write the file again",
                        where(part, source), "xyz"[a], part.spacing[a], own));
      if (!(std::abs(at) * size < most_corners)) throw too_long(std::abs(at) * size, source);
      if (!(std::abs(at - std::round(at)) < 0.02))
        throw scene::bad_input(
            fmt::format("{}: it begins {} cells of its level from the coarsest block along {}, but this distance has "
                        "to be a whole number of cells; write the file again",
                        where(part, source), at, "xyz"[a]));
      low[a] = std::llround(at) * size;
      const std::int64_t high = cells_along(part, a) < most_corners ? low[a] + cells_along(part, a) * size : INT64_MAX;
      first[a] = std::min(first[a], low[a]), last[a] = std::max(last[a], high);
      if (static_cast<double>(last[a]) - static_cast<double>(first[a]) > most_corners)
        throw too_long(static_cast<double>(last[a]) - static_cast<double>(first[a]), source);
      placed.cells[a] = static_cast<std::int32_t>(cells_along(part, a));
    }
    if (static_cast<double>(placed.cells[0]) * placed.cells[1] * placed.cells[2] >
        std::numeric_limits<std::uint32_t>::max())
      throw scene::bad_input(
          fmt::format("{}: more than 2^32 cells in one block are too many; divide it", where(part, source)));
    lows.push_back(low);
    amr.parts.push_back(placed);
  }
  for (std::size_t a = 0; a < 3; ++a)
    amr.lattice.origin[static_cast<int>(a)] =
        anchor[static_cast<int>(a)] + amr.lattice.spacing[static_cast<int>(a)] * static_cast<double>(first[a]);
  for (std::size_t p = 0; p < lows.size(); ++p)
    for (std::size_t a = 0; a < 3; ++a) amr.parts[p].low[a] = static_cast<std::int32_t>(lows[p][a] - first[a]);
}

/// Finds the leaves, block by block.
class Coverage {
 public:
  Coverage(AmrLeaves& amr, const std::string& source) : amr_(amr), source_(source) {
    for (const AmrLeaves::Part& part : amr.parts) {
      Box box{part.low, part.low};
      for (std::size_t a = 0; a < 3; ++a) box.high[a] += part.cells[a] * size_of_level(part.level);
      boxes_.push_back(box);
    }
    order_.resize(boxes_.size());
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::stable_sort(order_.begin(), order_.end(),
                     [&](std::size_t a, std::size_t b) { return boxes_[a].low[0] < boxes_[b].low[0]; });
  }

  void add_leaves(std::size_t p, std::span<const std::uint8_t> ghost) {
    const AmrLeaves::Part& part = amr_.parts[p];
    const std::int32_t size = size_of_level(part.level);
    find_covering(p);
    marks_.assign(static_cast<std::size_t>(part.cells[0]) * static_cast<std::size_t>(part.cells[1]) *
                      static_cast<std::size_t>(part.cells[2]),
                  free);
    for (const std::size_t other : covering_) mark(part, boxes_[other], size);
    std::uint32_t c = 0;
    for (std::int32_t k = 0; k < part.cells[2]; ++k)
      for (std::int32_t j = 0; j < part.cells[1]; ++j)
        for (std::int32_t i = 0; i < part.cells[0]; ++i, ++c) {
          if (marks_[c] == covered) {
            ++amr_.covered;
            continue;
          }
          if (!ghost.empty() && amr_.leaves_out(ghost[c])) continue;
          const AmrLeaf leaf{{part.low[0] + i * size, part.low[1] + j * size, part.low[2] + k * size},
                             c,
                             static_cast<std::uint32_t>(p),
                             part.level};
          if (marks_[c] == free)
            amr_.leaves.push_back(leaf);
          else
            add_rest(leaf);
        }
    read_ += marks_.size();
  }

 private:
  enum Mark : std::uint8_t { free, touched, covered };

  [[nodiscard]] std::int32_t size_of_level(std::int32_t level) const {
    return amr_.size[static_cast<std::size_t>(level)];
  }

  /// Finds blocks that intersect block p and are finer, or equally fine and listed earlier.
  void find_covering(std::size_t p) {
    covering_.clear();
    for (const std::size_t other : order_) {
      if (boxes_[other].low[0] >= boxes_[p].high[0]) break;
      const std::int32_t level = amr_.parts[other].level, own = amr_.parts[p].level;
      if ((level > own || (level == own && other < p)) && boxes_[other].meets(boxes_[p])) covering_.push_back(other);
    }
  }

  void mark(const AmrLeaves::Part& part, const Box& box, std::int32_t size) {
    AmrIndex first, last, whole_first, whole_last;
    for (std::size_t a = 0; a < 3; ++a) {
      const std::int32_t low = std::max(box.low[a] - part.low[a], 0),
                         high = std::min(box.high[a] - part.low[a], part.cells[a] * size);
      first[a] = low / size, last[a] = (high + size - 1) / size;
      whole_first[a] = (low + size - 1) / size, whole_last[a] = high / size;
    }
    for (std::int32_t k = first[2]; k < last[2]; ++k)
      for (std::int32_t j = first[1]; j < last[1]; ++j)
        for (std::int32_t i = first[0]; i < last[0]; ++i) {
          const bool whole = i >= whole_first[0] && i < whole_last[0] && j >= whole_first[1] && j < whole_last[1] &&
                             k >= whole_first[2] && k < whole_last[2];
          std::uint8_t& m = marks_[static_cast<std::size_t>(i) +
                                   static_cast<std::size_t>(part.cells[0]) *
                                       (static_cast<std::size_t>(j) +
                                        static_cast<std::size_t>(part.cells[1]) * static_cast<std::size_t>(k))];
          m = std::max(m, static_cast<std::uint8_t>(whole ? covered : touched));
        }
  }

  /// Adds the parts of a cell that finer blocks leave uncovered, if these blocks cover parts of the cell.
  void add_rest(const AmrLeaf& cell) {
    const Box box = cell_box(cell.low, size_of_level(cell.level));
    bool met = false;
    for (const std::size_t other : covering_) {
      if (boxes_[other].holds(box)) return;
      met = met || boxes_[other].meets(box);
    }
    if (!met) {
      amr_.leaves.push_back(cell);
      return;
    }
    if (amr_.leaves.size() > 1000000 + 8 * (read_ + marks_.size()))
      throw scene::bad_input(
          fmt::format("{}: the blocks of its levels cut each other's cells into too many pieces; write blocks that "
                      "cover whole cells of the coarser levels",
                      source_));
    AmrLeaf child = cell;
    ++child.level;
    const std::int32_t size = size_of_level(child.level);
    for (child.low[2] = box.low[2]; child.low[2] < box.high[2]; child.low[2] += size)
      for (child.low[1] = box.low[1]; child.low[1] < box.high[1]; child.low[1] += size)
        for (child.low[0] = box.low[0]; child.low[0] < box.high[0]; child.low[0] += size) add_rest(child);
  }

  AmrLeaves& amr_;
  const std::string& source_;
  std::size_t read_ = 0;  ///< number of cells in the previous blocks
  std::vector<Box> boxes_;
  std::vector<std::size_t> order_, covering_;
  std::vector<std::uint8_t> marks_;
};

}  // namespace

bool AmrLeaves::leaves_out(std::uint8_t ghost) {
  if ((ghost & (duplicate_cell | refined_cell | hidden_cell)) == 0) return false;
  ++((ghost & refined_cell) != 0 ? covered : hidden);
  return true;
}

AmrLeaves leaves_of_blocks(std::span<const AmrBlock> blocks, const std::string& source) {
  for (const AmrBlock& block : blocks) require_block(block, source);
  AmrLeaves amr;
  const std::vector<const AmrBlock*> levels = distinct_levels(blocks);
  amr.size = level_sizes(levels, source);
  place_blocks(blocks, amr, levels, source);
  Coverage coverage(amr, source);
  for (std::size_t p = 0; p < blocks.size(); ++p) {
    const AmrIndex& n = amr.parts[p].cells;
    const std::size_t cells =
        static_cast<std::size_t>(n[0]) * static_cast<std::size_t>(n[1]) * static_cast<std::size_t>(n[2]);
    coverage.add_leaves(p, blocks[p].ghosts(cells));
  }
  return amr;
}

}  // namespace tessera::cells
