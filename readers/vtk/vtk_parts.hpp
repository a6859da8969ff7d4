// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "readers/common/holdings.hpp"

class vtkDataArray;
class vtkDataObject;
class vtkDataSetAttributes;

namespace tessera::readers {

/// Returns the non-empty data sets of a VTK data object. The data sets of composite data are returned in order. Throws
/// Error(bad_input) for anything other than data sets.
std::vector<io::ForeignPart> parts_of(Holdings& holdings, vtkDataObject& data, const std::string& source);

/// Adds an array, without its name.
io::ForeignArray hold_array(Holdings& holdings, vtkDataArray& array);

/// Adds the fields of points or cells except text arrays. A field without a name is named `unnamed` followed by its
/// number.
std::vector<io::ForeignArray> hold_fields(Holdings& holdings, vtkDataSetAttributes& attributes, const char* unnamed);

}  // namespace tessera::readers
