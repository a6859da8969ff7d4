// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkSmartPointer.h>

#include <filesystem>
#include <string>
#include <vector>

class vtkDataObject;
class vtkDataSet;

namespace tessera::readers {

enum class GridKind { image, rectilinear, structured };

/// Reads and assembles a grid in pieces (.pvti, .pvtr, .pvts): a vtkImageData, vtkRectilinearGrid or vtkStructuredGrid
/// with the arrays of the pieces. Each piece is read separately, so that errors name the piece. VTK's own readers of
/// grids in pieces leave zeros where there is no piece, reinterpret bytes as another type, and dereference a null
/// pointer if a piece is damaged.
///
/// Pieces may overlap (ghost levels, or shared planes of points); the samples of the last piece are used. Origin and
/// spacing are those of the parallel file. The direction, which VTK 9.1 does not write to that file, is that of the
/// first piece that has one. Throws Error(bad_input) with a message of one line if the pieces do not fill the whole
/// extent, or if a piece is missing, damaged, of another kind, smaller than the parallel file states, or has other
/// arrays or coordinates than the pieces before.
vtkSmartPointer<vtkDataSet> read_grid_pieces(const std::filesystem::path& file, GridKind kind,
                                             std::vector<std::string>& notes);

/// Throws Error(bad_input) for a VTK XML file that is truncated (VTK replaces the missing values by zeros without an
/// error), not well formed, or so deeply nested that VTK's reader does not return.
void require_whole_xml(const std::filesystem::path& file);

/// Reads a VTK XML file that does not list other files. `type` is that of its <VTKFile>. The pieces in the file must
/// fill the whole extent. Throws Error(bad_input).
vtkSmartPointer<vtkDataObject> read_xml_file(const std::filesystem::path& file, const std::string& type,
                                             std::string& warning);

}  // namespace tessera::readers
