// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkDataObject.h>
#include <vtkDataSet.h>
#include <vtkDataSetReader.h>
#include <vtkIdList.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkMultiBlockPLOT3DReader.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkSTLReader.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLRectilinearGridReader.h>
#include <vtkXMLStructuredGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <span>

#include "cells/curved/node_orders.hpp"
#include "io/files/input_file.hpp"
#include "io/vtk/vtk_xml_elements.hpp"
#include "readers/common/readers.hpp"
#include "readers/vtk/extents.hpp"
#include "readers/vtk/grid_pieces.hpp"
#include "readers/vtk/legacy_byte_order.hpp"
#include "readers/vtk/legacy_words.hpp"
#include "readers/vtk/vtk_parts.hpp"
#include "readers/vtk/vtk_session.hpp"
#include "readers/vtk/vtk_words.hpp"
#include "scene/error.hpp"
#include "system/positional_file.hpp"

namespace tessera::readers {
namespace {

/// A reader of structured data that exposes the pieces of the file.
template <class Reader>
class WithPieces final : public Reader {
 public:
  static WithPieces* New() {
    auto* const made = new WithPieces;
    made->InitializeObjectBase();
    return made;
  }

  /// Throws unless the pieces fill the whole extent, because VTK leaves values outside the pieces uninitialized. Must
  /// be called after UpdateInformation().
  void require_whole(const std::string& source) const {
    Extent whole{};
    std::copy_n(this->WholeExtent, 6, whole.begin());
    std::vector<Extent> pieces(static_cast<std::size_t>(std::max(this->NumberOfPieces, 0)));
    for (std::size_t n = 0; n < pieces.size(); ++n) {
      std::copy_n(this->PieceExtents + 6 * n, 6, pieces[n].begin());
      if (cells_in(pieces[n]) > 0 && !holds(whole, pieces[n]))
        throw scene::bad_input(fmt::format("{}: piece {} has the points {}, but the whole has {}; {}", source, n,
                                           words_of(pieces[n]), words_of(whole), write_again));
    }
    const double cells = cells_in(whole), covered = cells_covered(pieces);
    if (covered < cells)
      throw scene::bad_input(fmt::format(
          "{}: its pieces have only {:.0f} of its {:.0f} cells: the whole has the points {}, the pieces only {}; {}",
          source, covered, cells, words_of(whole), words_of(box_of(pieces)), write_again));
  }
};

template <class Reader>
vtkSmartPointer<vtkDataObject> read_structured(const std::string& source) {
  const auto reader = vtkSmartPointer<WithPieces<Reader>>::Take(WithPieces<Reader>::New());
  watch_progress(*reader);
  reader->SetFileName(source.c_str());
  reader->UpdateInformation();
  reader->require_whole(source);
  reader->Update();
  return reader->GetOutputDataObject(0);
}

/// Corrects an error of VTK's reader: after each piece, it reorders the nodes of old hexahedra in all pieces read so
/// far, so that the nodes of earlier pieces are reordered twice.
class OldCellsOnce final : public vtkXMLUnstructuredGridReader {
 public:
  static OldCellsOnce* New() {
    auto* const made = new OldCellsOnce;
    made->InitializeObjectBase();
    return made;
  }

 protected:
  int ReadPieceData() override {
    const vtkIdType before = StartCell;
    const int success = vtkXMLUnstructuredGridReader::ReadPieceData();
    const bool is_old = GetFileMajorVersion() < 2 || (GetFileMajorVersion() == 2 && GetFileMinorVersion() < 1);
    auto* const grid = vtkUnstructuredGrid::SafeDownCast(GetCurrentOutput());
    if (success != 0 && is_old && grid != nullptr && NumberOfCells[Piece] > 0) exchange_edges(*grid, before);
    return success;
  }

