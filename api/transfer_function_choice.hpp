// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tessera/dataset.hpp"

namespace tessera::api {

/// Returns the preset or file of this name, or the default function, over the range of the field or the requested
/// range. The result contains a warning if the function shows almost nothing.
LoadedTransferFunction transfer_function_of(const Dataset::State& data, const std::string& file_or_preset,
                                            const TransferFunctionOptions& options);

}  // namespace tessera::api
