// SPDX-License-Identifier: BSD-3-Clause
#include "readers/vtk/vtk_parts.hpp"

#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCompositeDataIterator.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkDataSet.h>
#include <vtkIdTypeArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkMatrix3x3.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkPartitionedDataSet.h>
#include <vtkPartitionedDataSetCollection.h>
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
#include <cstdint>
#include <cstring>
#include <string_view>

#include "scene/error.hpp"

namespace tessera::readers {
namespace {

/// Returns our type. VTK packs eight bits into a byte; here each bit becomes a byte.
NumberType type_of(int vtk_type) {
  switch (vtk_type) {
    case VTK_CHAR:
    case VTK_SIGNED_CHAR:
      return NumberType::int8;
    case VTK_UNSIGNED_CHAR:
    case VTK_BIT:
      return NumberType::uint8;
    case VTK_SHORT:
      return NumberType::int16;
    case VTK_UNSIGNED_SHORT:
      return NumberType::uint16;
    case VTK_INT:
      return NumberType::int32;
    case VTK_UNSIGNED_INT:
      return NumberType::uint32;
    case VTK_LONG:
    case VTK_LONG_LONG:
    case VTK_ID_TYPE:
      return NumberType::int64;
    case VTK_UNSIGNED_LONG:
    case VTK_UNSIGNED_LONG_LONG:
      return NumberType::uint64;
    case VTK_FLOAT:
      return NumberType::float32;
    default:
      return NumberType::float64;
  }
}

/// Returns the same numbers in contiguous tuples.
vtkSmartPointer<vtkDataArray> plain(vtkDataArray& array) {
  if (array.HasStandardMemoryLayout() && array.GetDataType() != VTK_BIT) return &array;
  const int type = array.GetDataType() == VTK_BIT ? VTK_UNSIGNED_CHAR : array.GetDataType();
  auto copy = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type));
  copy->DeepCopy(&array);
  copy->SetName(array.GetName());
  return copy;
}

io::ForeignArray hold(Holdings& holdings, vtkDataArray& given) {
  const vtkSmartPointer<vtkDataArray> array = plain(given);
  io::ForeignArray held;
  held.type = type_of(array->GetDataType());
  held.components = std::max(array->GetNumberOfComponents(), 1);
  held.tuples = static_cast<std::uint64_t>(std::max<vtkIdType>(array->GetNumberOfTuples(), 0));
  return holdings.hold(std::move(held), array->GetVoidPointer(0),
                       std::make_shared<const vtkSmartPointer<vtkDataArray>>(array));
}

std::optional<io::ForeignArray> hold_any(Holdings& holdings, vtkDataArray* array) {
  return array != nullptr ? std::optional(hold(holdings, *array)) : std::nullopt;
}

cells::NumberTally tally_of(vtkDataArray& given) {
  const vtkSmartPointer<vtkDataArray> array = plain(given);
  const NumberType type = type_of(array->GetDataType());
  const int components = array->GetNumberOfComponents();
  const auto tuples = static_cast<std::size_t>(array->GetNumberOfTuples());
  const std::span bytes(static_cast<const std::byte*>(array->GetVoidPointer(0)),
                        tuples * static_cast<std::size_t>(components) * io::size_of(type));
  cells::NumberTally tally;
  std::array<double, 4096> some;
  for (std::size_t first = 0; first < tuples; first += some.size()) {
    const std::span chunk(some.data(), std::min(some.size(), tuples - first));
    io::read_tuples(bytes, type, components, components == 1 ? 0 : cells::magnitude, first, chunk);
    tally.add(chunk);
  }
  return tally;
}

std::optional<io::ForeignArray> hold_points(Holdings& holdings, vtkPoints* points) {
  return points != nullptr ? hold_any(holdings, points->GetData()) : std::nullopt;
}

template <class Grid>
void set_extent(Grid& grid, io::ForeignPart& part) {
  std::array<int, 6> extent{};
  grid.GetExtent(extent.data());
  std::copy(extent.begin(), extent.end(), part.extent.begin());
}

/// Converts indices to uint32; those that do not fit become the largest uint32.
template <class Index>
void narrow_indices(const Index* indices, std::size_t count, std::byte* out) {
  for (std::size_t k = 0; k < count; ++k) {
    const auto index = static_cast<std::uint64_t>(indices[k]);  // a negative index becomes a huge number
    const auto narrow = static_cast<std::uint32_t>(std::min<std::uint64_t>(index, UINT32_MAX));
    std::memcpy(out + k * sizeof narrow, &narrow, sizeof narrow);
  }
}

