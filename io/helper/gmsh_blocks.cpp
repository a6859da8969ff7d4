#include "io/helper/gmsh_blocks.hpp"

#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <limits>
#include <map>
#include <new>

#include "io/helper/gmsh_cells.hpp"
#include "scene/error.hpp"

namespace tessera::io::helper {
namespace {

using scene::Association;

constexpr double absent = std::numeric_limits<double>::quiet_NaN();
/// In place of a physical group's number, and larger than any.
constexpr int no_group = std::numeric_limits<int>::max();

/// Cells of some physical group, by type.
struct Elements {
  const GmshCell* cell = nullptr;
  std::size_t nodes_a_cell = 0;
  std::vector<std::size_t> tags, nodes;
};
struct Group {
  int number = no_group;
  std::string name;
  std::vector<Elements> elements;
};

/// All nodes, and how their tags find them.
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

/// Cell types as they are met.
class CellTypes {
 public:
  const GmshCell& of(int type, std::vector<std::string>& notes) {
    const auto [found, is_new] = known_.try_emplace(type);
    if (!is_new) return found->second;
    std::string name;
    int dimension = 0, order = 0, nodes = 0, corners = 0;
    std::vector<double> places;
    try {
      gmsh::model::mesh::getElementProperties(type, name, dimension, order, nodes, places, corners);
    } catch (const std::bad_alloc&) {
      throw;
    } catch (...) {  // it knows no places in prisms of the third order and above
      const bool is_third_or_fourth = type == 90 || type == 91;
      if (is_third_or_fourth || (type >= 106 && type <= 117)) {
        name = "Prism", corners = 6;
        order = is_third_or_fourth ? type - 87 : type <= 110 ? type - 101 : 0;  // the others lack inner nodes
        if (order > 0) places = gmsh_prism_places(order);
        nodes = order > 0 ? static_cast<int>(places.size() / 3) : 6;
        if (order == 0) found->second = gmsh_cell(1, 6, std::vector<double>(18)), found->second.by_corners = true;
      }
    }
    if (corners >= 4 && corners <= 8 && corners != 7 && places.size() == 3 * static_cast<std::size_t>(nodes))
      found->second = gmsh_cell(order, static_cast<std::size_t>(corners), places);
    if (found->second.by_corners)
      notes.push_back(fmt::format("cells of type {} are rendered as linear ones by their corner nodes", name));
    return found->second;
  }

 private:
  std::map<int, GmshCell> known_;
};

/// Volume cells by physical group; those of none come last.
std::vector<Group> read_groups(CellTypes& types, const std::string& source, std::vector<std::string>& notes) {
  std::map<int, Group> groups;
  std::size_t entities_of_several = 0;
  gmsh::vectorpair entities;
  gmsh::model::getEntities(entities, 3);
  for (const auto& [dimension, entity] : entities) {
    std::vector<int> physical, element_types;
    gmsh::model::getPhysicalGroupsForEntity(3, entity, physical);
    if (physical.size() > 1) ++entities_of_several;
    std::vector<std::vector<std::size_t>> tags, nodes;
    gmsh::model::mesh::getElements(element_types, tags, nodes, 3, entity);
    for (std::size_t k = 0; k < element_types.size(); ++k) {
      if (tags[k].empty()) continue;
      const GmshCell& cell = types.of(element_types[k], notes);
      if (cell.vtk_type == 0)
        throw scene::bad_input(
            fmt::format("{}: its cells of Gmsh's type {} are not rendered; split them into "
                        "tetrahedra",
                        source, element_types[k]));
      Group& group = groups[physical.empty() ? no_group : physical.front()];
      group.elements.push_back({&cell, nodes[k].size() / tags[k].size(), std::move(tags[k]), std::move(nodes[k])});
    }
  }
  if (entities_of_several > 0)
    notes.push_back(fmt::format("{} volume{} in several physical groups, and drawn in the first of them",
                                entities_of_several, entities_of_several == 1 ? " is" : "s are"));
  std::vector<Group> list;
  for (auto& [tag, group] : groups) {
    group.number = tag;
    if (tag != no_group) gmsh::model::getPhysicalName(3, tag, group.name);
    if (group.name.empty() && groups.size() > 1)
      group.name = tag == no_group ? "no group" : fmt::format("group {}", tag);
    list.push_back(std::move(group));
  }
  return list;
}

/// Makes a block of a group at a time.
class Blocks {
 public:
  Blocks(const Nodes& nodes, const std::vector<GmshView>& views, const std::string& source)
      : nodes_(nodes), views_(views), source_(source), local_(nodes.tags.size(), unused) {
    apart_ = std::any_of(views.begin(), views.end(),
                         [](const GmshView& view) { return view.of == GmshView::Of::element_nodes; });
  }

