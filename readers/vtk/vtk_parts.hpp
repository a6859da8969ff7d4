// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "readers/common/holdings.hpp"

class vtkDataArray;
class vtkDataObject;
class vtkDataSetAttributes;

namespace tessera::readers {

/// The data sets of a VTK data object, those of composite ones in their order, empty ones left out. Throws
/// Error(bad_input) for what is no data set.
std::vector<io::ForeignPart> parts_of(Holdings& holdings, vtkDataObject& data, const std::string& source);

/// An array, without its name.
io::ForeignArray hold_array(Holdings& holdings, vtkDataArray& array);

/// The fields of points or cells but for those of text. Those without a name are called by `unnamed` and their number.
std::vector<io::ForeignArray> hold_fields(Holdings& holdings, vtkDataSetAttributes& attributes, const char* unnamed);

}  // namespace tessera::readers
