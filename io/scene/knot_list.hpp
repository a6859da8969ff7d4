// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "colormaps/function_options.hpp"

namespace tessera::io {

/// Creates a transfer function from the knots of a file, which contain extinctions and linear colours. Applies the
/// options that make sense for extinctions: `rescale`, `range`, `opacity_scale`. The knots' values must not decrease.
/// Throws Error(bad_input, "SOURCE: ...") for `opacity_points`, and for knots that scene::TransferFunction refuses.
colormaps::LoadedTransferFunction loaded_knots(std::vector<scene::Knot> knots, const std::string& source,
                                               const colormaps::TransferFunctionOptions& options);

}  // namespace tessera::io
