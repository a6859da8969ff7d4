// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "readers/common/holdings.hpp"

class XdmfArray;

namespace tessera::readers {

/// The function with which rewritten_xdmf() makes points from one array each for x, y and z.
constexpr const char* interleaved = "interleaved";

/// The arrays that `array` selects from (HyperSlab) or interleaves; empty if it has its own numbers. Throws
/// Error(bad_input) for numbers that must be computed, and for selections outside their array.
std::vector<XdmfArray*> referenced_arrays(XdmfArray& array, const std::string& source);

NumberType number_type_of(const XdmfArray& array);

/// Fills an array without numbers that referenced_arrays() accepts.
void read_numbers(XdmfArray& array);

}  // namespace tessera::readers
