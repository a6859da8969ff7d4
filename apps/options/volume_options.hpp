// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "apps/options/cli_fwd.hpp"
#include "apps/options/render_options.hpp"

namespace tessera::apps {

/// The options that describe a .raw file; `render`, `info` and `convert` have them.
void add_volume_options(CLI::App& command, RenderWords& words);
/// The options of `tessera render` that are for volumes only.
void add_volume_render_options(CLI::App& command, RenderWords& words);

/// --scale, of meshes and volumes.
std::optional<glm::dvec3> axis_scale_of(const RenderWords& words);

ReadOptions volume_options(const RenderWords& words);

/// Whether the input of these words is a volume: by its content, or because .raw options describe it.
bool is_grid_input(const RenderWords& words);

/// --shade and --light. Throws Error(bad_input) naming the option.
std::optional<Shading> shading_of(const RenderWords& words);

/// Sets how a volume is rendered: all but what it shares with meshes. Throws Error(bad_input) naming the option.
void set_grid(const RenderWords& words, Settings& settings);

/// Sets how a volume's picture is split between ranks. Throws as set_grid().
void set_distribution(const RenderWords& words, RankSettings& ranks);
void set_balance(const RenderWords& words, RankSettings& ranks);

/// Throws if an option of jobs that render meshes is given.
void refuse_mesh_words(const RenderWords& words);

/// Throws if an option that is for volumes only is given.
void refuse_volume_options(const RenderWords& words);

}  // namespace tessera::apps
