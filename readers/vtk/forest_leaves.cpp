// SPDX-License-Identifier: BSD-3-Clause
#include "readers/vtk/forest_leaves.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "scene/error.hpp"

namespace tessera::readers {
namespace {

/// Largest number of cells of the deepest level along an axis, which is the capacity of the library's lattice
/// (cells/amr/amr_leaves.cpp).
constexpr std::int64_t most_cells = 1 << 29;

constexpr const char* remedy = "it is damaged, write it again";

/// A cell of one level, and its position in cells of that level.
struct Node {
  std::array<std::int32_t, 3> low;
  bool is_hidden;
};

class Descent {
 public:
  Descent(const StoredForest& forest, const std::string& source) : forest_(forest), source_(source) {
    children_ = static_cast<std::size_t>(forest.branching) * static_cast<std::size_t>(forest.branching) *
                static_cast<std::size_t>(forest.branching);
  }

  ForestLeaves leaves() {
    for (std::size_t t = 0; t < forest_.trees.size(); ++t) add_tree(t);
    // The lattice is that of the deepest leaf, which may be less deep than the file allows.
    std::vector<std::int32_t> scale(static_cast<std::size_t>(leaves_.levels), 1);
    for (std::size_t level = scale.size() - 1; level-- > 0;) scale[level] = scale[level + 1] * forest_.branching;
    for (std::size_t l = 0; l < leaves_.level.size(); ++l)
      for (std::size_t a = 0; a < 3; ++a) leaves_.lows[3 * l + a] *= scale[leaves_.level[l]];
    return std::move(leaves_);
  }

 private:
  [[nodiscard]] Node root_of(std::size_t t) const {
    const std::int64_t root = forest_.trees[t].root;
    const std::size_t first = forest_.z_first ? 2 : 0, last = forest_.z_first ? 0 : 2;
    const auto& n = forest_.roots;
    if (root < 0 || root / n[first] / n[1] >= n[last])
      throw scene::bad_input(fmt::format("{}: tree {} belongs to cell {}, but the grid has {} x {} x {} cells; {}",
                                         source_, t, root, n[0], n[1], n[2], remedy));
    Node node{{}, false};
    node.low[first] = static_cast<std::int32_t>(root % n[first]);
    node.low[1] = static_cast<std::int32_t>(root / n[first] % n[1]);
    node.low[last] = static_cast<std::int32_t>(root / n[first] / n[1]);
    return node;
  }

  /// Throws for cells of a level that is too deep for the lattice.
  void require_depth(std::size_t t, int level) const {
    std::int64_t cells = *std::max_element(forest_.roots.begin(), forest_.roots.end());
    for (int l = 0; l <= level; ++l) {
      if (l > 0) cells *= forest_.branching;
      if (cells > most_cells)
        throw scene::bad_input(
            fmt::format("{}: tree {} has cells of level {}, where the grid would be more than {} cells long; write it "
                        "with fewer levels",
                        source_, t, level, most_cells));
    }
  }

  void add_tree(std::size_t t) {
    const StoredTree& tree = forest_.trees[t];
    level_.assign(1, root_of(t));
    if (forest_.values_by_descent) order_by_descent(tree);
    std::size_t cell = 0;
    for (int level = 0; !level_.empty(); ++level) {
      require_depth(t, level);
      next_.clear();
      for (const Node& node : level_) {
        const bool is_hidden = node.is_hidden || (cell < tree.masks && forest_.masked[tree.first_mask + cell]);
        if (is_divided(tree, cell))
          add_children(t, node, is_hidden, cell);
        else if (is_hidden)
          ++leaves_.masked;
        else
          add_leaf(tree, node, level, cell);
        ++cell;
        if (cell > tree.cells) refuse_count(t, cell);
      }
      std::swap(level_, next_);
    }
    if (cell != tree.cells) refuse_count(t, cell);
  }

  [[nodiscard]] bool is_divided(const StoredTree& tree, std::size_t cell) const {
    return cell < tree.bits && forest_.divided[tree.first_bit + cell];
  }

  void add_children(std::size_t t, const Node& parent, bool is_hidden, std::size_t cell) {
    // Checked so that the memory is proportional to the size of the file.
    if (next_.size() + children_ > forest_.trees[t].cells) refuse_count(t, cell + next_.size() + children_);
    const std::int32_t b = forest_.branching;
    for (std::int32_t k = 0; k < b; ++k)
      for (std::int32_t j = 0; j < b; ++j)
        for (std::int32_t i = 0; i < b; ++i)
          next_.push_back({{parent.low[0] * b + i, parent.low[1] * b + j, parent.low[2] * b + k}, is_hidden});
  }

  void add_leaf(const StoredTree& tree, const Node& node, int level, std::size_t cell) {
    leaves_.lows.insert(leaves_.lows.end(), node.low.begin(), node.low.end());
    leaves_.level.push_back(static_cast<std::uint8_t>(level));
    leaves_.values.push_back(static_cast<std::int64_t>(tree.first + (order_.empty() ? cell : order_[cell])));
    leaves_.levels = std::max(leaves_.levels, level + 1);
  }

  /// Computes the index in depth-first order of each of a tree's cells.
  void order_by_descent(const StoredTree& tree) {
    std::vector<std::size_t> elder(tree.cells, 0);  // the first child of each cell, level by level
    std::size_t next = 1;
    for (std::size_t cell = 0; cell < tree.cells && cell < tree.bits; ++cell)
      if (is_divided(tree, cell)) elder[cell] = next, next += children_;
    order_.assign(tree.cells, 0);
    if (next != tree.cells) return;  // a wrong number of cells is reported later
    std::size_t made = 1;
    std::vector<std::size_t> open{0};
    while (!open.empty()) {
      const std::size_t cell = open.back();
      open.pop_back();
      if (elder[cell] == 0) continue;
      for (std::size_t c = 0; c < children_; ++c) order_[elder[cell] + c] = made++;
      for (std::size_t c = children_; c-- > 0;) open.push_back(elder[cell] + c);
    }
  }

  [[noreturn]] void refuse_count(std::size_t t, std::size_t cells) const {
    throw scene::bad_input(
        fmt::format("{}: tree {} has {} cells or more according to its divisions, but {} according to its counts; {}",
                    source_, t, cells, forest_.trees[t].cells, remedy));
  }

  const StoredForest& forest_;
  const std::string& source_;
  std::size_t children_ = 8;
  ForestLeaves leaves_;
  std::vector<Node> level_, next_;
  std::vector<std::size_t> order_;
};

}  // namespace

ForestLeaves leaves_of(const StoredForest& forest, const std::string& source) {
  return Descent(forest, source).leaves();
}

}  // namespace tessera::readers
