// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "apps/options/cli_fwd.hpp"
#include "apps/options/render_options.hpp"

namespace tessera::apps {

/// `--peel THRESHOLD[:LAYERS]`: pictures in layers.
void add_peel_options(CLI::App& command, std::string& word);

/// The word's layers, if it is not empty, into options whose outputs and methods are set. Throws Error(bad_input) for
/// numbers out of range and for options that have no effect with layers, or none that is theirs.
void set_peel(const RenderWords& words, RenderOptions& options);

}  // namespace tessera::apps
