// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <numbers>
#include <span>
#include <string_view>
#include <system_error>

#include "cells/curved/node_orders.hpp"
#include "io/files/input_file.hpp"
#include "readers/med/med_file.hpp"
#include "scene/error.hpp"

namespace tessera::readers {
namespace {

/// A mesh at its only computation step, or the first.
struct MeshAt {
  std::string name;
  med_int step = MED_NO_DT, iteration = MED_NO_IT;
  bool is_cylinder = false;  ///< coordinates are r, theta, z
  double angle_unit = 1;     ///< in radians
};

std::size_t count_of(const MedFile& file, const MeshAt& mesh, med_entity_type entity, med_geometry_type kind,
                     med_data_type what) {
  med_bool changed = MED_FALSE, moved = MED_FALSE;
  const med_int count = MEDmeshnEntity(file.id(), mesh.name.c_str(), mesh.step, mesh.iteration, entity, kind, what,
                                       what == MED_COORDINATE ? MED_NO_CMODE : MED_NODAL, &changed, &moved);
  return static_cast<std::size_t>(std::max<med_int>(count, 0));  // MED returns a negative number if there are none
}

void read_points(const MedFile& file, const MeshAt& mesh, cells::CellBlock& block) {
  const std::size_t count = count_of(file, mesh, MED_NODE, MED_NO_GEOTYPE, MED_COORDINATE);
  file.require(count > 0, "the number of nodes");
  std::vector<med_float> xyz(3 * count);
  file.require(MEDmeshNodeCoordinateRd(file.id(), mesh.name.c_str(), mesh.step, mesh.iteration, MED_FULL_INTERLACE,
                                       xyz.data()) >= 0,
               "the nodes");
  block.positions.reserve(count);
  for (std::size_t v = 0; v < count; ++v) {
    const double *const p = &xyz[3 * v], angle = mesh.angle_unit * p[1];
    if (mesh.is_cylinder)
      block.positions.emplace_back(p[0] * std::cos(angle), p[0] * std::sin(angle), p[2]);
    else
      block.positions.emplace_back(p[0], p[1], p[2]);
  }
}

/// Returns null for hexagonal prisms, whose nodes are in VTK's order.
const cells::NodeOrder* order_of(const MedCellKind& kind) {
  for (const cells::NodeOrder& order : cells::all_node_orders())
    if (order.convention == cells::NodeConvention::med && order.type == kind.type && order.nodes == kind.nodes)
      return &order;
  return nullptr;
}

void read_cells(const MedFile& file, const MeshAt& mesh, MedMesh& to) {
  cells::CellBlock& block = to.block;
  block.offsets.push_back(0);
  for (const MedCellKind& kind : med_cell_kinds) {
    const std::size_t count = count_of(file, mesh, MED_CELL, kind.med, MED_CONNECTIVITY);
    to.cells_of_kind.push_back(count);
    if (count == 0) continue;
    const auto nodes = static_cast<std::size_t>(kind.nodes);
    std::vector<med_int> corners(count * nodes);
    file.require(MEDmeshElementConnectivityRd(file.id(), mesh.name.c_str(), mesh.step, mesh.iteration, MED_CELL,
                                              kind.med, MED_NODAL, MED_FULL_INTERLACE, corners.data()) >= 0,
                 "the cells");
    const cells::NodeOrder* const order = order_of(kind);
    for (std::size_t c = 0; c < count; ++c) {
      for (std::size_t n = 0; n < nodes; ++n) {
        const med_int node = corners[c * nodes + n];  // counted from 1
        block.connectivity.push_back(node < 1 ? UINT32_MAX : static_cast<std::uint32_t>(node - 1));
      }
      if (order != nullptr) cells::to_vtk_order(*order, std::span(block.connectivity).last(nodes));
      block.types.push_back(vtk_number(kind.type));
      block.offsets.push_back(block.connectivity.size());
    }
  }
  // The index has one entry more than there are cells. In files of version 2, it has one entry even if there are no
  // cells.
  if (count_of(file, mesh, MED_CELL, MED_POLYHEDRON, MED_INDEX_FACE) > 1)
    throw scene::bad_input(fmt::format(
        "{}: mesh '{}' has polyhedra, which are not supported; split them, or write .vtu", file.source(), mesh.name));
}

/// Returns a name up to the first zero byte, without padding blanks.
std::string plain(std::string_view text) {
  std::string name(text.substr(0, text.find('\0')));
  name.resize(name.find_last_not_of(' ') + 1);
  return name;
}

/// Whether a file is shorter than the end address in HDF5's superblock (HDF5 File Format Specification, II.A).
bool ends_early(const std::filesystem::path& file) {
  const std::string beginning = io::read_beginning(file, 64);
  if (!beginning.starts_with("\x89HDF") || beginning.size() < 64) return beginning.starts_with("\x89HDF");
  const int version = beginning[8], bytes_of_address = beginning[version < 2 ? 13 : 9];
  if (bytes_of_address != sizeof(std::uint64_t)) return false;
  const std::size_t at = version == 0 ? 40 : version == 1 ? 44 : 28;
  std::uint64_t end = 0;
  std::memcpy(&end, beginning.data() + at, sizeof end);
  std::error_code unknown;
  const std::uintmax_t size = std::filesystem::file_size(file, unknown);
  return !unknown && size < end;
}

}  // namespace

MedFile::MedFile(const std::filesystem::path& file) : source_(file.string()) {
  med_bool is_hdf5 = MED_FALSE, is_known = MED_FALSE;
  // Checked here, because MED's library checks only the first bytes.
  if (ends_early(file) || MEDfileCompatibility(file.c_str(), &is_hdf5, &is_known) < 0 || is_hdf5 != MED_TRUE)
    throw scene::bad_input(fmt::format(
        "{}: it cannot be opened as HDF5, which MED files are; it is truncated or damaged, write it again", source_));
  if (is_known != MED_TRUE)
    throw scene::bad_input(
        fmt::format("{}: it is not an MED file of version 2.3 or later; have Salome save it again", source_));
  id_ = MEDfileOpen(file.c_str(), MED_ACC_RDONLY);
  require(id_ >= 0, "the file");
}

MedFile::~MedFile() {
  if (id_ >= 0) MEDfileClose(id_);
}

void MedFile::require(bool good, const std::string& what) const {
  if (!good)
    throw scene::bad_input(
        fmt::format("{}: {} cannot be read as MED; the file is truncated or damaged, write it again", source_, what));
}

std::vector<MedMesh> med_meshes(const MedFile& file, std::vector<std::string>& notes) {
  std::vector<MedMesh> meshes;
  const med_int count = MEDnMesh(file.id());
  file.require(count >= 0 && count < 100000, "the number of meshes");
  for (int m = 1; m <= count; ++m) {
    const med_int axes = MEDmeshnAxis(file.id(), m);
    file.require(axes > 0 && axes <= 3, "a mesh");
    std::array<char, MED_NAME_SIZE + 1> name{};
    std::array<char, MED_COMMENT_SIZE + 1> description{};
    std::array<char, MED_SNAME_SIZE + 1> time_unit{};
    std::array<char, 3 * MED_SNAME_SIZE + 1> axis_names{}, axis_units{};
    med_int dimensions = 0, cell_dimensions = 0, steps = 0;
    med_mesh_type type = MED_UNDEF_MESH_TYPE;
    med_sorting_type sorting = MED_SORT_UNDEF;
    med_axis_type axis_type = MED_UNDEF_AXIS_TYPE;
    file.require(MEDmeshInfo(file.id(), m, name.data(), &dimensions, &cell_dimensions, &type, description.data(),
                             time_unit.data(), &sorting, &steps, &axis_type, axis_names.data(), axis_units.data()) >= 0,
                 "a mesh");
    MeshAt mesh{plain(name.data())};
    if (type != MED_UNSTRUCTURED_MESH || dimensions != 3 ||
        (axis_type != MED_CARTESIAN && axis_type != MED_CYLINDRICAL)) {
      notes.push_back(fmt::format("mesh '{}' is {} and is left out", mesh.name,
                                  type != MED_UNSTRUCTURED_MESH ? "structured"
                                  : dimensions != 3             ? "not three-dimensional"
                                                                : "in spherical coordinates"));
      continue;
    }
    mesh.is_cylinder = axis_type == MED_CYLINDRICAL;
    const std::string_view units(axis_units.data(), axis_units.size());
    const std::string unit = plain(units.substr(MED_SNAME_SIZE, MED_SNAME_SIZE));
    if (unit.starts_with("deg") || unit.starts_with("Deg") || unit.starts_with("DEG") || unit == "\u00b0")
      mesh.angle_unit = std::numbers::pi / 180;
    med_float time = 0;
    if (steps > 0) MEDmeshComputationStepInfo(file.id(), mesh.name.c_str(), 1, &mesh.step, &mesh.iteration, &time);
    MedMesh read;
    read.block.name = mesh.name;
    read_points(file, mesh, read.block);
    read_cells(file, mesh, read);
    meshes.push_back(std::move(read));
  }
  if (meshes.empty())
    throw scene::bad_input(
        fmt::format("{}: it has no unstructured three-dimensional mesh{}{}; give a mesh in x, y and z", file.source(),
                    notes.empty() ? "" : ": ", fmt::join(notes, ", ")));
  return meshes;
}

}  // namespace tessera::readers