/// Adds the point indices of cells, which take half the bytes of VTK's.
io::ForeignArray hold_indices(Holdings& holdings, vtkDataArray& array, int components) {
  io::ForeignArray held;
  held.type = NumberType::uint32;
  held.components = components;
  const auto count = static_cast<std::size_t>(array.GetNumberOfValues()) / static_cast<std::size_t>(components) *
                     static_cast<std::size_t>(components);
  held.tuples = count / static_cast<std::size_t>(components);
  const auto width = static_cast<std::size_t>(components);
  return holdings.hold(std::move(held), [owner = vtkSmartPointer<vtkDataArray>(&array), width](
                                            std::uint64_t first, std::uint64_t tuples, std::byte* out) {
    const void* const numbers = owner->GetVoidPointer(0);
    if (owner->GetDataTypeSize() == 8)
      narrow_indices(static_cast<const std::int64_t*>(numbers) + first * width, tuples * width, out);
    else
      narrow_indices(static_cast<const std::int32_t*>(numbers) + first * width, tuples * width, out);
  });
}

/// Whether all cells are tets, which is the case in most large meshes.
bool are_tets(vtkUnsignedCharArray& types, vtkCellArray& cells) {
  const vtkIdType count = types.GetNumberOfValues();
  if (count == 0 || cells.GetNumberOfCells() != count || cells.GetNumberOfConnectivityIds() != 4 * count) return false;
  const unsigned char* const type = types.GetPointer(0);
  if (std::any_of(type, type + count, [](unsigned char t) { return t != VTK_TETRA; })) return false;
  const auto in_steps = [count](const auto* offsets) {
    for (vtkIdType c = 0; c <= count; ++c)
      if (offsets->GetValue(c) != 4 * c) return false;
    return true;
  };
  return cells.IsStorage64Bit() ? in_steps(cells.GetOffsetsArray64()) : in_steps(cells.GetOffsetsArray32());
}

void set_cells(Holdings& holdings, vtkCellArray& cells, io::ForeignPart& part) {
  part.offsets = hold_any(holdings, cells.GetOffsetsArray());
  part.connectivity = hold_indices(holdings, *cells.GetConnectivityArray(), 1);
}

/// Sets the faces of polyhedra, if there are any.
void set_faces(Holdings& holdings, vtkUnstructuredGrid& grid, io::ForeignPart& part) {
  vtkIdTypeArray* const faces = grid.GetFaces();
  vtkIdTypeArray* const locations = grid.GetFaceLocations();
  if (faces == nullptr || locations == nullptr || faces->GetNumberOfValues() == 0) return;
  part.faces = hold_indices(holdings, *faces, 1);
  part.face_locations = hold(holdings, *locations);
}

io::ForeignPart part_of(Holdings& holdings, vtkDataSet& data, const std::string& name, const std::string& source) {
  io::ForeignPart part;
  part.name = name;
  if (auto* unstructured = vtkUnstructuredGrid::SafeDownCast(&data)) {
    part.points = hold_points(holdings, unstructured->GetPoints());
    vtkUnsignedCharArray* const types = unstructured->GetCellTypesArray();
    vtkCellArray* const cells = unstructured->GetCells();
    if (cells != nullptr && types != nullptr && are_tets(*types, *cells)) {
      part.connectivity = hold_indices(holdings, *cells->GetConnectivityArray(), 4);
    } else if (cells != nullptr && types != nullptr) {
      part.types = hold_any(holdings, types);
      set_cells(holdings, *cells, part);
      set_faces(holdings, *unstructured, part);
    }
  } else if (auto* surface = vtkPolyData::SafeDownCast(&data)) {
    part.kind = io::ForeignPart::Kind::surface;
    part.points = hold_points(holdings, surface->GetPoints());
    if (surface->GetPolys() != nullptr) set_cells(holdings, *surface->GetPolys(), part);
  } else if (auto* curvilinear = vtkStructuredGrid::SafeDownCast(&data)) {
    part.kind = io::ForeignPart::Kind::structured;
    set_extent(*curvilinear, part);
    part.points = hold_points(holdings, curvilinear->GetPoints());
  } else if (auto* rectilinear = vtkRectilinearGrid::SafeDownCast(&data)) {
    part.kind = io::ForeignPart::Kind::rectilinear;
    set_extent(*rectilinear, part);
    for (vtkDataArray* axis :
         {rectilinear->GetXCoordinates(), rectilinear->GetYCoordinates(), rectilinear->GetZCoordinates()})
      part.coordinates.push_back(axis != nullptr ? hold(holdings, *axis) : io::ForeignArray());
  } else if (auto* image = vtkImageData::SafeDownCast(&data)) {
    part.kind = io::ForeignPart::Kind::image;
    set_extent(*image, part);
    std::copy_n(image->GetOrigin(), 3, part.origin.begin());
    std::copy_n(image->GetSpacing(), 3, part.spacing.begin());
    std::copy_n(image->GetDirectionMatrix()->GetData(), 9, part.direction.begin());
  } else {
    throw scene::bad_input(
        fmt::format("{}: it contains {}, but no volume cells; give a mesh", source, data.GetClassName()));
  }
  part.point_fields = hold_fields(holdings, *data.GetPointData(), "point");
  part.cell_fields = hold_fields(holdings, *data.GetCellData(), "cell");
  return part;
}

