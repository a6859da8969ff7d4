// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "apps/options/cli_fwd.hpp"
#include "tessera/selection.hpp"

namespace tessera::apps {

/// The words of the options below.
struct ClipWords {
  std::vector<std::string> clip;
  std::string threshold;
};

/// The options that say what of the data is kept.
void add_clip_options(CLI::App& command, ClipWords& words);

/// Words to values. Throws Error(bad_input) naming the option.
Selection selection_of(const ClipWords& words);

}  // namespace tessera::apps
