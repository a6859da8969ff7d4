#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tessera::io {

/// What a higher-order cell looks like in its own coordinates (r, s, t), each 0 to 1. Corners are numbered as VTK's.
///
/// tet         r + s + t <= 1
/// hexahedron  the cube
/// wedge       r + s <= 1
/// pyramid     r and s <= 1 - t; not VTK's cube, so that its faces are the triangles of its neighbours
enum class CurvedFamily : std::uint8_t { tet, hexahedron, wedge, pyramid };

/// A place of the lattice on which a cell has nodes: node / order is its place in (r, s, t).
using LatticePlace = std::array<int, 3>;

/// The polynomials of a higher-order cell, by its lattice of nodes.
struct CurvedLattice {
  CurvedFamily family = CurvedFamily::tet;
  std::array<int, 3> order{};       ///< along r, s, t; one number for tets and pyramids, r and s alike for wedges
  std::vector<LatticePlace> nodes;  ///< of each of the cell's nodes; may be fewer than the lattice has (serendipity)
  std::vector<int> slot_of_place;   ///< where at(place) of cells' values is; -1: not of the lattice
  int slots = 0;                    ///< the lattice's places

  [[nodiscard]] int slot(const LatticePlace& p) const {
    const auto at = [](int number) { return static_cast<std::size_t>(number); };
    return slot_of_place[(at(p[2]) * at(order[1] + 1) + at(p[1])) * at(order[0] + 1) + at(p[0])];
  }
};

/// The lattice of a cell of one of VTK's types with so many nodes: 24 to 27, 29, 31, 32, 33 and Lagrange tetrahedra
/// (71), hexahedra (72) and wedges (73). `degrees` are those of VTK's HigherOrderDegrees, or zero: then hexahedra have
/// one order along all axes, and wedges as well. Nothing if the number of nodes is that of no such cell, or for other
/// types.
///
/// Source  The order of nodes is VTK's (vtkQuadraticTetra.h ..., vtkHigherOrderTetra.h, vtkHigherOrderHexahedron.h,
///         vtkHigherOrderWedge.h of 9.1).
std::optional<CurvedLattice> curved_lattice(std::uint8_t vtk_type, std::size_t nodes,
                                            const std::array<int, 3>& degrees = {});

/// A cell's corners in (r, s, t).
std::span<const LatticePlace> corners_of(CurvedFamily family);

/// A face: three or four corners, one after the other round it.
struct CurvedFace {
  int size;
  std::array<std::uint8_t, 4> corner;
};
std::span<const CurvedFace> faces_of(CurvedFamily family);

}  // namespace tessera::io
