// SPDX-License-Identifier: BSD-3-Clause
#include "readers/gmsh/gmsh_blocks.hpp"

#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <limits>
#include <map>

#include "readers/gmsh/gmsh_elements.hpp"
#include "scene/error.hpp"

namespace tessera::readers {
namespace {

using scene::Association;

constexpr double absent = std::numeric_limits<double>::quiet_NaN();
/// Key of the group of cells without a physical group.
constexpr int no_group = 0;

/// The cells of one block.
struct Group {
  std::string name;
  std::vector<GmshElements> elements;
};

/// All nodes, with an index from tags to nodes.
struct Nodes {
  std::vector<std::size_t> tags;
  TagIndex places;
  std::vector<double> coordinates;
};

Nodes read_nodes() {
  Nodes nodes;
  std::vector<double> parameters;
  gmsh::model::mesh::getNodes(nodes.tags, nodes.coordinates, parameters, -1, -1, false, false);
  nodes.places = TagIndex(nodes.tags);
  return nodes;
}

/// The names of physical groups and partitions. Determines the group in which a cell is drawn.
class Names {
 public:
  explicit Names(const GmshVolumes& volumes) : memberships_(volumes.memberships) {
    for (const GmshElements& elements : volumes.elements)
      for (const std::uint32_t m : elements.members) {
        const GmshMembership& member = memberships_[m];
        if (member.groups.empty()) ++cells_of_[no_group];
        for (const int group : member.groups) ++cells_of_[group];
        if (member.partition != 0) partitions_.try_emplace(member.partition);
      }
    for (auto& [group, cells] : cells_of_) {
      if (group == no_group) continue;
      std::string name;
      gmsh::model::getPhysicalName(3, group, name);
      if (name.empty() && cells_of_.size() > 1) name = fmt::format("group {}", group);
      group_names_[group] = std::move(name);
    }
    if (has_groups() && cells_of_.contains(no_group)) group_names_[no_group] = "no group";
    if (has_partitions())
      for (auto& [partition, name] : partitions_) name = fmt::format("partition {}", partition);
    for (const auto& [group, name] : group_names_)
      if (group != no_group && !name.empty()) all.push_back(name);
    if (has_groups() && cells_of_.contains(no_group)) all.push_back(group_names_[no_group]);
    for (const auto& [partition, name] : partitions_)
      if (has_partitions()) all.push_back(name);
    all = cells::distinct_names(std::move(all));
  }

  std::vector<std::string> all;

  [[nodiscard]] bool has_several_groups() const { return cells_of_.size() > 1; }
  [[nodiscard]] bool has_partitions() const { return partitions_.size() > 1; }

  /// Returns the group of a membership that has the fewest cells.
  [[nodiscard]] int smallest_group(std::uint32_t member) const {
    int smallest = no_group;
    for (const int group : memberships_[member].groups)
      if (smallest == no_group || cells_of_.at(group) < cells_of_.at(smallest)) smallest = group;
    return smallest;
  }

  /// Returns the block for cells of a membership; no value if they are not chosen.
  [[nodiscard]] std::optional<std::string> block_of(std::uint32_t member, const cells::BlockChoice& choice) const {
    const std::string smallest = name_of(smallest_group(member));
    if (choice.empty()) return smallest;
    if (!smallest.empty() && cells::is_chosen(choice, smallest)) return smallest;
    for (const int group : memberships_[member].groups)
      if (const std::string name = name_of(group); !name.empty() && cells::is_chosen(choice, name)) return name;
    if (const auto found = partitions_.find(memberships_[member].partition);
        found != partitions_.end() && has_partitions() && cells::is_chosen(choice, found->second))
      return found->second;
    return std::nullopt;
  }

 private:
  [[nodiscard]] bool has_groups() const { return cells_of_.size() > (cells_of_.contains(no_group) ? 1 : 0); }
  [[nodiscard]] std::string name_of(int group) const {
    const auto found = group_names_.find(group);
    return found == group_names_.end() ? "" : found->second;
  }

