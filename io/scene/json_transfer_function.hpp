// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "colormaps/function_options.hpp"

namespace tessera::io {

/// Parses a transfer function in JSON: an object with `knots`, a list of [value, red, green, blue, extinction] with
/// non-decreasing values, linear colours, and extinctions per world unit. Two knots with the same value form a step.
/// Also accepts ParaView's colour map (paraview_color_map.hpp). Throws Error(bad_input, "SOURCE: ...") with a message
/// of one line.
colormaps::LoadedTransferFunction parse_json_transfer_function(std::string_view text, const std::string& source,
                                                               const colormaps::TransferFunctionOptions& options);

/// Implements tessera::transfer_function_json().
std::string knots_json(const scene::TransferFunction& function);

/// Implements tessera::paraview_json().
std::string color_map_json(const scene::TransferFunction& function, double unit_distance, const std::string& name);

}  // namespace tessera::io
