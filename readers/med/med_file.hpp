// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <med.h>

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cells/cell_block.hpp"
#include "scene/time_step_read.hpp"
#include "tessera/cell_type.hpp"

namespace tessera::readers {

/// Volume cells that both MED and VTK support; cells/curved/node_orders.hpp has the order of their nodes.
struct MedCellKind {
  med_geometry_type med;
  CellType type;
  int nodes;
};
inline constexpr std::array med_cell_kinds = {MedCellKind{MED_TETRA4, CellType::tetra, 4},
                                              MedCellKind{MED_PYRA5, CellType::pyramid, 5},
                                              MedCellKind{MED_PENTA6, CellType::wedge, 6},
                                              MedCellKind{MED_HEXA8, CellType::hexahedron, 8},
                                              MedCellKind{MED_TETRA10, CellType::quadratic_tetra, 10},
                                              MedCellKind{MED_OCTA12, CellType::hexagonal_prism, 12},
                                              MedCellKind{MED_PYRA13, CellType::quadratic_pyramid, 13},
                                              MedCellKind{MED_PENTA15, CellType::quadratic_wedge, 15},
                                              MedCellKind{MED_PENTA18, CellType::biquadratic_quadratic_wedge, 18},
                                              MedCellKind{MED_HEXA20, CellType::quadratic_hexahedron, 20},
                                              MedCellKind{MED_HEXA27, CellType::triquadratic_hexahedron, 27}};

/// An open file. Every call that fails throws Error.
class MedFile {
 public:
  explicit MedFile(const std::filesystem::path& file);
  ~MedFile();
  MedFile(const MedFile&) = delete;
  MedFile& operator=(const MedFile&) = delete;

  [[nodiscard]] med_idt id() const { return id_; }
  [[nodiscard]] const std::string& source() const { return source_; }
  void require(bool good, const std::string& what) const;

 private:
  std::string source_;
  med_idt id_ = -1;
};

/// One mesh of the file, as a block without fields.
struct MedMesh {
  cells::CellBlock block;
  std::vector<std::size_t> cells_of_kind;  ///< for each entry of med_cell_kinds, its number of cells, which are
                                           ///< consecutive in the block
};

/// Returns all three-dimensional meshes; notes name the other meshes. Throws Error(bad_input) for polyhedra, and if
/// there is no three-dimensional mesh.
std::vector<MedMesh> med_meshes(const MedFile& file, std::vector<std::string>& notes);

/// Adds the fields of the nodes and cells of meshes at one time step, counted from 0, or at the last; `read` receives
/// the step. Missing values are NaN. Throws Error(bad_input) if no field has this step.
void add_med_fields(const MedFile& file, std::optional<std::size_t> time_step, std::vector<MedMesh>& meshes,
                    std::vector<std::string>& notes, scene::TimeStepRead& read);

}  // namespace tessera::readers
