#pragma once

#include <string>

#include "io/helper/ensight_case.hpp"

class vtkDataObject;
class vtkGenericEnSightReader;

/// Variable files of EnSight that end too early, where VTK's reader gives zeros without an error.
namespace tessera::io::helper {

/// Where a file ends that has fewer numbers than the parts need that `reader` has read into `data`: "part 2", or "the
/// nodes" of EnSight 6. Empty if it has them all, and for any layout but the plain one: partial and undefined values,
/// several steps in a file, Fortran's records.
std::string where_values_end(vtkGenericEnSightReader& reader, vtkDataObject& data, const EnsightCase::Values& values);

/// Removes the variable from all parts.
void remove_values(vtkDataObject& data, const EnsightCase::Values& values);

}  // namespace tessera::io::helper
