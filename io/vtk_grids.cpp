#include <fmt/format.h>
#include <vtkAOSDataArrayTemplate.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSetReader.h>
#include <vtkImageData.h>
#include <vtkMatrix3x3.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkRectilinearGrid.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLRectilinearGridReader.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/field_choice.hpp"
#include "io/grid_pieces.hpp"
#include "io/input_file.hpp"
#include "io/mapped_file.hpp"
#include "io/volume_formats.hpp"
#include "io/vtk_blocks.hpp"
#include "io/vtk_checks.hpp"
#include "io/vtk_session.hpp"

namespace tessera::io {
namespace {

using scene::Association;
using scene::SampleType;

/// The stored type of a plain array, none for bits, 64-bit integers and arrays of other layout.
std::optional<SampleType> stored_vtk_type(vtkDataArray& array) {
  switch (array.GetDataType()) {
    case VTK_CHAR:
      return std::numeric_limits<char>::is_signed ? SampleType::int8 : SampleType::uint8;
    case VTK_SIGNED_CHAR:
      return SampleType::int8;
    case VTK_UNSIGNED_CHAR:
      return SampleType::uint8;
    case VTK_SHORT:
      return SampleType::int16;
    case VTK_UNSIGNED_SHORT:
      return SampleType::uint16;
    case VTK_INT:
      return SampleType::int32;
    case VTK_UNSIGNED_INT:
      return SampleType::uint32;
    case VTK_FLOAT:
      return SampleType::float32;
    case VTK_DOUBLE:
      return SampleType::float64;
    default:
      return std::nullopt;
  }
}

enum class VtkGridKind { legacy, image, image_pieces, rectilinear, rectilinear_pieces };

vtkSmartPointer<vtkDataSet> read_xml_grid(const std::string& source, VtkGridKind kind) {
  vtkSmartPointer<vtkXMLReader> reader;
  if (kind == VtkGridKind::image)
    reader = vtkSmartPointer<vtkXMLImageDataReader>::New();
  else
    reader = vtkSmartPointer<vtkXMLRectilinearGridReader>::New();
  reader->SetFileName(source.c_str());
  reader->Update();
  return vtkDataSet::SafeDownCast(reader->GetOutputDataObject(0));
}

vtkSmartPointer<vtkDataSet> read_vtk_volume_data(const std::filesystem::path& file, VtkGridKind kind,
                                                 std::vector<std::string>& notes) {
  const std::string source = file.string();
  const bool xml = kind != VtkGridKind::legacy;
  if (xml) {
    check_vtk_xml(file);
    require_xml_end(file);
    if (kind == VtkGridKind::image_pieces || kind == VtkGridKind::rectilinear_pieces)
      return read_grid_pieces(file, kind == VtkGridKind::image_pieces ? GridKind::image : GridKind::rectilinear, notes);
  } else {
    check_vtk_legacy(MappedFile(file).text(), source);
  }
  vtkSmartPointer<vtkDataSet> data;
  const std::string warning = with_quiet_vtk(source, "the file is truncated or damaged, write it anew", [&] {
    if (xml) {
      data = read_xml_grid(source, kind);
      return;
    }
    vtkNew<vtkDataSetReader> reader;
    read_all_arrays(*reader, source);
    data = reader->GetOutput();
  });
  if (!data) throw scene::bad_input(fmt::format("{}: nothing can be read; write it anew", source));
  if (!warning.empty()) notes.push_back("VTK warns: " + warning);
  return data;
}

void set_image_geometry(vtkImageData& image, scene::GridGeometry& g) {
  int extent[6];
  image.GetExtent(extent);
  const vtkMatrix3x3& matrix = *image.GetDirectionMatrix();
  std::array<glm::dvec3, 3> steps;
  for (int axis = 0; axis < 3; ++axis)
    steps[static_cast<std::size_t>(axis)] =
        glm::dvec3(matrix.GetElement(0, axis), matrix.GetElement(1, axis), matrix.GetElement(2, axis)) *
        image.GetSpacing()[axis];
  set_axes(g, steps);
  g.origin = {image.GetOrigin()[0], image.GetOrigin()[1], image.GetOrigin()[2]};
  for (int axis = 0; axis < 3; ++axis)  // origin is that of index 0, which need not be in the extent
    if (extent[2 * axis] != 0)
      g.origin += steps[static_cast<std::size_t>(axis)] * static_cast<double>(extent[2 * axis]);
}

/// Coordinates of an axis; falling ones are turned over by a mirrored direction.
void set_vtk_coordinates(vtkDataArray* array, int axis, const std::filesystem::path& file, scene::GridGeometry& g) {
  const auto a = static_cast<std::size_t>(axis);
  if (!array || array->GetNumberOfTuples() != g.points[a] || array->GetNumberOfComponents() != 1)
    throw damaged(file, fmt::format("it has {} coordinates along {} for {} points",
                                    array ? array->GetNumberOfTuples() : 0, "xyz"[axis], g.points[a]));
  std::vector<double> c(static_cast<std::size_t>(g.points[a]));
  for (std::size_t i = 0; i < c.size(); ++i) c[i] = array->GetComponent(static_cast<vtkIdType>(i), 0);
  if (c.size() > 1 && c.back() < c.front()) {
    for (double& x : c) x = -x;
    g.direction[axis] = -g.direction[axis];
  }
  g.coordinates[a] = std::move(c);
}

/// Makes a rectilinear grid regular whose coordinates are even but for their rounding: many writers know no other kind,
/// and regular grids are cast much faster.
void make_regular_if_even(vtkRectilinearGrid& grid, scene::GridGeometry& g) {
  vtkDataArray* const arrays[] = {grid.GetXCoordinates(), grid.GetYCoordinates(), grid.GetZCoordinates()};
  glm::dvec3 first(0), spacing(1);
  for (std::size_t a = 0; a < 3; ++a) {
    const std::vector<double>& c = g.coordinates[a];
    if (c.size() < 2 || !(c.back() > c.front())) return;
    const double step = (c.back() - c.front()) / static_cast<double>(c.size() - 1);
    // Both ends are rounded, the sums and products of writer and reader by a few places of a double more.
    const double rounding = 2 * rounding_of(*arrays[a]) + 0x1p-50;
    const double most = std::min(rounding * std::max(std::abs(c.front()), std::abs(c.back())), 1e-3 * step);
    for (std::size_t i = 0; i < c.size(); ++i)
      if (!(std::abs(c[i] - (c.front() + step * static_cast<double>(i))) <= most)) return;
    first[static_cast<int>(a)] = c.front(), spacing[static_cast<int>(a)] = step;
  }
  g.origin += g.direction * first;
  g.spacing = spacing;
  g.coordinates = {};
}

scene::GridGeometry vtk_geometry_of(vtkDataSet& data, const std::filesystem::path& file) {
  scene::GridGeometry g;
  int dims[3] = {0, 0, 0};
  if (auto* image = vtkImageData::SafeDownCast(&data)) {
    image->GetDimensions(dims);
    g.points = {dims[0], dims[1], dims[2]};
    set_image_geometry(*image, g);
  } else if (auto* grid = vtkRectilinearGrid::SafeDownCast(&data)) {
    grid->GetDimensions(dims);
    g.points = {dims[0], dims[1], dims[2]};
    set_vtk_coordinates(grid->GetXCoordinates(), 0, file, g);
    set_vtk_coordinates(grid->GetYCoordinates(), 1, file, g);
    set_vtk_coordinates(grid->GetZCoordinates(), 2, file, g);
    make_regular_if_even(*grid, g);
  } else {
    throw scene::bad_input(fmt::format("{}: it holds {}, no regular or rectilinear grid; give a volume", file.string(),
                                       data.GetClassName()));
  }
  return g;
}

/// Indices of samples that the file hides, by vtkGhostType: hidden points (2), or hidden cells (32) of cell data.
std::vector<std::size_t> hidden_samples(vtkDataSet& data, Association association, std::vector<std::string>& notes) {
  std::vector<std::size_t> hidden;
  const bool point = association == Association::point;
  vtkUnsignedCharArray* ghosts = point ? data.GetPointGhostArray() : data.GetCellGhostArray();
  const unsigned char bit = point ? 2 : 32;
  if (ghosts)
    for (vtkIdType k = 0; k < ghosts->GetNumberOfTuples(); ++k)
      if ((ghosts->GetValue(k) & bit) != 0) hidden.push_back(static_cast<std::size_t>(k));
  if (point && data.GetCellGhostArray()) {
    vtkUnsignedCharArray& cells = *data.GetCellGhostArray();
    for (vtkIdType k = 0; k < cells.GetNumberOfTuples(); ++k)
      if ((cells.GetValue(k) & 32) != 0) {
        notes.emplace_back("hidden cells are shown: they apply to cell data only");
        break;
      }
  }
  return hidden;
}

std::unique_ptr<scene::MemorySource> vtk_source_of(vtkDataSet& data, const FieldChoice& choice, const BlockField& field,
                                                   scene::Grid grid, const std::string& name,
                                                   std::vector<std::string>& notes) {
  vtkDataSetAttributes& attributes = choice.association == Association::point
                                         ? static_cast<vtkDataSetAttributes&>(*data.GetPointData())
                                         : *data.GetCellData();
  vtkSmartPointer<vtkDataArray> array = attributes.GetArray(choice.name.c_str());
  const auto hidden = hidden_samples(data, choice.association, notes);
  const bool plain = array && stored_vtk_type(*array).has_value();
  const SampleType type = plain ? stored_vtk_type(*array).value_or(SampleType::float64) : SampleType::float64;
  // Floats hold numbers of up to 16 bits, and magnitudes of floats.
  const bool narrow = scene::size_of(type) < 4 || type == SampleType::float32;
  if (plain && hidden.empty() && array->HasStandardMemoryLayout()) {
    const auto bytes = static_cast<std::size_t>(array->GetNumberOfValues()) * scene::size_of(type);
    const std::span payload(static_cast<const std::byte*>(array->GetVoidPointer(0)), bytes);
    grid.type = choice.component != magnitude ? type : narrow ? SampleType::float32 : SampleType::float64;
    return std::make_unique<scene::MemorySource>(
        std::move(grid), payload, std::make_shared<vtkSmartPointer<vtkDataArray>>(array), name,
        scene::ComponentChoice{field.components, choice.component == magnitude ? -1 : choice.component, type});
  }
  std::vector<double> values(field.tuples);
  field.read(choice.component, 0, values);
  for (const std::size_t k : hidden) values[k] = std::numeric_limits<double>::quiet_NaN();
  if (!hidden.empty()) notes.push_back(fmt::format("{} hidden samples are blank", hidden.size()));
  if (narrow) return scene::MemorySource::of(std::move(grid), std::vector<float>(values.begin(), values.end()), name);
  return scene::MemorySource::of(std::move(grid), std::move(values), name);
}

}  // namespace

void require_xml_end(const std::filesystem::path& file) {
  const MappedFile mapped(file);
  const std::string_view text = mapped.text();
  if (text.substr(text.size() - std::min<std::size_t>(text.size(), 1024)).find("</VTKFile") == std::string_view::npos)
    throw damaged(file, "it does not end with </VTKFile>");
}

double rounding_of(vtkDataArray& array) {
  if (array.GetDataType() == VTK_FLOAT) return 0x1p-24;
  return array.GetDataType() == VTK_DOUBLE ? 0x1p-53 : 0;
}

VolumeFile read_vtk_grid(const std::filesystem::path& file, const VolumeOptions& options) {
  const std::string source = file.string(), beginning = read_beginning(file, 4096);
  const bool xml = !beginning.starts_with("# vtk DataFile");
  const VtkGridKind kind = !xml                                        ? VtkGridKind::legacy
                           : has_quoted(beginning, "PImageData")       ? VtkGridKind::image_pieces
                           : has_quoted(beginning, "PRectilinearGrid") ? VtkGridKind::rectilinear_pieces
                           : has_quoted(beginning, "ImageData")        ? VtkGridKind::image
                                                                       : VtkGridKind::rectilinear;
  VolumeFile result;
  const auto data = read_vtk_volume_data(file, kind, result.notes);
  scene::Grid grid;
  grid.geometry = vtk_geometry_of(*data, file);
  result.format = fmt::format("{} ({})", xml ? "VTK XML" : "legacy VTK",
                              grid.geometry.rectilinear() ? "rectilinear grid" : "image data");

  CellBlock block;  // only its fields are of use
  add_vtk_fields(*data, Association::point, static_cast<std::size_t>(data->GetNumberOfPoints()), block, source);
  add_vtk_fields(*data, Association::cell, static_cast<std::size_t>(data->GetNumberOfCells()), block, source);
  if (block.fields.empty()) throw scene::bad_input(fmt::format("{}: it has no field; write one with it", source));
  const std::vector<std::vector<FieldTally>> tallies = {tally_fields(std::span(&block, 1))};
  result.fields = summarize_fields(tallies);
  const FieldChoice choice = choose_field(options.field, result.fields, source);
  result.notes.insert(result.notes.end(), choice.notes.begin(), choice.notes.end());
  const BlockField* field = find_field(block, choice.name, choice.association);
  if (!field) throw scene::bad_input(fmt::format("{}: none of its fields can be shown; name one with `field`", source));
  grid.geometry.association = choice.association;
  grid.field_name = choice.label;
  scene::validate(grid, source);  // before an array is taken for samples that a flat grid has not
  result.source = vtk_source_of(*data, choice, *field, std::move(grid), source, result.notes);
  return result;
}

}  // namespace tessera::io
