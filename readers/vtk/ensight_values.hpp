// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "readers/vtk/ensight_case.hpp"

class vtkDataObject;
class vtkGenericEnSightReader;

/// Detects EnSight variable files that end too early, which VTK's reader completes with zeros without an error.
namespace tessera::readers {

struct EnsightValues {
  /// Where a file ends that has too few numbers for its parts: "inside part 2", "inside the nodes" (EnSight 6), "after
  /// part 1", "before its values". Empty if it is complete.
  std::string end;
  std::vector<std::string> absent;  ///< parts with solid cells without values, which Gold files may omit
};

/// For the parts that `reader` has read into `data`. Checks only the plain layout, not several steps in a file or
/// Fortran records. Cells of types without values become NaN in `data`.
EnsightValues values_in(vtkGenericEnSightReader& reader, vtkDataObject& data, const EnsightCase::Values& values);

/// Whether a file ends with the word `part`: VTK's text reader crashes on these files.
bool ends_with_part(const EnsightCase::Values& values);

/// Removes the variable from all parts.
void remove_values(vtkDataObject& data, const EnsightCase::Values& values);

}  // namespace tessera::readers
