// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tessera/export.hpp"

namespace tessera {
inline namespace v0_1 {

/// What files of a format contain.
enum class FileHolds : std::uint8_t {
  mesh,
  surface,       ///< a closed surface, which is filled with tets
  grid,          ///< regular or rectilinear: a volume
  grid_or_mesh,  ///< a grid, which Dataset::open() can also open as a mesh (ReadOptions::grid_as_mesh); files of NetCDF
                 ///< and XDMF contain a grid or a mesh
  series,        ///< a list of files, one per time step (tessera/time_series.hpp)
  not_read       ///< recognized only so that messages can name the format
};

/// One file format, from the table that the readers use.
struct FileFormat {
  std::string name;                     ///< "VTK XML unstructured grid", "NRRD", ...
  std::vector<std::string> extensions;  ///< in lower case, with the dot; may be empty
  FileHolds holds = FileHolds::mesh;
  std::string remark;                  ///< conditions and limits; for formats that are not read, the reason
  bool recognized_by_content = false;  ///< files are recognized even if the extension is wrong
  std::string left_out;  ///< the missing reader program ("tessera-read-vtk"); empty if the format can be read
};

/// All formats; those that are not read come last.
TESSERA_EXPORT std::vector<FileFormat> file_formats();

}  // namespace v0_1
}  // namespace tessera
