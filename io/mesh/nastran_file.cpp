// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/nastran_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include "cells/block_groups.hpp"
#include "cells/curved/node_orders.hpp"
#include "io/mesh/mesh_formats.hpp"
#include "io/mesh/nastran_deck.hpp"
#include "io/mesh/nastran_systems.hpp"
#include "scene/error.hpp"
#include "tessera/cell_type.hpp"

namespace tessera::io {
namespace {

/// An edge with a mid-edge node: its corners, and the position of the node in Nastran's order.
struct NastranEdge {
  std::size_t from, to, node;
};

struct SolidElement {
  std::string_view name;
  std::size_t corners;
  CellType linear_type, curved_type;
  std::vector<NastranEdge> edges;  ///< edges in VTK's order
};

SolidElement solid_of(std::string_view name, cells::CurvedFamily shape, std::size_t nodes) {
  const std::span<const cells::LatticePlace> corners = cells::corners_of(shape);
  const cells::NodeOrder& curved = *find_node_order(cells::NodeConvention::nastran, shape, nodes);
  SolidElement element{name,
                       corners.size(),
                       cells::find_node_order(cells::NodeConvention::nastran, shape, corners.size())->type,
                       curved.type,
                       {}};
  const cells::CurvedLattice lattice = *cells::curved_lattice(vtk_number(curved.type), nodes);
  const auto place = [&](std::size_t corner) {
    return glm::dvec3(corners[corner][0], corners[corner][1], corners[corner][2]);
  };
  for (std::size_t node = corners.size(); node < nodes; ++node)
    for (std::size_t to = 1; to < corners.size(); ++to)
      for (std::size_t from = 0; from < to; ++from)
        if (place(from) + place(to) == 2.0 * lattice.place(node))
          element.edges.push_back({from, to, curved.from.empty() ? node : curved.from[node]});
  return element;
}

const SolidElement* solid_element(std::string_view name) {
  static const std::array<SolidElement, 5> elements = {
      {solid_of("CTETRA", cells::CurvedFamily::tet, 10), solid_of("CPYRAM", cells::CurvedFamily::pyramid, 13),
       solid_of("CPYRA", cells::CurvedFamily::pyramid, 13), solid_of("CPENTA", cells::CurvedFamily::wedge, 15),
       solid_of("CHEXA", cells::CurvedFamily::hexahedron, 20)}};
  const auto* const found = std::ranges::find(elements, name, &SolidElement::name);
  return found == elements.end() ? nullptr : found;
}

/// Elements as listed in the deck. Their nodes are GRID ids; 0 is an omitted node.
struct DeckElements {
  std::vector<const SolidElement*> kinds;
  std::vector<std::int64_t> ids, properties, nodes;

  void add(const NastranEntry& entry) {
    const SolidElement* const kind = solid_element(entry.name());
    const std::int64_t id = entry.whole_number(0).value_or(0);
    kinds.push_back(kind);
    ids.push_back(id);
    properties.push_back(entry.whole_number(1).value_or(id));
    for (std::size_t k = 0; k < kind->corners + kind->edges.size(); ++k) {
      const std::int64_t node = entry.whole_number(2 + k).value_or(0);
      if (k < kind->corners && node == 0)
        entry.refuse(
            fmt::format("{} needs {} corners, but corner {} is blank; correct it", entry.name(), kind->corners, k + 1));
      nodes.push_back(node);
    }
  }
};

/// Converts elements to cells.
class NastranCells {
 public:
  NastranCells(const NastranSystems& systems, std::string source) : systems_(systems), source_(std::move(source)) {
    block_.positions = systems.positions();
    block_.offsets.push_back(0);
  }

  void add(const SolidElement& kind, std::int64_t id, std::span<const std::int64_t> nodes) {
    const std::size_t first = block_.connectivity.size();
    for (std::size_t k = 0; k < kind.corners; ++k) block_.connectivity.push_back(point(nodes[k], id));
    const bool is_curved =
        std::ranges::any_of(nodes.subspan(kind.corners), [](std::int64_t node) { return node != 0; });
    block_.types.push_back(vtk_number(is_curved ? kind.curved_type : kind.linear_type));
    for (const NastranEdge& edge : kind.edges) {
      if (!is_curved) break;
      const std::int64_t node = nodes[edge.node];
      block_.connectivity.push_back(
          node != 0 ? point(node, id)
                    : middle(block_.connectivity[first + edge.from], block_.connectivity[first + edge.to]));
    }
    block_.offsets.push_back(block_.connectivity.size());
  }

  cells::CellBlock block() { return std::move(block_); }

 private:
  [[nodiscard]] std::uint32_t point(std::int64_t grid, std::int64_t element) const {
    const std::optional<std::uint32_t> found = systems_.point(grid);
    if (!found)
      throw scene::bad_input(fmt::format(
          "{}: element {} uses GRID {}, which the file does not have; add it, or add the file that contains it",
          source_, element, grid));
    return *found;
  }

  std::uint32_t middle(std::uint32_t a, std::uint32_t b) {
    const auto [at, is_new] =
        middles_.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(block_.positions.size()));
    if (is_new) {
      const glm::dvec3 place = (block_.positions[a] + block_.positions[b]) / 2.0;
      block_.positions.push_back(place);
    }
    return at->second;
  }

  const NastranSystems& systems_;
  std::string source_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles_;
  cells::CellBlock block_;
};

}  // namespace

std::vector<cells::CellBlock> read_nastran(const std::filesystem::path& file) {
  NastranSystems systems;
  DeckElements elements;
  read_nastran_deck(
      file, [](std::string_view name) { return NastranSystems::is_used(name) || solid_element(name) != nullptr; },
      [&](const NastranEntry& entry) {
        if (NastranSystems::is_used(entry.name()))
          systems.add(entry);
        else
          elements.add(entry);
      });
  if (elements.kinds.empty())
    throw scene::bad_input(fmt::format(
        "{}: it has no elements CTETRA, CPYRAM, CPENTA or CHEXA; give a deck with a volume", file.string()));
  systems.place_points(file.string());
  NastranCells cells(systems, file.string());
  std::span<const std::int64_t> nodes = elements.nodes;
  for (std::size_t e = 0; e < elements.kinds.size(); ++e) {
    const SolidElement& kind = *elements.kinds[e];
    const std::size_t count = kind.corners + kind.edges.size();
    cells.add(kind, elements.ids[e], nodes.first(count));
    nodes = nodes.subspan(count);
  }
  return cells::blocks_by_number(cells.block(), elements.properties, "property", "PropertyId");
}

cells::MeshBlocks read_nastran_mesh(const InputFile& file, const MeshOptions& /*options*/) {
  return {read_nastran(file.path), {}, "Nastran"};
}

}  // namespace tessera::io
