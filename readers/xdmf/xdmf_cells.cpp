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

namespace tessera::readers {
namespace {

struct CellType {
  unsigned xdmf;  ///< in topologies of mixed cells, "XDMF Model and Format"
  std::uint8_t vtk;
  std::uint8_t nodes;  ///< 0: the number comes first
};
constexpr std::array cell_types = {
    CellType{1, 2, 0},    CellType{2, 4, 0},    CellType{3, 7, 0},    CellType{4, 5, 3},    CellType{5, 9, 4},
    CellType{6, 10, 4},   CellType{7, 14, 5},   CellType{8, 13, 6},   CellType{9, 12, 8},   CellType{34, 21, 3},
    CellType{35, 28, 9},  CellType{36, 22, 6},  CellType{37, 23, 8},  CellType{38, 24, 10}, CellType{39, 27, 13},
    CellType{40, 26, 15}, CellType{41, 32, 18}, CellType{48, 25, 20}, CellType{49, 33, 24}, CellType{50, 29, 27}};

const CellType& type_of(unsigned xdmf, const std::string& name, const std::string& where) {
  const auto* const type =
      std::find_if(cell_types.begin(), cell_types.end(), [&](const CellType& t) { return t.xdmf == xdmf; });
  if (type == cell_types.end())
    throw scene::bad_input(
        fmt::format("{}: it has cells of the type {}, which are not read; write tetrahedra, hexahedra, wedges or "
                    "pyramids of first or second order",
                    where, name));
  return *type;
}

/// The library's table of names is its own and its subclasses'.
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

/// Reads along a topology's numbers.
class Numbers {
 public:
  Numbers(std::span<const std::int64_t> numbers, std::int64_t base, const std::string& where)
      : numbers_(numbers), base_(base), where_(where) {}

  [[nodiscard]] bool at_end() const { return at_ == numbers_.size(); }
  std::int64_t next() {
    if (at_end())
      throw scene::bad_input(
          fmt::format("{}: its topology ends within a cell; it is truncated or damaged, write it anew", where_));
    return numbers_[at_++];
  }
  void add_cell(std::uint8_t type, std::int64_t nodes, XdmfCells& cells) {
    if (nodes < 0 || static_cast<std::uint64_t>(nodes) > numbers_.size() - at_) at_ = numbers_.size(), next();
    for (std::int64_t n = 0; n < nodes; ++n) {
      const std::int64_t node = numbers_[at_++] - base_;
      cells.connectivity.push_back(node < 0 || node >= UINT32_MAX ? UINT32_MAX : static_cast<std::uint32_t>(node));
    }
    cells.types.push_back(type);
    cells.offsets.push_back(cells.connectivity.size());
  }

 private:
  std::span<const std::int64_t> numbers_;
  std::int64_t base_;
  const std::string& where_;
  std::size_t at_ = 0;
};

/// The number of the first point, which rewritten_xdmf() notes; Xdmf's library passes over it.
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
      const CellType& type = type_of(number < 0 ? 0 : static_cast<unsigned>(number), fmt::format("{}", number), where);
      numbers.add_cell(type.vtk, type.nodes > 0 ? type.nodes : numbers.next(), cells);
    }
    return cells;
  }
  const CellType& type = type_of(topology.getType()->getID(), topology.getType()->getName(), where);
  const std::int64_t nodes = topology.getType()->getNodesPerElement();
  if (nodes <= 0 || (type.nodes > 0 && nodes != type.nodes))
    throw scene::bad_input(fmt::format("{}: its cells have {} nodes each; write it anew", where, nodes));
  while (!numbers.at_end()) numbers.add_cell(type.vtk, nodes, cells);
  return cells;
}

}  // namespace tessera::readers
