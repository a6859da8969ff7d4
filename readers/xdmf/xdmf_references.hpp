// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "readers/common/holdings.hpp"

class XdmfArray;

namespace tessera::readers {

/// The function by which rewritten_xdmf() makes points of an array for each of x, y and z.
constexpr const char* interleaved = "interleaved";

/// The arrays that one is a selection (HyperSlab) or the interleaving of; none where it has numbers of its own.
/// Throws Error(bad_input) for numbers that are to be computed, and for selections that do not lie in their array.
std::vector<XdmfArray*> referenced_arrays(XdmfArray& array, const std::string& source);

NumberType number_type_of(const XdmfArray& array);

/// Fills an array that has no numbers yet, one that referenced_arrays() takes.
void read_numbers(XdmfArray& array);

}  // namespace tessera::readers
