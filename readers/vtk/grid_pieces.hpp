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

/// A grid in pieces (.pvti, .pvtr, .pvts), assembled: a vtkImageData, vtkRectilinearGrid or vtkStructuredGrid with the
/// arrays of the pieces. Each piece is read by itself, so that errors name it. VTK's own readers of grids in pieces
/// leave zeros where there is no piece, reinterpret bytes as another type, and dereference a null pointer if a piece is
/// damaged.
///
/// Pieces may overlap (ghost levels, or shared planes of points); the last one's samples are used. Origin and spacing
/// are the parallel file's; the direction, which VTK 9.1 omits there, is that of the first piece that has one. Throws
/// Error(bad_input) in one line if the pieces do not fill the whole, or if one is missing, damaged, of another kind,
/// smaller than the parallel file states, or has other arrays or coordinates than those before.
vtkSmartPointer<vtkDataSet> read_grid_pieces(const std::filesystem::path& file, GridKind kind,
                                             std::vector<std::string>& notes);

/// Throws Error(bad_input) for a VTK XML file that is truncated, which VTK silently completes with zeros, not well
/// formed, or so deeply nested that VTK's reader does not return.
void require_whole_xml(const std::filesystem::path& file);

/// Reads a VTK XML file, by the `type` of its <VTKFile>; not one in pieces. The pieces within it must fill the whole.
/// Throws Error(bad_input).
vtkSmartPointer<vtkDataObject> read_xml_file(const std::filesystem::path& file, const std::string& type,
                                             std::string& warning);

}  // namespace tessera::readers
