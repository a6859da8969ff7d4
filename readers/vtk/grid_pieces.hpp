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

/// A grid in pieces (.pvti, .pvtr, .pvts), put together: a vtkImageData, vtkRectilinearGrid or vtkStructuredGrid with
/// the arrays that the pieces have, each of which is read by itself, so that faults name it. VTK's own readers of grids
/// in pieces leave zeros where there is no piece, take the bytes of one type for another, and fail by a null pointer if
/// a piece is damaged.
///
/// Pieces may overlap (ghost levels, or planes of points that they share); the last one's samples hold. Origin and
/// spacing are the parallel file's; the direction, which VTK 9.1 leaves out there, is the first piece's that has one.
/// Throws Error(bad_input) in one line if the pieces do not fill the whole, or one is missing, damaged, of another
/// kind, smaller than the whole says, or has other arrays or coordinates than the ones before.
vtkSmartPointer<vtkDataSet> read_grid_pieces(const std::filesystem::path& file, GridKind kind,
                                             std::vector<std::string>& notes);

/// Throws Error(bad_input) for one of VTK's XML files that is cut short, which VTK fills up with zeros without a word,
/// or is not well formed, or nested so deep that VTK's reader does not come out of it.
void require_whole_xml(const std::filesystem::path& file);

/// One of VTK's XML files, by the `type` of its <VTKFile>; not one in pieces. The pieces within it have to fill the
/// whole. Throws Error(bad_input).
vtkSmartPointer<vtkDataObject> read_xml_file(const std::filesystem::path& file, const std::string& type,
                                             std::string& warning);

}  // namespace tessera::readers
