// SPDX-License-Identifier: BSD-3-Clause
#include "readers/xdmf/xdmf_cells.hpp"

#include <fmt/format.h>

#include <XdmfInformation.hpp>
#include <XdmfTopology.hpp>
#include <XdmfTopologyType.hpp>
#include <algorithm>
#include <array>
#include <cstdlib>
#include <span>

#include "readers/xdmf/xdmf_elements.hpp"
#include "scene/error.hpp"
#include "tessera/cell_type.hpp"

namespace tessera::readers {
namespace {

struct XdmfCell {
  unsigned xdmf;  ///< number in topologies of mixed cells, according to "XDMF Model and Format"
  CellType type;
  std::uint8_t nodes;  ///< 0: the number of nodes is stored before the nodes
};
constexpr std::array xdmf_cells = {XdmfCell{1, CellType::poly_vertex, 0},
                                   XdmfCell{2, CellType::poly_line, 0},
                                   XdmfCell{3, CellType::polygon, 0},
                                   XdmfCell{4, CellType::triangle, 3},
                                   XdmfCell{5, CellType::quad, 4},
                                   XdmfCell{6, CellType::tetra, 4},
                                   XdmfCell{7, CellType::pyramid, 5},
                                   XdmfCell{8, CellType::wedge, 6},
                                   XdmfCell{9, CellType::hexahedron, 8},
                                   XdmfCell{34, CellType::quadratic_edge, 3},
                                   XdmfCell{35, CellType::biquadratic_quad, 9},
                                   XdmfCell{36, CellType::quadratic_triangle, 6},
                                   XdmfCell{37, CellType::quadratic_quad, 8},
                                   XdmfCell{38, CellType::quadratic_tetra, 10},
                                   XdmfCell{39, CellType::quadratic_pyramid, 13},
                                   XdmfCell{40, CellType::quadratic_wedge, 15},
                                   XdmfCell{41, CellType::biquadratic_quadratic_wedge, 18},
                                   XdmfCell{48, CellType::quadratic_hexahedron, 20},
                                   XdmfCell{49, CellType::biquadratic_quadratic_hexahedron, 24},
                                   XdmfCell{50, CellType::triquadratic_hexahedron, 27}};

const XdmfCell& cell_of(unsigned xdmf, const std::string& name, const std::string& where) {
  const auto* const type =
      std::find_if(xdmf_cells.begin(), xdmf_cells.end(), [&](const XdmfCell& c) { return c.xdmf == xdmf; });
  if (type == xdmf_cells.end())
    throw scene::bad_input(
        fmt::format("{}: it has cells of the type {}, which are not supported; write tetrahedra, hexahedra, wedges or "
                    "pyramids of first or second order",
                    where, name));
  return *type;
}

/// Gives access to the library's table of names, which only subclasses can access.
class TopologyNames : public XdmfTopologyType {
 public:
  static void add() {
    InitTypes();
    mTopologyDefinitions["TRI_6"] = Triangle_6;
    mTopologyDefinitions["QUAD_8"] = Quadrilateral_8;
    mTopologyDefinitions["QUAD_9"] = Quadrilateral_9;
    mTopologyDefinitions["TET_10"] = Tetrahedron_10;
    mTopologyDefinitions["HEX_20"] = Hexahedron_20;
    mTopologyDefinitions["HEX_24"] = Hexahedron_24;
    mTopologyDefinitions["HEX_27"] = Hexahedron_27;
  }
};

/// Reads the numbers of a topology sequentially.
class Numbers {
 public:
  Numbers(std::span<const std::int64_t> numbers, std::int64_t base, const std::string& where)
      : numbers_(numbers), base_(base), where_(where) {}

  [[nodiscard]] bool at_end() const { return at_ == numbers_.size(); }
  std::int64_t next() {
    if (at_end())
      throw scene::bad_input(
          fmt::format("{}: its topology ends within a cell; it is truncated or damaged, write it again", where_));
    return numbers_[at_++];
  }
  void add_cell(CellType type, std::int64_t nodes, XdmfCells& cells) {
    if (nodes < 0 || static_cast<std::uint64_t>(nodes) > numbers_.size() - at_) at_ = numbers_.size(), next();
    for (std::int64_t n = 0; n < nodes; ++n) {
      const std::int64_t node = numbers_[at_++] - base_;
      cells.connectivity.push_back(node < 0 || node >= UINT32_MAX ? UINT32_MAX : static_cast<std::uint32_t>(node));
    }
    cells.types.push_back(vtk_number(type));
    cells.offsets.push_back(cells.connectivity.size());
  }

 private:
  std::span<const std::int64_t> numbers_;
  std::int64_t base_;
  const std::string& where_;
  std::size_t at_ = 0;
};

/// Returns the number of the first point, which rewritten_xdmf() records because Xdmf's library ignores it.
std::int64_t base_of(XdmfTopology& topology) {
  const auto noted = topology.getInformation(base_offset);
  return noted == nullptr ? 0 : std::strtoll(noted->getValue().c_str(), nullptr, 10);
}

}  // namespace

void add_cell_names() { TopologyNames::add(); }

XdmfCells cells_of(XdmfTopology& topology, const std::string& where) {
  std::vector<std::int64_t> values(topology.getSize());
  if (!values.empty()) topology.getValues<std::int64_t>(0, values.data(), static_cast<unsigned>(values.size()), 1, 1);
  Numbers numbers(values, base_of(topology), where);
  XdmfCells cells;
  cells.offsets.push_back(0);
  if (topology.getType() == XdmfTopologyType::Mixed()) {
    while (!numbers.at_end()) {
      const std::int64_t number = numbers.next();
      const XdmfCell& cell = cell_of(number < 0 ? 0 : static_cast<unsigned>(number), fmt::format("{}", number), where);
      numbers.add_cell(cell.type, cell.nodes > 0 ? cell.nodes : numbers.next(), cells);
    }
    return cells;
  }
  const XdmfCell& cell = cell_of(topology.getType()->getID(), topology.getType()->getName(), where);
  const std::int64_t nodes = topology.getType()->getNodesPerElement();
  if (nodes <= 0 || (cell.nodes > 0 && nodes != cell.nodes))
    throw scene::bad_input(fmt::format("{}: its cells have {} nodes each; write the file again", where, nodes));
  while (!numbers.at_end()) numbers.add_cell(cell.type, nodes, cells);
  return cells;
}

}  // namespace tessera::readers
