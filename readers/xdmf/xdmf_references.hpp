// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "readers/common/holdings.hpp"

class XdmfArray;

namespace tessera::readers {

/// The name of the function by which rewritten_xdmf() combines separate arrays for x, y and z into points.
constexpr const char* interleaved = "interleaved";

/// Returns the arrays from which `array` selects (HyperSlab) or which it interleaves; empty if it has its own numbers.
/// Throws Error(bad_input) for numbers that must be computed, and for selections outside their array.
std::vector<XdmfArray*> referenced_arrays(XdmfArray& array, const std::string& source);

NumberType number_type_of(const XdmfArray& array);

/// Fills an array without numbers of its own from the arrays that referenced_arrays() returns.
void read_numbers(XdmfArray& array);

}  // namespace tessera::readers
