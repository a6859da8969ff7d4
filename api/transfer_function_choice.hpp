// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tessera/dataset.hpp"

namespace tessera::api {

/// The preset or file named, or the default one, over the range of the field or the one asked for; with a warning if it
/// shows next to nothing.
LoadedTransferFunction transfer_function_of(const Dataset::State& data, const std::string& file_or_preset,
                                            const TransferFunctionOptions& options);

}  // namespace tessera::api
