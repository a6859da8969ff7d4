#include <fmt/format.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkMultiBlockPLOT3DReader.h>
#include <vtkNew.h>
#include <vtkSmartPointer.h>

#include "io/mesh_formats.hpp"
#include "io/plot3d_layout.hpp"
#include "io/vtk_blocks.hpp"
#include "io/vtk_session.hpp"
#include "scene/error.hpp"

namespace tessera::io {

MeshBlocks read_plot3d(const std::filesystem::path& file, const std::filesystem::path& q_file) {
  const std::string source = file.string();
  const Plot3dLayout layout = detect_plot3d(file);
  const std::filesystem::path q = q_file.empty() ? find_plot3d_solution(file) : q_file;
  MeshBlocks result;
  result.format = "PLOT3D";
  if (q.empty())
    result.notes.emplace_back("no solution (Q) file lies beside the grid: it has no field; name one by `q`");
  else if (const std::uint64_t left = check_plot3d_solution(q, layout); left > 0)
    result.notes.push_back(fmt::format("{} bytes after the solution in {} are not used", left, q.filename().string()));
  result.notes.push_back(
      fmt::format("PLOT3D: {} grid{}, {}-endian {}, {}, {}{}", layout.grids.size(), layout.grids.size() == 1 ? "" : "s",
                  layout.big_endian ? "big" : "little", layout.double_precision ? "float64" : "float32",
                  layout.record_marks ? "with record marks" : "no record marks", layout.iblank ? "IBLANK" : "no IBLANK",
                  q.empty() ? "" : fmt::format(", solution {}", q.filename().string())));

  vtkSmartPointer<vtkDataObject> data;
  with_quiet_vtk(source, "grid or solution file is damaged, write it anew", [&] {
    vtkNew<vtkMultiBlockPLOT3DReader> reader;
    reader->SetXYZFileName(source.c_str());
    if (!q.empty()) reader->SetQFileName(q.string().c_str());
    reader->BinaryFileOn();
    reader->AutoDetectFormatOff();
    reader->SetByteOrder(layout.big_endian ? vtkMultiBlockPLOT3DReader::FILE_BIG_ENDIAN
                                           : vtkMultiBlockPLOT3DReader::FILE_LITTLE_ENDIAN);
    reader->SetHasByteCount(layout.record_marks);
    reader->SetMultiGrid(layout.multi_grid);
    reader->SetDoublePrecision(layout.double_precision);
    reader->SetIBlanking(layout.iblank);
    reader->Update();
    data = reader->GetOutputDataObject(0);
  });
  if (!data) throw scene::bad_input(fmt::format("{}: nothing can be read; write it anew", source));
  result.blocks = blocks_from_vtk(*data, source, result.notes);
  if (result.blocks.size() == 1) result.blocks[0].name.clear();
  return result;
}

}  // namespace tessera::io
