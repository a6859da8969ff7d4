#include <fmt/format.h>
#include <vtkCellData.h>
#include <vtkDataObject.h>
#include <vtkDataSet.h>
#include <vtkDataSetReader.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkXMLRectilinearGridReader.h>
#include <vtkXMLStructuredGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <algorithm>
#include <array>

#include "io/grid_pieces.hpp"
#include "io/input_file.hpp"
#include "io/mapped_file.hpp"
#include "io/mesh_formats.hpp"
#include "io/mesh_parts.hpp"
#include "io/text_file.hpp"
#include "io/vtk_blocks.hpp"
#include "io/vtk_checks.hpp"
#include "io/vtk_session.hpp"
#include "io/xml_elements.hpp"
#include "scene/error.hpp"

namespace tessera::io {
namespace {

struct XmlKind {
  const char *extension, *type, *words;
};
constexpr std::array xml_kinds = {
    XmlKind{".vtu", "UnstructuredGrid", "VTK XML unstructured grid"},
    XmlKind{".pvtu", "PUnstructuredGrid", "VTK XML parallel unstructured grid"},
    XmlKind{".vts", "StructuredGrid", "VTK XML structured grid"},
    XmlKind{".pvts", "PStructuredGrid", "VTK XML parallel structured grid"},
    XmlKind{".vtr", "RectilinearGrid", "VTK XML rectilinear grid"},
    XmlKind{".pvtr", "PRectilinearGrid", "VTK XML parallel rectilinear grid"},
};

/// The value of `type` in <VTKFile type="...">; empty if the file does not begin like VTK XML.
std::string xml_type(const std::filesystem::path& file) {
  const std::string text = read_beginning(file, 4096);
  const std::size_t element = text.find("<VTKFile");
  if (element == std::string::npos) return "";
  const std::size_t end = text.find('>', element), key = text.find("type", element);
  if (key == std::string::npos || key > end) return "";
  const std::size_t open = text.find_first_of("\"'", key);
  if (open == std::string::npos) return "";
  const std::size_t close = text.find(text[open], open + 1);
  return close == std::string::npos ? "" : text.substr(open + 1, close - open - 1);
}

vtkSmartPointer<vtkXMLReader> make_xml_reader(const std::string& type) {
  vtkXMLReader* reader = nullptr;
  if (type == "UnstructuredGrid") reader = vtkXMLUnstructuredGridReader::New();
  if (type == "StructuredGrid") reader = vtkXMLStructuredGridReader::New();
  if (type == "RectilinearGrid") reader = vtkXMLRectilinearGridReader::New();
  return vtkSmartPointer<vtkXMLReader>::Take(reader);
}

void add_warning(const std::string& warning, std::vector<std::string>& notes) {
  if (warning.empty()) return;
  std::string note = "VTK warns: " + warning;
  // Once, though all pieces may give rise to it.
  if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(std::move(note));
}

constexpr const char* parallel_type = "PUnstructuredGrid";

const XmlKind* kind_of(const std::string& type) {
  const auto* kind = std::find_if(xml_kinds.begin(), xml_kinds.end(), [&](const XmlKind& k) { return type == k.type; });
  return kind == xml_kinds.end() ? nullptr : kind;
}

MeshBlocks named_format(const XmlKind& kind, const std::string& extension) {
  MeshBlocks result;
  result.format = kind.words;
  if (extension != kind.extension)
    result.notes.push_back(fmt::format("the file is a {}, read as {}", extension.substr(1), kind.words));
  return result;
}

vtkSmartPointer<vtkDataObject> read_xml(const std::string& source, const std::string& type,
                                        std::vector<std::string>& notes) {
  vtkSmartPointer<vtkDataObject> data;
  const std::string warning = with_quiet_vtk(source, "the file is truncated or damaged, write it anew", [&] {
    const auto reader = make_xml_reader(type);
    reader->SetFileName(source.c_str());
    reader->Update();
    data = reader->GetOutputDataObject(0);
  });
  if (!data) throw scene::bad_input(fmt::format("{}: nothing can be read; write it anew", source));
  add_warning(warning, notes);
  return data;
}

}  // namespace

bool has_vtk() { return true; }

MeshBlocks read_vtk_xml(const std::filesystem::path& file) {
  const std::string source = file.string(), extension = lower_extension(file), type = xml_type(file);
  const XmlKind* const kind = kind_of(type);
  if (type.empty())
    throw scene::bad_input(fmt::format("{}: it does not begin as a VTK XML file does; check that it is a {}", source,
                                       extension.substr(1)));
  if (type == "ImageData" || type == "PImageData")
    throw scene::bad_input(fmt::format(
        "{}: it is a regular grid (image data), no mesh; render, info and convert take it as a volume", source));
  if (!kind) throw scene::bad_input(fmt::format("{}: its type is '{}'; give a mesh", source, type));

  // Pieces one by one, so that the whole reads as its parts do, and faults name the piece.
  if (type == parallel_type) return read_pvtu_pieces(file, pvtu_pieces(file));
  check_vtk_xml(file);
  MeshBlocks result = named_format(*kind, extension);
  vtkSmartPointer<vtkDataObject> data;
  if (type == "PRectilinearGrid")
    data = read_grid_pieces(file, GridKind::rectilinear, result.notes);
  else if (type == "PStructuredGrid")
    data = read_grid_pieces(file, GridKind::structured, result.notes);
  else
    data = read_xml(source, type, result.notes);
  result.blocks = blocks_from_vtk(*data, source, result.notes);
  return result;
}

bool is_pvtu(const std::filesystem::path& file) { return xml_type(file) == parallel_type; }

std::vector<std::filesystem::path> pvtu_pieces(const std::filesystem::path& file) {
  const std::string source = file.string();
  std::vector<std::filesystem::path> pieces;
  each_xml_element(read_text_file(file), source, [&](const XmlElement& element) {
    if (element.name != "Piece") return;
    const std::string* name = element.find("Source");
    if (!name || name->empty())
      throw scene::bad_input(fmt::format("{}: piece {} has no Source; write it anew", source, pieces.size()));
    pieces.push_back(file.parent_path() / *name);
  });
  return pieces;
}

MeshBlocks read_pvtu_pieces(const std::filesystem::path& file, std::span<const std::filesystem::path> pieces) {
  MeshBlocks result = named_format(*kind_of(parallel_type), lower_extension(file));
  for (const std::filesystem::path& piece : pieces) {
    const std::string source = piece.string(), type = xml_type(piece);
    if (type != "UnstructuredGrid")
      throw scene::bad_input(
          type.empty() ? fmt::format("{}: it is a piece of {} and does not begin as a VTK XML file does; write it anew",
                                     source, file.string())
                       : fmt::format("{}: it is a piece of {} and its type is '{}', not 'UnstructuredGrid'; write both "
                                     "anew",
                                     source, file.string(), type));
    check_vtk_xml(piece);
    const auto data = read_xml(source, type, result.notes);
    for (CellBlock& block : blocks_from_vtk(*data, source, result.notes)) {
      block.source = source;
      result.blocks.push_back(std::move(block));
    }
  }
  return result;
}

MeshBlocks read_vtk_legacy(const std::filesystem::path& file) {
  const std::string source = file.string();
  if (!read_beginning(file, 64).starts_with("# vtk DataFile Version"))
    throw scene::bad_input(
        fmt::format("{}: it does not begin with '# vtk DataFile Version'; check that it is a legacy VTK file", source));
  check_vtk_legacy(MappedFile(file).text(), source);
  MeshBlocks result;
  vtkSmartPointer<vtkDataObject> data;
  const std::string warning = with_quiet_vtk(source, "the file is truncated or damaged, write it anew", [&] {
    vtkNew<vtkDataSetReader> reader;
    read_all_arrays(*reader, source);
    data = reader->GetOutputDataObject(0);
  });
  if (!data) throw scene::bad_input(fmt::format("{}: it holds no VTK data set; give a mesh", source));
  add_warning(warning, result.notes);
  result.format = fmt::format("legacy VTK ({})", data->GetClassName());
  result.blocks = blocks_from_vtk(*data, source, result.notes);
  return result;
}

}  // namespace tessera::io
