#include "tessera/file_formats.hpp"

#include <algorithm>

#include "io/file_kinds.hpp"
#include "io/mesh_formats.hpp"
#include "io/surface.hpp"
#include "io/volume_formats.hpp"

namespace tessera::io {
namespace {

const char* left_out(Needs needs) {
  const bool vtk = needs == Needs::vtk || needs == Needs::vtk_and_tetgen;
  const bool tetgen = needs == Needs::tetgen || needs == Needs::vtk_and_tetgen;
  if (vtk && !has_vtk()) return "VTK";
  if (needs == Needs::gmsh && !has_gmsh()) return "Gmsh";
  if (needs == Needs::dicom && !has_dicom()) return "GDCM";
  if (needs == Needs::xdmf && !has_xdmf()) return "Xdmf";
  if (needs == Needs::med && !has_med()) return "MED";
  return tetgen && !can_fill_surfaces() ? "TetGen" : "";
}

}  // namespace

}  // namespace tessera::io

namespace tessera {

std::vector<FileFormat> file_formats() {
  std::vector<FileFormat> formats;
  for (const io::FormatRow& row : io::format_rows()) {
    if (row.listed == io::FormatRow::Listed::no) continue;
    FileFormat format{row.name, {}, row.holds, row.remark, row.begins != nullptr, io::left_out(row.needs)};
    std::string_view rest = row.extensions;
    while (!rest.empty()) {
      const std::size_t end = std::min(rest.find(' '), rest.size());
      format.extensions.emplace_back(rest.substr(0, end));
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    formats.push_back(std::move(format));
  }
  return formats;
}

}  // namespace tessera
