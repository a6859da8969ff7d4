#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <unordered_map>

#include "io/amr_leaves.hpp"
#include "io/amr_vertices.hpp"
#include "scene/error.hpp"

namespace tessera::io {
namespace {

std::string piece_words(const ForeignPart& part, const std::string& source) {
  return part.name.empty() ? source : fmt::format("{}: piece '{}'", source, part.name);
}

scene::Error unfit(const ForeignPart& part, const std::string& source) {
  return scene::bad_input(
      fmt::format("{}: its trees do not fit its grid; it is damaged, write it anew", piece_words(part, source)));
}

std::int64_t roots_along(const ForeignPart& part, std::size_t axis) { return part.extent[2 * axis + 1]; }

std::vector<double> coordinates_of(const AmrBlock& trees, std::size_t axis, const std::string& source) {
  const ForeignPart& part = *trees.part;
  if (part.coordinates.size() != 3) throw unfit(part, source);
  const ForeignArray& array = part.coordinates[axis];
  std::vector<double> at(array.tuples);
  read_tuples(trees.file->arrays->copy(array, source), array.type, array.components, 0, 0, at);
  if (at.size() < 2 || static_cast<std::int64_t>(at.size()) != roots_along(part, axis) + 1) throw unfit(part, source);
  return at;
}

/// Cells of the last level along one of the first.
std::int32_t steps_of(const ForeignPart& part, int levels, const std::string& source) {
  double steps = 1;
  for (int level = 1; level < levels && steps <= most_amr_corners; ++level) steps *= part.branching;
  for (std::size_t a = 0; a < 3; ++a)
    if (!(static_cast<double>(roots_along(part, a)) * steps <= most_amr_corners))
      throw scene::bad_input(fmt::format("{}: it is {} of the finest cells long, {} are read; leave out levels",
                                         piece_words(part, source), static_cast<double>(roots_along(part, a)) * steps,
                                         most_amr_corners));
  return static_cast<std::int32_t>(steps);
}

/// So that all corners of cells lie apart.
void require_rising(std::span<const double> at, std::int32_t steps, std::size_t axis, const std::string& source) {
  for (std::size_t n = 0; n + 1 < at.size(); ++n) {
    const double size = std::max(std::abs(at[n]), std::abs(at[n + 1])), step = (at[n + 1] - at[n]) / steps;
    if (!std::isfinite(at[n]) || !std::isfinite(at[n + 1]) ||
        !(step > 4 * std::numeric_limits<double>::epsilon() * size))
      throw scene::bad_input(fmt::format(
          "{}: its coordinates along {} go from {} to {}, between which {} cells of the finest level are to "
          "lie; give coordinates that rise, or fewer levels",
          source, "xyz"[axis], at[n], at[n + 1], steps));
  }
}

/// The leaves of one part after the other.
class TreeLeaves {
 public:
  TreeLeaves(AmrLeaves& amr, bool several, const std::string& source) : amr_(amr), source_(source), several_(several) {}

  void add(const AmrBlock& trees, const std::array<std::int64_t, 3>& grid) {
    const ForeignPart& part = *trees.part;
    const std::vector<std::int32_t> lows = numbers<std::int32_t>(trees, part.points, NumberType::int32, 3);
    const std::vector<std::uint8_t> levels = numbers<std::uint8_t>(trees, part.types, NumberType::uint8, 1);
    if (lows.size() != 3 * levels.size() || levels.size() > std::numeric_limits<std::uint32_t>::max())
      throw unfit(part, source_);
    const std::vector<std::uint8_t> ghost = ghost_bits(*trees.file, part.cell_fields, levels.size());
    // Other parts may have deeper trees.
    const std::int32_t scale = amr_.size[static_cast<std::size_t>(part.levels) - 1];
    const auto number = static_cast<std::uint32_t>(amr_.parts.size());
    amr_.parts.push_back({trees.file, &part});
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
  template <class T>
  std::vector<T> numbers(const AmrBlock& trees, const std::optional<ForeignArray>& array, NumberType type,
                         int components) {
    if (!array || array->type != type || array->components != components) throw unfit(*trees.part, source_);
    const std::vector<std::byte> bytes = trees.file->arrays->copy(*array, source_);
    const auto* const first = reinterpret_cast<const T*>(bytes.data());
    return {first, first + bytes.size() / sizeof(T)};
  }

  /// No two leaves begin at one place, and no tree is in two parts.
  void require_new(const AmrLeaf& leaf, const std::array<std::int64_t, 3>& grid, const ForeignPart& part) {
    if (several_) require_own_tree(leaf, grid, part);
    if (lows_.add(leaf.low) != amr_.leaves.size()) throw unfit(part, source_);
  }

  void require_own_tree(const AmrLeaf& leaf, const std::array<std::int64_t, 3>& grid, const ForeignPart& part) {
    std::int64_t root = 0;
    for (std::size_t a = 3; a-- > 0;) root = root * grid[a] + leaf.low[a] / amr_.size[0];
    const auto [owner, is_new] = owners_.emplace(root, leaf.part);
    if (!is_new && owner->second != leaf.part)
      throw scene::bad_input(
          fmt::format("{}: cell {} of its grid is also in piece '{}'; write each tree once, or mark "
                      "ghosts by vtkGhostType",
                      piece_words(part, source_), root, amr_.parts[owner->second].part->name));
  }

  AmrLeaves& amr_;
  const std::string& source_;
  bool several_;
  AmrVertices lows_;
  std::unordered_map<std::int64_t, std::uint32_t> owners_;  ///< which part each tree is of
};

}  // namespace

AmrLeaves leaves_of_trees(std::span<const AmrBlock> trees, const std::string& source) {
  AmrLeaves amr;
  const ForeignPart& first = *trees.front().part;
  int levels = 1;
  for (const AmrBlock& block : trees) {
    const ForeignPart& part = *block.part;
    if (part.kind != ForeignPart::Kind::trees || part.levels < 1 || part.levels > 64 || part.branching < 2)
      throw unfit(part, source);
    if (part.branching != first.branching || part.extent != first.extent)
      throw scene::bad_input(fmt::format("{}: it has not the grid of piece '{}'; write all pieces of one data set",
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
        throw scene::bad_input(
            fmt::format("{}: its coordinates along {} are not those of piece '{}'; write all pieces "
                        "of one data set",
                        piece_words(*trees[p].part, source), "xyz"[a], first.name));
  }
  TreeLeaves leaves(amr, trees.size() > 1, source);
  for (const AmrBlock& block : trees) leaves.add(block, grid);
  return amr;
}

}  // namespace tessera::io
