// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "colormaps/function_options.hpp"

namespace tessera::io {

/// A transfer function of knots that a file gives as they are, extinctions and linear colours, with the options that
/// apply to such: `rescale`, `range`, `opacity_scale`. The knots' values do not decrease. Throws Error(bad_input,
/// "SOURCE: ...") for `opacity_points`, and what scene::TransferFunction refuses.
colormaps::LoadedTransferFunction loaded_knots(std::vector<scene::Knot> knots, const std::string& source,
                                               const colormaps::TransferFunctionOptions& options);

}  // namespace tessera::io
