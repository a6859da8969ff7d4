// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "apps/options/cli_fwd.hpp"
#include "apps/options/render_options.hpp"

/// `render --preset NAME`: a published method as a whole, option by option; options that are given win.
///
/// juliachs-2007  Juliachs, Carrard, Nomine 2007 as printed: scanline rasterization of 4-tuples (4.1, 4.2), raw
///                segments sent to compositing processes (3), four samples a segment and fragment shaders that sort and
///                blend with 16 bits (4.3), 16 x 16 tiles, 64 pixels a side of a 1024 x 1024 picture; half of several
///                processes project, each its own part, the others composite. OpenGL is Mesa's software unless
///                --backend names another.
namespace tessera::apps {

/// Declares --preset.
void add_method_preset_option(CLI::App& render, RenderWords& words);

/// Sets what the preset says and `render`, parsed, was not given. Throws Error(bad_input) for an unknown name.
void apply_method_preset(const CLI::App& render, int ranks, RenderWords& words);

}  // namespace tessera::apps
