#pragma once

#include <string>
#include <vector>

#include "io/helper/holdings.hpp"

class vtkDataObject;

namespace tessera::io::helper {

/// The data sets of a VTK data object, those of composite ones in their order, empty ones left out. Throws
/// Error(bad_input) for what is no data set.
std::vector<ForeignPart> parts_of(Holdings& holdings, vtkDataObject& data, const std::string& source);

}  // namespace tessera::io::helper
