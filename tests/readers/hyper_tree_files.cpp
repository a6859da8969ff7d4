// SPDX-License-Identifier: BSD-3-Clause
#include "readers/hyper_tree_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace tessera::io::testing {
namespace {

using Root = std::array<std::size_t, 3>;

/// An array; `count`, if set, overrides the stated number of tuples.
std::string array(const std::string& type, const std::string& name, const std::vector<double>& values,
                  int components = 1) {
  return fmt::format(
      "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" NumberOfTuples=\"{}\" "
      "format=\"ascii\">{}</DataArray>\n",
      type, name, components, values.size() / static_cast<std::size_t>(components), fmt::join(values, " "));
}

/// A tree's arrays.
struct Stored {
  std::vector<double> divided, masked, counts, order;
};

/// The order in which version 0 stores values: depth first.
void descend(const std::vector<TreeCell>& cells, std::size_t children, std::size_t cell, std::vector<double>& order) {
  if (cells[cell].first_child == 0) return;
  for (std::size_t c = 0; c < children; ++c) order.push_back(static_cast<double>(cells[cell].first_child + c));
  for (std::size_t c = 0; c < children; ++c) descend(cells, children, cells[cell].first_child + c, order);
}

void drop_zeros(std::vector<double>& bits) {
  while (bits.size() > 1 && bits.back() == 0) bits.pop_back();
}

Stored stored(const TreeScene& scene, const std::vector<TreeCell>& cells, int version) {
  Stored s;
  for (const TreeCell& cell : cells) {
    const auto level = static_cast<std::size_t>(cell.level);
    if (s.counts.size() <= level) s.counts.push_back(0);
    ++s.counts[level];
    s.divided.push_back(cell.first_child > 0);
    s.masked.push_back(scene.is_masked(cell));
  }
  if (version == 2) s.divided.resize(cells.size() - static_cast<std::size_t>(s.counts.back()));
  if (version == 1) drop_zeros(s.divided), drop_zeros(s.masked);
  s.order.push_back(0);
  if (version == 0) {
    const auto b = static_cast<std::size_t>(scene.branching);
    descend(cells, b * b * b, 0, s.order);
  } else {
    for (std::size_t c = 1; c < cells.size(); ++c) s.order.push_back(static_cast<double>(c));
  }
  return s;
}

std::string fields_of(const std::vector<TreeCell>& cells, const Stored& s, const Field& at, const TreeWish& wish) {
  std::vector<double> f, v, ghost;
  for (const double n : s.order) {
    const TreeCell& cell = cells[static_cast<std::size_t>(n)];
    const double value = cell.first_child > 0 ? 1e30 : at(cell.centre());
    f.push_back(value);
    v.insert(v.end(), {-1, value, 2});
    if (wish.ghost) ghost.push_back(wish.ghost(cell));
  }
  return array("Float64", "f", f) + array("Float64", "v", v, 3) +
         (wish.ghost ? array("UInt8", "vtkGhostType", ghost) : "");
}

void append(std::vector<double>& all, const std::vector<double>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

template <class Use>
void each_root(const TreeScene& scene, const Use& use) {
  for (std::size_t k = 0; k + 1 < scene.axes[2].size(); ++k)
    for (std::size_t j = 0; j + 1 < scene.axes[1].size(); ++j)
      for (std::size_t i = 0; i + 1 < scene.axes[0].size(); ++i) use(Root{i, j, k});
}

}  // namespace

bool TreeCell::holds(const glm::dvec3& p) const {
  return p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x < high.x && p.y < high.y && p.z < high.z;
}

std::vector<TreeCell> TreeScene::tree(const Root& root) const {
  TreeCell first;
  for (std::size_t a = 0; a < 3; ++a) {
    first.low[static_cast<int>(a)] = axes[a][root[a]];
    first.high[static_cast<int>(a)] = axes[a][root[a] + 1];
  }
  std::vector<TreeCell> cells{first};
  for (std::size_t c = 0; c < cells.size(); ++c) {
    if (is_masked(cells[c]) || !is_divided(cells[c])) continue;
    cells[c].first_child = cells.size();
    const TreeCell parent = cells[c];
    const glm::dvec3 size = parent.high - parent.low;
    for (int k = 0; k < branching; ++k)
      for (int j = 0; j < branching; ++j)
        for (int i = 0; i < branching; ++i) {
          const glm::dvec3 n(i, j, k);
          cells.push_back({parent.low + size * n / double(branching), parent.low + size * (n + 1.0) / double(branching),
                           parent.level + 1, 0});
        }
  }
  return cells;
}

std::vector<TreeCell> TreeScene::leaves() const {
  std::vector<TreeCell> all;
  each_root(*this, [&](const Root& root) {
    for (const TreeCell& cell : tree(root))
      if (cell.first_child == 0 && !is_masked(cell)) all.push_back(cell);
  });
  return all;
}

glm::dvec3 TreeScene::sides() const {
  return {axes[0].back() - axes[0].front(), axes[1].back() - axes[1].front(), axes[2].back() - axes[2].front()};
}

std::string htg_text(const TreeScene& scene, const Field& at, const TreeWish& wish) {
  const std::size_t nx = scene.axes[0].size() - 1, ny = scene.axes[1].size() - 1, nz = scene.axes[2].size() - 1;
  std::string text = fmt::format(
      "<VTKFile type=\"HyperTreeGrid\" version=\"{}.0\" byte_order=\"LittleEndian\" header_type=\"UInt32\">\n"
      "<HyperTreeGrid BranchFactor=\"{}\" TransposedRootIndexing=\"{}\" Dimensions=\"{} {} {}\" "
      "NumberOfVertices=\"0\">\n<Grid>\n{}{}{}</Grid>\n<Trees>\n",
      wish.version, scene.branching, wish.transposed ? 1 : 0, nx + 1, ny + 1, nz + 1,
      array("Float64", "XCoordinates", scene.axes[0]), array("Float64", "YCoordinates", scene.axes[1]),
      array("Float64", "ZCoordinates", scene.axes[2]));
  std::vector<double> ids, depths;
  Stored all;
  std::vector<TreeCell> all_cells;
  std::size_t offset = 0;
  each_root(scene, [&](const Root& root) {
    if (!wish.has_root(root)) return;
    const std::vector<TreeCell> cells = scene.tree(root);
    const Stored s = stored(scene, cells, wish.version);
    const auto id = wish.transposed ? root[2] + nz * (root[1] + ny * root[0]) : root[0] + nx * (root[1] + ny * root[2]);
    ids.push_back(static_cast<double>(id)), depths.push_back(static_cast<double>(s.counts.size()));
    append(all.divided, s.divided), append(all.masked, s.masked), append(all.counts, s.counts);
    for (const double n : s.order) all.order.push_back(n + static_cast<double>(all_cells.size()));
    all_cells.insert(all_cells.end(), cells.begin(), cells.end());
    if (wish.version == 2) return;
    text += fmt::format("<Tree Index=\"{}\" GlobalOffset=\"{}\" NumberOfLevels=\"{}\" NumberOfVertices=\"{}\">\n", id,
                        offset, s.counts.size(), cells.size());
    text += array("Bit", "Descriptor", s.divided) + array("Int64", "NbVerticesByLevel", s.counts) +
            array("Bit", "Mask", s.masked) + "<CellData>\n" + fields_of(cells, s, at, wish) + "</CellData>\n</Tree>\n";
    offset += cells.size();
  });
  if (wish.version == 2)
    text += array("Bit", "Descriptors", all.divided) + array("Int64", "NumberOfVerticesPerDepth", all.counts) +
            array("Int64", "TreeIds", ids) + array("UInt32", "DepthPerTree", depths) + array("Bit", "Mask", all.masked);
  text += "</Trees>\n";
  if (wish.version == 2) text += "<CellData>\n" + fields_of(all_cells, all, at, wish) + "</CellData>\n";
  return text + "</HyperTreeGrid>\n</VTKFile>\n";
}

}  // namespace tessera::io::testing
