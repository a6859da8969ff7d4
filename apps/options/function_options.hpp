// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "apps/options/cli_fwd.hpp"
#include "tessera/dataset.hpp"

namespace tessera::apps {

/// The options of range and opacity, as they stand on the command line.
struct FunctionWords {
  std::string range, opacity_points;
  bool log = false;
};

void add_function_options(CLI::App& command, FunctionWords& words);

/// Throws Error(bad_input) naming the option.
void set_function(const FunctionWords& words, TransferFunctionOptions& options);

}  // namespace tessera::apps
