#include "io/vtk_blocks.hpp"

#include <fmt/format.h>
#include <vtkAOSDataArrayTemplate.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCompositeDataIterator.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkDataSet.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkRectilinearGrid.h>
#include <vtkSmartPointer.h>
#include <vtkStructuredGrid.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "io/tuple_length.hpp"
#include "scene/error.hpp"

namespace tessera::io {
namespace {

using scene::Association;

template <class T>
void copy_tuples(const T* values, int components, int component, std::size_t first, std::span<double> out) {
  const T* tuple = values + first * static_cast<std::size_t>(components);
  for (double& value : out) {
    value = component == magnitude ? tuple_length(tuple, components) : static_cast<double>(tuple[component]);
    tuple += components;
  }
}

void read_array(vtkDataArray& array, int component, std::size_t first, std::span<double> out) {
  const int components = array.GetNumberOfComponents();
  switch (array.GetDataType()) {
    vtkTemplateMacro(if (auto* plain = vtkAOSDataArrayTemplate<VTK_TT>::FastDownCast(&array)) {
      copy_tuples(plain->GetPointer(0), components, component, first, out);
      return;
    });
  }
  std::vector<double> tuple(static_cast<std::size_t>(components));  // bit arrays, structure-of-arrays storage
  for (std::size_t k = 0; k < out.size(); ++k) {
    array.GetTuple(static_cast<vtkIdType>(first) + static_cast<vtkIdType>(k), tuple.data());
    out[k] =
        component == magnitude ? tuple_length(tuple.data(), components) : tuple[static_cast<std::size_t>(component)];
  }
}

std::string type_name(const vtkDataArray& array) {
  const int type = array.GetDataType(), bits = 8 * array.GetDataTypeSize();
  if (type == VTK_FLOAT) return "float";
  if (type == VTK_DOUBLE) return "double";
  if (type == VTK_BIT) return "bit";
  const bool is_unsigned = type == VTK_UNSIGNED_CHAR || type == VTK_UNSIGNED_SHORT || type == VTK_UNSIGNED_INT ||
                           type == VTK_UNSIGNED_LONG || type == VTK_UNSIGNED_LONG_LONG;
  return fmt::format("{}int{}", is_unsigned ? "u" : "", bits);
}

void copy_points(vtkPoints* points, CellBlock& block, const std::string& source) {
  if (!points) return;
  vtkDataArray& xyz = *points->GetData();
  if (xyz.GetNumberOfComponents() != 3)
    throw scene::bad_input(
        fmt::format("{}: its points have {} coordinates; give x y z", source, xyz.GetNumberOfComponents()));
  const auto n = static_cast<std::size_t>(xyz.GetNumberOfTuples());
  block.positions.resize(n);
  const auto copy = [&](const auto* p) {
    for (std::size_t v = 0; v < n; ++v)
      block.positions[v] = {static_cast<double>(p[3 * v]), static_cast<double>(p[3 * v + 1]),
                            static_cast<double>(p[3 * v + 2])};
  };
  switch (xyz.GetDataType()) {
    vtkTemplateMacro(if (auto* plain = vtkAOSDataArrayTemplate<VTK_TT>::FastDownCast(&xyz)) {
      copy(plain->GetPointer(0));
      return;
    });
  }
  for (std::size_t v = 0; v < n; ++v) {
    std::array<double, 3> p;
    xyz.GetTuple(static_cast<vtkIdType>(v), p.data());
    block.positions[v] = {p[0], p[1], p[2]};
  }
}

/// Offsets and connectivity of either width, checked.
template <class Index>
void copy_cells(std::span<const Index> offsets, std::span<const Index> connectivity, CellBlock& block,
                const std::string& where) {
  const std::size_t cells = block.types.size();
  if (offsets.size() != cells + 1 || offsets[0] != 0 ||
      static_cast<std::uint64_t>(offsets[cells]) > connectivity.size())
    throw scene::bad_input(
        fmt::format("{}: cell offsets do not fit the {} cells and {} connectivity entries; the file "
                    "is damaged, write it anew",
                    where, cells, connectivity.size()));
  bool all_tets = true;
  for (std::size_t c = 0; c < cells; ++c) {
    if (offsets[c + 1] < offsets[c])
      throw scene::bad_input(
          fmt::format("{}: the offset of cell {} is {}, less than the one before, {}; the file is "
                      "damaged, write it anew",
                      where, c, offsets[c + 1], offsets[c]));
    all_tets = all_tets && block.types[c] == 10 && offsets[c + 1] - offsets[c] == 4;
  }
  const auto used = static_cast<std::size_t>(offsets[cells]);
  all_tets ? block.tets.resize(cells) : block.connectivity.resize(used);
  const auto points = static_cast<std::int64_t>(block.positions.size());
  for (std::size_t k = 0; k < used; ++k) {
    const auto v = static_cast<std::int64_t>(connectivity[k]);
    if (v < 0 || v >= points) {
      const auto cell = std::upper_bound(offsets.begin(), offsets.end(), static_cast<Index>(k)) - offsets.begin() - 1;
      throw scene::bad_input(
          fmt::format("{}: cell {} uses point {}, the file holds {}; write cells and points from "
                      "one mesh",
                      where, cell, v, points));
    }
    (all_tets ? block.tets[k / 4][k % 4] : block.connectivity[k]) = static_cast<std::uint32_t>(v);
  }
  if (all_tets) {
    block.types = {};
  } else {
    block.offsets.assign(offsets.begin(), offsets.end());
  }
}

void add_unstructured_cells(vtkUnstructuredGrid& grid, CellBlock& block, const std::string& where) {
  vtkUnsignedCharArray* types = grid.GetCellTypesArray();
  vtkCellArray* cells = grid.GetCells();
  if (!cells || !types) return;
  if (types->GetNumberOfValues() != cells->GetNumberOfCells())
    throw scene::bad_input(fmt::format("{}: {} cell types for {} cells; the file is damaged, write it anew", where,
                                       types->GetNumberOfValues(), cells->GetNumberOfCells()));
  block.types.assign(types->GetPointer(0), types->GetPointer(0) + types->GetNumberOfValues());
  const auto copy = [&](auto* offsets, auto* connectivity) {
    using Index = typename std::remove_pointer_t<decltype(offsets)>::ValueType;
    copy_cells(std::span<const Index>(offsets->GetPointer(0), static_cast<std::size_t>(offsets->GetNumberOfValues())),
               std::span<const Index>(connectivity->GetPointer(0),
                                      static_cast<std::size_t>(connectivity->GetNumberOfValues())),
               block, where);
  };
  if (cells->IsStorage64Bit())
    copy(cells->GetOffsetsArray64(), cells->GetConnectivityArray64());
  else
    copy(cells->GetOffsetsArray32(), cells->GetConnectivityArray32());
}

/// The hexahedra between n[0] x n[1] x n[2] points; a flat grid gives faces or lines, which are counted and skipped.
void add_grid_cells(const int (&n)[3], CellBlock& block, const std::string& where) {
  const auto points = static_cast<std::uint64_t>(std::max(n[0], 0)) * static_cast<std::uint64_t>(std::max(n[1], 0)) *
                      static_cast<std::uint64_t>(std::max(n[2], 0));
  if (points != block.positions.size())
    throw scene::bad_input(fmt::format("{}: {} x {} x {} points are promised, {} are there; the file is damaged", where,
                                       n[0], n[1], n[2], block.positions.size()));
  if (points == 0) return;
  if (points > std::numeric_limits<std::uint32_t>::max())
    throw scene::bad_input(
        fmt::format("{}: {} points in one block; split it into blocks below 2^32 points", where, points));
  std::size_t cells = 1;
  for (const int side : n) cells *= static_cast<std::size_t>(std::max(side - 1, 1));
  if (n[0] < 2 || n[1] < 2 || n[2] < 2) {
    block.types.assign(cells, 9);
    block.offsets.assign(cells + 1, 0);
    return;
  }
  block.types.assign(cells, 12);
  block.offsets.resize(cells + 1);
  for (std::size_t c = 0; c <= cells; ++c) block.offsets[c] = 8 * c;
  block.connectivity.reserve(8 * cells);
  const auto row = static_cast<std::uint32_t>(n[0]), slice = row * static_cast<std::uint32_t>(n[1]);
  for (int k = 0; k + 1 < n[2]; ++k)
    for (int j = 0; j + 1 < n[1]; ++j)
      for (int i = 0; i + 1 < n[0]; ++i) {
        const std::uint32_t v =
            static_cast<std::uint32_t>(i) + row * static_cast<std::uint32_t>(j) + slice * static_cast<std::uint32_t>(k);
        const std::uint32_t corner[8] = {v,         v + 1,         v + 1 + row,         v + row,
                                         v + slice, v + 1 + slice, v + 1 + row + slice, v + row + slice};
        block.connectivity.insert(block.connectivity.end(), corner, corner + 8);
      }
}

std::vector<double> axis(vtkDataArray* coordinates) {
  std::vector<double> values(coordinates ? static_cast<std::size_t>(coordinates->GetNumberOfTuples()) : 0);
  if (!values.empty()) read_array(*coordinates, 0, 0, values);
  return values;
}

void add_rectilinear_points(vtkRectilinearGrid& grid, const int (&n)[3], CellBlock& block, const std::string& where) {
  const std::vector<double> x = axis(grid.GetXCoordinates()), y = axis(grid.GetYCoordinates()),
                            z = axis(grid.GetZCoordinates());
  if (x.size() != static_cast<std::size_t>(n[0]) || y.size() != static_cast<std::size_t>(n[1]) ||
      z.size() != static_cast<std::size_t>(n[2]))
    throw scene::bad_input(fmt::format("{}: {} x {} x {} coordinates for {} x {} x {} points; the file is damaged",
                                       where, x.size(), y.size(), z.size(), n[0], n[1], n[2]));
  block.positions.reserve(x.size() * y.size() * z.size());
  for (const double c : z)
    for (const double b : y)
      for (const double a : x) block.positions.emplace_back(a, b, c);
}

/// Bits of vtkGhostType; the older vtkGhostLevels (0 is one's own) becomes "duplicate".
std::vector<std::uint8_t> ghost_bits(vtkDataSetAttributes& attributes, std::size_t n) {
  const auto read = [&](const char* name) {
    std::vector<std::uint8_t> bits;
    vtkDataArray* array = attributes.GetArray(name);
    if (!array || array->GetNumberOfComponents() != 1 || static_cast<std::size_t>(array->GetNumberOfTuples()) != n)
      return bits;
    bits.resize(n);
    for (std::size_t k = 0; k < n; ++k)
      bits[k] = static_cast<std::uint8_t>(static_cast<int>(array->GetComponent(static_cast<vtkIdType>(k), 0)));
    return bits;
  };
  std::vector<std::uint8_t> bits = read(vtkDataSetAttributes::GhostArrayName());
  if (bits.empty()) {
    bits = read("vtkGhostLevels");
    for (std::uint8_t& level : bits) level = level > 0 ? 1 : 0;
  }
  return bits;
}

std::string block_name(vtkCompositeDataIterator& iterator) {
  if (iterator.HasCurrentMetaData())
    if (const char* name = iterator.GetCurrentMetaData()->Get(vtkCompositeDataSet::NAME())) return name;
  return fmt::format("{}", iterator.GetCurrentFlatIndex());
}

}  // namespace

void add_vtk_fields(vtkDataSet& data, Association association, std::size_t expected, CellBlock& block,
                    const std::string& source) {
  const bool point = association == Association::point;
  vtkDataSetAttributes& attributes =
      point ? static_cast<vtkDataSetAttributes&>(*data.GetPointData()) : *data.GetCellData();
  for (int k = 0; k < attributes.GetNumberOfArrays(); ++k) {
    vtkSmartPointer<vtkDataArray> array = attributes.GetArray(k);  // null for arrays of strings
    if (!array || array->GetNumberOfComponents() < 1) continue;
    const char* given = array->GetName();
    const std::string name = given && *given ? given : fmt::format("{}{}", point ? "point" : "cell", k);
    if (static_cast<std::size_t>(array->GetNumberOfTuples()) != expected)
      throw scene::bad_input(fmt::format("{}: field '{}' has {} values for {} {}s; write it anew", source, name,
                                         array->GetNumberOfTuples(), expected, point ? "point" : "cell"));
    BlockField field;
    field.name = name;
    field.association = association;
    field.components = array->GetNumberOfComponents();
    field.type = type_name(*array);
    field.tuples = expected;
    field.active = array == attributes.GetScalars() || array == attributes.GetVectors();
    field.read = [array](int component, std::size_t first, std::span<double> out) {
      read_array(*array, component, first, out);
    };
    block.fields.push_back(std::move(field));
  }
}

CellBlock block_from_vtk(vtkDataSet& data, const std::string& name, const std::string& source) {
  CellBlock block;
  block.name = name;
  const std::string where = name.empty() ? source : fmt::format("{}: block '{}'", source, name);
  if (auto* unstructured = vtkUnstructuredGrid::SafeDownCast(&data)) {
    copy_points(unstructured->GetPoints(), block, where);
    add_unstructured_cells(*unstructured, block, where);
  } else if (auto* curvilinear = vtkStructuredGrid::SafeDownCast(&data)) {
    int n[3];
    curvilinear->GetDimensions(n);
    copy_points(curvilinear->GetPoints(), block, where);
    add_grid_cells(n, block, where);
  } else if (auto* rectilinear = vtkRectilinearGrid::SafeDownCast(&data)) {
    int n[3];
    rectilinear->GetDimensions(n);
    add_rectilinear_points(*rectilinear, n, block, where);
    add_grid_cells(n, block, where);
  } else if (vtkImageData::SafeDownCast(&data)) {
    throw scene::bad_input(fmt::format(
        "{}: it is a regular grid (image data), no mesh; render, info and convert take it as a volume", where));
  } else {
    throw scene::bad_input(fmt::format("{}: it holds {}, no cells of volume; give a mesh", where, data.GetClassName()));
  }
  block.point_ghost = ghost_bits(*data.GetPointData(), block.positions.size());
  block.cell_ghost = ghost_bits(*data.GetCellData(), block.cell_count());
  add_vtk_fields(data, Association::point, block.positions.size(), block, where);
  add_vtk_fields(data, Association::cell, block.cell_count(), block, where);
  return block;
}

std::vector<CellBlock> blocks_from_vtk(vtkDataObject& data, const std::string& source,
                                       std::vector<std::string>& notes) {
  std::vector<CellBlock> blocks;
  if (auto* set = vtkDataSet::SafeDownCast(&data)) {
    blocks.push_back(block_from_vtk(*set, "", source));
    return blocks;
  }
  auto* composite = vtkCompositeDataSet::SafeDownCast(&data);
  if (!composite)
    throw scene::bad_input(fmt::format("{}: it holds {}, no mesh; give a mesh", source, data.GetClassName()));
  const auto iterator = vtkSmartPointer<vtkCompositeDataIterator>::Take(composite->NewIterator());
  std::size_t surfaces = 0;
  for (iterator->InitTraversal(); !iterator->IsDoneWithTraversal(); iterator->GoToNextItem()) {
    auto* set = vtkDataSet::SafeDownCast(iterator->GetCurrentDataObject());
    if (!set || set->GetNumberOfCells() == 0) continue;
    if (vtkPolyData::SafeDownCast(set)) {
      ++surfaces;
      continue;
    }
    blocks.push_back(block_from_vtk(*set, block_name(*iterator), source));
  }
  if (surfaces > 0) notes.push_back(fmt::format("{} blocks are surfaces and are left out", surfaces));
  return blocks;
}

}  // namespace tessera::io
