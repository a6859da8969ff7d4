// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "readers/vtk/ensight_case.hpp"

class vtkDataObject;
class vtkGenericEnSightReader;

/// Variable files of EnSight that end too early, where VTK's reader gives zeros without an error.
namespace tessera::readers {

struct EnsightValues {
  /// Where a file ends that has fewer numbers than its parts need: "inside part 2", "inside the nodes" (EnSight 6),
  /// "after part 1", "before its values". Empty if it has them all.
  std::string end;
  std::vector<std::string> absent;  ///< parts with solid cells that it has no values of, which Gold files may leave out
};

/// Of the parts that `reader` has read into `data`. Nothing for any layout but the plain one: several steps in a file,
/// Fortran's records. Cells of types that the file has no values of become NaN in `data`.
EnsightValues values_in(vtkGenericEnSightReader& reader, vtkDataObject& data, const EnsightCase::Values& values);

/// Whether a file ends with the word `part`: VTK's text reader crashes on such files.
bool ends_with_part(const EnsightCase::Values& values);

/// Removes the variable from all parts.
void remove_values(vtkDataObject& data, const EnsightCase::Values& values);

}  // namespace tessera::readers