 private:
  static void exchange_edges(vtkUnstructuredGrid& grid, vtkIdType cells) {
    vtkDataArray* const degrees = grid.GetCellData()->GetArray("HigherOrderDegrees");
    const vtkNew<vtkIdList> nodes;
    for (vtkIdType cell = 0; cell < cells; ++cell) {
      const int type = grid.GetCellType(cell);
      if (type != VTK_HIGHER_ORDER_HEXAHEDRON && type != VTK_LAGRANGE_HEXAHEDRON && type != VTK_BEZIER_HEXAHEDRON)
        continue;
      grid.GetCells()->GetCellAtId(cell, nodes);
      std::array<int, 3> orders{};
      if (degrees != nullptr && degrees->GetNumberOfComponents() == 3)
        for (int axis = 0; axis < 3; ++axis)
          orders[static_cast<std::size_t>(axis)] = static_cast<int>(degrees->GetComponent(cell, axis));
      cells::exchange_vtk8_edges(std::span(nodes->GetPointer(0), static_cast<std::size_t>(nodes->GetNumberOfIds())),
                                 orders);
      grid.GetCells()->ReplaceCellAtId(cell, nodes);
    }
  }
};

vtkSmartPointer<vtkDataObject> read_unstructured(const std::string& source) {
  const auto reader = vtkSmartPointer<OldCellsOnce>::Take(OldCellsOnce::New());
  watch_progress(*reader);
  reader->SetFileName(source.c_str());
  reader->Update();
  return reader->GetOutputDataObject(0);
}

vtkSmartPointer<vtkDataObject> read_surface(const std::string& source) {
  vtkNew<vtkXMLPolyDataReader> reader;
  watch_progress(*reader);
  reader->SetFileName(source.c_str());
  reader->Update();
  return reader->GetOutputDataObject(0);
}

/// Converts the triangle strips of a surface to polygons. Every other triangle of a strip has the opposite orientation.
void add_strips(vtkPolyData& surface) {
  vtkCellArray* const strips = surface.GetStrips();
  if (strips == nullptr || strips->GetNumberOfCells() == 0) return;
  vtkNew<vtkCellArray> polygons;
  if (surface.GetPolys() != nullptr) polygons->DeepCopy(surface.GetPolys());
  vtkNew<vtkIdList> strip;
  for (vtkIdType s = 0; s < strips->GetNumberOfCells(); ++s) {
    strips->GetCellAtId(s, strip);
    for (vtkIdType k = 0; k + 2 < strip->GetNumberOfIds(); ++k) {
      const std::array<vtkIdType, 3> triangle = {strip->GetId(k + k % 2), strip->GetId(k + 1 - k % 2),
                                                 strip->GetId(k + 2)};
      polygons->InsertNextCell(3, triangle.data());
    }
  }
  surface.SetPolys(polygons);
}

/// Reads legacy VTK. At an unexpected word, VTK's reader stops, and does not always report an error.
vtkSmartPointer<vtkDataObject> read_legacy(const std::filesystem::path& file, std::string& warning) {
  const std::string source = file.string();
  const auto name_odd_word = [&] {
    if (const std::string odd = odd_legacy_word(file); !odd.empty())
      throw scene::bad_input(fmt::format("{}: {}; correct it, or have the file written again", source, odd));
  };
  vtkSmartPointer<vtkDataObject> data;
  try {
    warning = with_quiet_vtk(source, write_again, [&] {
      vtkNew<vtkDataSetReader> reader;
      read_all_arrays(*reader, source);
      data = reader->GetOutputDataObject(0);
    });
  } catch (const scene::Error&) {
    name_odd_word();
    throw;
  }
  if (auto* const set = vtkDataSet::SafeDownCast(data); set != nullptr && set->GetNumberOfCells() == 0) name_odd_word();
  return data;
}

vtkSmartPointer<vtkDataObject> read_xml(const std::string& source, const std::string& type) {
  if (type == "ImageData") return read_structured<vtkXMLImageDataReader>(source);
  if (type == "RectilinearGrid") return read_structured<vtkXMLRectilinearGridReader>(source);
  if (type == "StructuredGrid") return read_structured<vtkXMLStructuredGridReader>(source);
  if (type == "PolyData") return read_surface(source);
  return read_unstructured(source);
}

io::ForeignContents contents_of_data(Holdings& holdings, vtkDataObject* data, const std::string& source,
                                     const std::string& warning) {
  if (data == nullptr) throw scene::bad_input(fmt::format("{}: nothing can be read; write the file again", source));
  io::ForeignContents contents;
  if (!warning.empty()) contents.notes.push_back("VTK warns: " + warning);
  contents.parts = parts_of(holdings, *data, source);
  return contents;
}

}  // namespace

void require_whole_xml(const std::filesystem::path& file) {
  const system::PositionalFile opened(file);
  std::string end(std::min<std::uint64_t>(opened.size(), 1024), '\0');
  opened.read(opened.size() - end.size(), reinterpret_cast<std::byte*>(end.data()), end.size());
  if (end.find("</VTKFile") == std::string::npos)
    throw scene::bad_input(fmt::format("{}: it does not end with </VTKFile>; {}", file.string(), write_again));
  io::require_vtk_xml_form(opened, file.string());
}

vtkSmartPointer<vtkDataObject> read_xml_file(const std::filesystem::path& file, const std::string& type,
                                             std::string& warning) {
  allow_for(file);
  require_whole_xml(file);
  vtkSmartPointer<vtkDataObject> data;
  warning = with_quiet_vtk(file.string(), write_again, [&] { data = read_xml(file.string(), type); });
  return data;
}

io::ForeignContents read_vtk_xml(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request) {
  const auto type = request.at("type").get<std::string>();
  std::vector<std::string> warnings;
  std::string warning;
  vtkSmartPointer<vtkDataObject> data;
  if (type == "PImageData")
    data = read_grid_pieces(file, GridKind::image, warnings);
  else if (type == "PRectilinearGrid")
    data = read_grid_pieces(file, GridKind::rectilinear, warnings);
  else if (type == "PStructuredGrid")
    data = read_grid_pieces(file, GridKind::structured, warnings);
  else
    data = read_xml_file(file, type, warning);
  io::ForeignContents contents = contents_of_data(holdings, data, file.string(), warning);
  contents.notes.insert(contents.notes.end(), warnings.begin(), warnings.end());
  return contents;
}

io::ForeignContents read_vtk_legacy(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json&) {
  allow_for(file);
  require_big_endian(file);
  std::string warning;
  const vtkSmartPointer<vtkDataObject> data = read_legacy(file, warning);
  io::ForeignContents contents = contents_of_data(holdings, data, file.string(), warning);
  contents.format = fmt::format("legacy VTK ({})", data->GetClassName());
  return contents;
}

io::ForeignContents read_plot3d(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request) {
  allow_for(file);
  const std::string source = file.string();
  const auto q = request.at("q").get<std::string>();
  if (!q.empty()) allow_for(q);
  vtkSmartPointer<vtkDataObject> data;
  with_quiet_vtk(source, "grid or solution file is damaged, write it again", [&] {
    vtkNew<vtkMultiBlockPLOT3DReader> reader;
    watch_progress(*reader);
    reader->SetXYZFileName(source.c_str());
    if (!q.empty()) reader->SetQFileName(q.c_str());
    reader->SetBinaryFile(!request.at("text").get<bool>());
    reader->AutoDetectFormatOff();
    reader->SetByteOrder(request.at("big_endian").get<bool>() ? vtkMultiBlockPLOT3DReader::FILE_BIG_ENDIAN
                                                              : vtkMultiBlockPLOT3DReader::FILE_LITTLE_ENDIAN);
    reader->SetHasByteCount(request.at("record_marks").get<bool>());
    reader->SetMultiGrid(request.at("multi_grid").get<bool>());
    reader->SetDoublePrecision(request.at("double_precision").get<bool>());
    reader->SetIBlanking(request.at("iblank").get<bool>());
    reader->Update();
    data = reader->GetOutputDataObject(0);
  });
  io::ForeignContents contents = contents_of_data(holdings, data, source, "");
  contents.format = "PLOT3D";
  return contents;
}

io::ForeignContents read_stl(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json&) {
  allow_for(file);
  const std::string source = file.string();
  vtkSmartPointer<vtkDataObject> data;
  with_quiet_vtk(source, "the file is truncated, damaged or of another kind, write it again", [&] {
    vtkNew<vtkSTLReader> reader;
    reader->MergingOff();  // merge_coincident_points() merges points
    watch_progress(*reader);
    reader->SetFileName(source.c_str());
    reader->Update();
    data = reader->GetOutput();
  });
  return contents_of_data(holdings, data, source, "");
}

io::ForeignContents read_vtk_surface(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json&) {
  const std::string source = file.string();
  std::string warning;
  vtkSmartPointer<vtkDataObject> data;
  if (io::read_beginning(file, 5) == "# vtk") {
    allow_for(file);
    require_big_endian(file);
    data = read_legacy(file, warning);
  } else {
    data = read_xml_file(file, "PolyData", warning);
  }
  if (auto* surface = vtkPolyData::SafeDownCast(data)) add_strips(*surface);
  return contents_of_data(holdings, data, source, warning);
}

}  // namespace tessera::readers
