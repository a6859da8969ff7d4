// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "apps/options/cli_fwd.hpp"
#include "apps/options/render_options.hpp"

namespace tessera::apps {

/// The options of `tessera render` that films need.
void add_film_options(CLI::App& command, RenderWords& words);

/// Sorts what -o names into pictures, films and standard output. Throws Error(bad_input) for options that have no
/// effect with what is named.
void set_outputs(const RenderWords& words, RenderOptions& options);

}  // namespace tessera::apps
