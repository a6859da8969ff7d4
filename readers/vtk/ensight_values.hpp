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
  /// Description of the place where a file with too few numbers ends: "inside part 2", "inside the nodes" (EnSight 6),
  /// "after part 1", "before its values". Empty if the file is complete.
  std::string end;
  std::vector<std::string> absent;  ///< parts that have solid cells but no values in the file, which Gold allows
};

/// Checks the file of a variable for the parts that `reader` has read into `data`. Only the plain layout is checked,
/// not files with several steps or with Fortran records. In `data`, the values of cells become NaN if the file has no
/// values for cells of their type.
EnsightValues values_in(vtkGenericEnSightReader& reader, vtkDataObject& data, const EnsightCase::Values& values);

/// Whether a file ends with the word `part`: VTK's text reader crashes on these files.
bool ends_with_part(const EnsightCase::Values& values);

/// Removes the variable from all parts.
void remove_values(vtkDataObject& data, const EnsightCase::Values& values);

}  // namespace tessera::readers