  const std::vector<GmshMembership>& memberships_;
  std::map<int, std::size_t> cells_of_;
  std::map<int, std::string> group_names_, partitions_;
};

/// Groups the elements by block, in the order of `names`.
std::vector<Group> grouped(GmshVolumes& volumes, const Names& names, const cells::BlockChoice& choice) {
  std::vector<std::optional<std::string>> block_of;
  for (std::uint32_t m = 0; m < volumes.memberships.size(); ++m) block_of.push_back(names.block_of(m, choice));
  std::map<std::string, Group> groups;
  for (GmshElements& elements : volumes.elements) {
    std::map<std::string, std::vector<std::size_t>> places;
    for (std::size_t k = 0; k < elements.tags.size(); ++k)
      if (const auto& block = block_of[elements.members[k]]) places[*block].push_back(k);
    for (const auto& [name, of_block] : places) {
      Group& group = groups[name];
      group.name = name;
      if (of_block.size() == elements.tags.size()) {
        group.elements.push_back(std::move(elements));
        break;
      }
      GmshElements some{elements.cell, elements.nodes_a_cell, {}, {}, {}};
      for (const std::size_t k : of_block) {
        some.tags.push_back(elements.tags[k]), some.members.push_back(elements.members[k]);
        const auto first = elements.nodes.begin() + static_cast<std::ptrdiff_t>(k * elements.nodes_a_cell);
        some.nodes.insert(some.nodes.end(), first, first + static_cast<std::ptrdiff_t>(elements.nodes_a_cell));
      }
      group.elements.push_back(std::move(some));
    }
    elements = {};
  }
  std::vector<Group> list;
  for (const std::string& name : names.all)
    if (const auto found = groups.find(name); found != groups.end()) list.push_back(std::move(found->second));
  if (const auto found = groups.find(""); found != groups.end()) list.push_back(std::move(found->second));
  return list;
}

/// Creates one block per group.
class Blocks {
 public:
  Blocks(const Nodes& nodes, const GmshVolumes& volumes, const Names& names, const std::vector<GmshView>& views,
         const std::string& source)
      : nodes_(nodes),
        volumes_(volumes),
        names_(names),
        views_(views),
        source_(source),
        local_(nodes.tags.size(), unused) {
    apart_ = std::any_of(views.begin(), views.end(),
                         [](const GmshView& view) { return view.of == GmshView::Of::element_nodes; });
  }

  cells::CellBlock block_of(const Group& group) {
    cells::CellBlock block;
    block.name = group.name;
    block.offsets.push_back(0);
    used_.clear();
    for (const GmshElements& elements : group.elements) add_cells(elements, block);
    for (const std::size_t node : used_) local_[node] = unused;
    for (const GmshView& view : views_) add_field(view, group, block);
    // Adds a field that distinguishes the groups, which is useful if there is no view.
    if (names_.has_several_groups())
      add_number_field("PhysicalGroupId", group, block, [&](std::uint32_t m) { return names_.smallest_group(m); });
    if (names_.has_partitions())
      add_number_field("PartitionId", group, block, [&](std::uint32_t m) { return volumes_.memberships[m].partition; });
    return block;
  }

 private:
  static constexpr std::uint32_t unused = std::numeric_limits<std::uint32_t>::max();

  template <class NumberOf>
  static void add_number_field(const char* name, const Group& group, cells::CellBlock& block,
                               const NumberOf& number_of) {
    std::vector<double> numbers;
    numbers.reserve(block.types.size());
    for (const GmshElements& elements : group.elements)
      for (const std::uint32_t member : elements.members) numbers.push_back(number_of(member));
    block.fields.push_back(cells::field_of_values(name, "int32", Association::cell, 1, std::move(numbers)));
  }

  /// Returns the index of an element's value in a view. The view may use any of the numbers under which the file lists
  /// the element.
  [[nodiscard]] std::size_t place_in(const GmshView& view, std::size_t tag) const {
    const std::size_t at = view.places.find(tag);
    const auto& others = volumes_.other_tags;
    if (at != TagIndex::none || others.empty()) return at;
    for (auto other = std::lower_bound(others.begin(), others.end(), std::pair(tag, std::size_t{0}));
         other != others.end() && other->first == tag; ++other)
      if (const std::size_t found = view.places.find(other->second); found != TagIndex::none) return found;
    return TagIndex::none;
  }

  std::size_t place_of(std::size_t tag) const {
    const std::size_t place = nodes_.places.find(tag);
    if (place == TagIndex::none)
      throw scene::bad_input(
          fmt::format("{}: a cell uses node {}, which the file does not have; write the file again", source_, tag));
    return place;
  }

