// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tessera/export.hpp"

namespace tessera {
inline namespace v0_1 {

/// What a file of a format holds.
enum class FileHolds : std::uint8_t {
  mesh,
  surface,       ///< closed: it is filled with tets
  grid,          ///< regular or rectilinear: a volume
  grid_or_mesh,  ///< a grid, which Dataset::open gives as a mesh if asked (ReadOptions::grid_as_mesh); of some formats
                 ///< (NetCDF, XDMF) either by what is in the file
  series,        ///< a list of files, one a time step (tessera/time_series.hpp)
  not_read       ///< known, so that it can be refused by its name
};

/// One format of files, as the reader itself knows it.
struct FileFormat {
  std::string name;                     ///< "VTK XML unstructured grid", "NRRD", ...
  std::vector<std::string> extensions;  ///< in lower case, with the dot; may be empty
  FileHolds holds = FileHolds::mesh;
  std::string remark;              ///< what applies, and limits; of what is not read, why
  bool told_by_beginning = false;  ///< a wrong name does no harm
  std::string left_out;  ///< the reader program that is not installed ("tessera-read-vtk"); empty if it is read
};

/// All formats, those that are not read last.
TESSERA_EXPORT std::vector<FileFormat> file_formats();

}  // namespace v0_1
}  // namespace tessera