  CellBlock block_of(const Group& group, bool is_only_one) {
    CellBlock block;
    block.name = group.name;
    block.offsets.push_back(0);
    used_.clear();
    for (const Elements& elements : group.elements) add_cells(elements, block);
    for (const std::size_t node : used_) local_[node] = unused;
    for (const GmshView& view : views_) add_field(view, group, block);
    if (!is_only_one && group.number != no_group) add_group_field(group.number, block);
    return block;
  }

 private:
  static constexpr std::uint32_t unused = std::numeric_limits<std::uint32_t>::max();

  /// Something to colour by where there is no view.
  static void add_group_field(int number, CellBlock& block) {
    block.fields.push_back(field_of_values("PhysicalGroupId", "int32", Association::cell, 1,
                                           std::vector<double>(block.types.size(), number)));
  }

  std::size_t place_of(std::size_t tag) const {
    const std::size_t place = nodes_.places.find(tag);
    if (place == TagIndex::none)
      throw scene::bad_input(
          fmt::format("{}: a cell uses node {}, which the file has not; write it anew", source_, tag));
    return place;
  }

  std::uint32_t add_point(std::size_t node, CellBlock& block) {
    if (!apart_ && local_[node] != unused) return local_[node];
    if (used_.size() >= unused)
      throw scene::bad_input(fmt::format("{}: {} points in one block; split it", source_, used_.size()));
    local_[node] = static_cast<std::uint32_t>(used_.size());
    used_.push_back(node);
    const double* const p = &nodes_.coordinates[3 * node];
    block.positions.emplace_back(p[0], p[1], p[2]);
    return local_[node];
  }

  void add_cells(const Elements& elements, CellBlock& block) {
    block.types.insert(block.types.end(), elements.tags.size(), elements.cell->vtk_type);
    for (std::size_t c = 0; c < elements.tags.size(); ++c) {
      const std::span cell = std::span(elements.nodes).subspan(c * elements.nodes_a_cell, elements.nodes_a_cell);
      for (const std::size_t node : elements.cell->nodes)
        block.connectivity.push_back(add_point(place_of(cell[node]), block));
      block.offsets.push_back(block.connectivity.size());
    }
  }

  /// A view that has no value in the group is no field of it.
  void add_field(const GmshView& view, const Group& group, CellBlock& block) const {
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
      for (const Elements& elements : group.elements)
        for (const std::size_t tag : elements.tags) {
          const std::size_t at = view.places.find(tag);
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
      block.fields.push_back(field_of_values(view.name, "double", of_cells ? Association::cell : Association::point,
                                             static_cast<int>(view.components), std::move(values)));
  }

  const Nodes& nodes_;
  const std::vector<GmshView>& views_;
  const std::string& source_;
  std::vector<std::uint32_t> local_;  ///< by node: its point in the block at hand
  std::vector<std::size_t> used_;     ///< by point of the block: its node
  bool apart_ = false;                ///< each cell has points of its own, since they have its values
};

}  // namespace

std::vector<CellBlock> gmsh_blocks(const std::vector<GmshView>& views, const std::string& source,
                                   std::vector<std::string>& notes) {
  const Nodes nodes = read_nodes();
  CellTypes types;
  const std::vector<Group> groups = read_groups(types, source, notes);
  Blocks maker(nodes, views, source);
  std::vector<CellBlock> blocks;
  for (const Group& group : groups) blocks.push_back(maker.block_of(group, groups.size() == 1));
  return blocks;
}

}  // namespace tessera::io::helper
