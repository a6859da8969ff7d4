// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "readers/common/holdings.hpp"

class vtkDataArray;
class vtkDataObject;
class vtkDataSetAttributes;

namespace tessera::readers {

/// The data sets of a VTK data object, those of composite ones in order, without empty ones. Throws Error(bad_input)
/// for anything but data sets.
std::vector<io::ForeignPart> parts_of(Holdings& holdings, vtkDataObject& data, const std::string& source);

/// Holds an array, without its name.
io::ForeignArray hold_array(Holdings& holdings, vtkDataArray& array);

/// Holds the fields of points or cells except text arrays. Those without a name get the name `unnamed` and their
/// number.
std::vector<io::ForeignArray> hold_fields(Holdings& holdings, vtkDataSetAttributes& attributes, const char* unnamed);

}  // namespace tessera::readers