using Names = std::map<const vtkDataObject*, std::string>;

/// Adds the names of the data sets of a tree. Each name is a path that includes the names of enclosing groups.
void add_names(vtkDataObject* data, const std::string& path, Names& names) {
  const auto add = [&](unsigned count, const auto& child, const auto& about) {
    for (unsigned k = 0; k < count; ++k) {
      vtkInformation* const facts = about(k);
      const char* const name = facts != nullptr ? facts->Get(vtkCompositeDataSet::NAME()) : nullptr;
      std::string_view own = name != nullptr ? name : "";
      own = own.substr(0, own.find_last_not_of(' ') + 1);  // EnSight pads names with blanks
      if (own.empty())
        add_names(child(k), path, names);
      else
        add_names(child(k), path.empty() ? std::string(own) : fmt::format("{}/{}", path, own), names);
    }
  };
  if (auto* blocks = vtkMultiBlockDataSet::SafeDownCast(data))
    add(
        blocks->GetNumberOfBlocks(), [&](unsigned k) { return blocks->GetBlock(k); },
        [&](unsigned k) { return blocks->HasMetaData(k) != 0 ? blocks->GetMetaData(k) : nullptr; });
  else if (auto* collection = vtkPartitionedDataSetCollection::SafeDownCast(data))
    add(
        collection->GetNumberOfPartitionedDataSets(), [&](unsigned k) { return collection->GetPartitionedDataSet(k); },
        [&](unsigned k) { return collection->HasMetaData(k) != 0 ? collection->GetMetaData(k) : nullptr; });
  else if (auto* pieces = vtkPartitionedDataSet::SafeDownCast(data))
    add(
        pieces->GetNumberOfPartitions(), [&](unsigned k) { return pieces->GetPartitionAsDataObject(k); },
        [&](unsigned k) { return pieces->HasMetaData(k) != 0 ? pieces->GetMetaData(k) : nullptr; });
  else if (data != nullptr && !path.empty())
    names.emplace(data, path);
}

}  // namespace

io::ForeignArray hold_array(Holdings& holdings, vtkDataArray& array) { return hold(holdings, array); }

std::vector<io::ForeignArray> hold_fields(Holdings& holdings, vtkDataSetAttributes& attributes, const char* unnamed) {
  std::vector<io::ForeignArray> fields;
  for (int k = 0; k < attributes.GetNumberOfArrays(); ++k) {
    vtkDataArray* const array = attributes.GetArray(k);  // null for arrays of strings
    if (array == nullptr || array->GetNumberOfComponents() < 1) continue;
    io::ForeignArray field = hold(holdings, *array);
    const char* const name = array->GetName();
    field.name = name != nullptr && *name != '\0' ? name : fmt::format("{}{}", unnamed, k);
    field.active = array == attributes.GetScalars() || array == attributes.GetVectors();
    field.ids = array == attributes.GetGlobalIds() || array == attributes.GetPedigreeIds();
    field.tally = tally_of(*array);
    fields.push_back(std::move(field));
  }
  return fields;
}

std::vector<io::ForeignPart> parts_of(Holdings& holdings, vtkDataObject& data, const std::string& source) {
  std::vector<io::ForeignPart> parts;
  if (auto* set = vtkDataSet::SafeDownCast(&data)) {
    parts.push_back(part_of(holdings, *set, "", source));
    return parts;
  }
  auto* composite = vtkCompositeDataSet::SafeDownCast(&data);
  if (composite == nullptr)
    throw scene::bad_input(fmt::format("{}: it contains {}, but no mesh; give a mesh", source, data.GetClassName()));
  const auto iterator = vtkSmartPointer<vtkCompositeDataIterator>::Take(composite->NewIterator());
  Names names;
  add_names(&data, "", names);
  for (iterator->InitTraversal(); !iterator->IsDoneWithTraversal(); iterator->GoToNextItem()) {
    auto* set = vtkDataSet::SafeDownCast(iterator->GetCurrentDataObject());
    if (set == nullptr || set->GetNumberOfCells() == 0) continue;
    const auto name = names.find(set);
    parts.push_back(part_of(holdings, *set,
                            name != names.end() ? name->second : fmt::format("{}", iterator->GetCurrentFlatIndex()),
                            source));
  }
  return parts;
}

}  // namespace tessera::readers
