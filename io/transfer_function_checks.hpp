#pragma once

#include <string>
#include <vector>

#include "io/transfer_function_file.hpp"

namespace tessera::io {

/// Throws Error(bad_input) naming the option if a range, distance or scale is not what its comment says.
void check(const TransferFunctionOptions& options);

/// scene::TransferFunction's constructor with the file's name before its message.
scene::TransferFunction make_transfer_function(std::vector<scene::Knot> knots, const std::string& source);

}  // namespace tessera::io