  std::uint32_t add_point(std::size_t node, cells::CellBlock& block) {
    if (!apart_ && local_[node] != unused) return local_[node];
    if (used_.size() >= unused)
      throw scene::bad_input(fmt::format("{}: {} points in one block are too many; split it", source_, used_.size()));
    local_[node] = static_cast<std::uint32_t>(used_.size());
    used_.push_back(node);
    const double* const p = &nodes_.coordinates[3 * node];
    block.positions.emplace_back(p[0], p[1], p[2]);
    return local_[node];
  }

  void add_cells(const GmshElements& elements, cells::CellBlock& block) {
    block.types.insert(block.types.end(), elements.tags.size(), vtk_number(elements.cell->type));
    for (std::size_t c = 0; c < elements.tags.size(); ++c) {
      const std::span cell = std::span(elements.nodes).subspan(c * elements.nodes_a_cell, elements.nodes_a_cell);
      for (const std::size_t node : elements.cell->nodes)
        block.connectivity.push_back(add_point(place_of(cell[node]), block));
      block.offsets.push_back(block.connectivity.size());
    }
  }

  /// A view that has no values for this group does not become a field of the block.
  void add_field(const GmshView& view, const Group& group, cells::CellBlock& block) const {
    const bool of_cells = view.of == GmshView::Of::elements;
    const std::size_t tuples = of_cells ? block.types.size() : used_.size();
    std::vector<double> values(tuples * view.components, absent);
    std::size_t known = 0;
    const auto copy = [&](const double* from, std::size_t tuple) {
      std::copy_n(from, view.components, &values[tuple * view.components]);
      ++known;
    };
    if (view.of == GmshView::Of::nodes) {
      for (std::size_t v = 0; v < tuples; ++v)
        if (const std::size_t at = view.places.find(nodes_.tags[used_[v]]); at != TagIndex::none)
          copy(&view.values[at * view.components], v);
    } else {
      std::size_t c = 0, v = 0;
      for (const GmshElements& elements : group.elements)
        for (const std::size_t tag : elements.tags) {
          const std::size_t at = place_in(view, tag);
          if (at != TagIndex::none && of_cells) copy(&view.values[at * view.components], c);
          if (at != TagIndex::none && !of_cells)
            for (std::size_t k = 0; k < elements.cell->nodes.size(); ++k)
              if (const std::size_t node = elements.cell->nodes[k];
                  view.node_values[at].size() >= (node + 1) * view.components)
                copy(&view.node_values[at][node * view.components], v + k);
          v += elements.cell->nodes.size();
          ++c;
        }
    }
    if (known > 0)
      block.fields.push_back(cells::field_of_values(view.name, "double",
                                                    of_cells ? Association::cell : Association::point,
                                                    static_cast<int>(view.components), std::move(values)));
  }

  const Nodes& nodes_;
  const GmshVolumes& volumes_;
  const Names& names_;
  const std::vector<GmshView>& views_;
  const std::string& source_;
  std::vector<std::uint32_t> local_;  ///< for each node, its point in the current block
  std::vector<std::size_t> used_;     ///< for each point of the block, its node
  bool apart_ = false;                ///< each cell has its own points, because a view has values per cell and node
};

}  // namespace

GmshBlocks gmsh_blocks(const std::vector<GmshView>& views, const cells::BlockChoice& choice,
                       const std::filesystem::path& file, const std::string& source, std::vector<std::string>& notes) {
  const Nodes nodes = read_nodes();
  GmshVolumes volumes = gmsh_volumes(file, source, notes);
  Names names(volumes);
  const bool is_known = std::all_of(choice.begin(), choice.end(), [&](const std::string& name) {
    return std::any_of(names.all.begin(), names.all.end(),
                       [&](const std::string& block) { return cells::means_block(name, block); });
  });
  const std::vector<Group> groups = grouped(volumes, names, is_known ? choice : cells::BlockChoice());
  Blocks maker(nodes, volumes, names, views, source);
  GmshBlocks result;
  for (const Group& group : groups) result.blocks.push_back(maker.block_of(group));
  result.names = std::move(names.all);
  return result;
}

}  // namespace tessera::readers
