// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "tessera/program/film.hpp"
#include "tessera/program/render_options.hpp"

namespace tessera::apps {

/// Returns the frames of a run with all their output files. The outputs of one frame are, in this order:
///
///     as named    the plan's, in all formats
///     layers      with --peel, for each output as named: `a.exr` has a.layer1.exr, a.layer2.exr ...; none for deep
///                 images, which contain their layers
///     annotation  with --annotation-layer, one file
///     cost maps   with --show balance, for each of the above: `a.png` has a.cost.png
///
/// With --resume, a frame is finished if all of these files exist. Throws the same errors as plan_film().
std::vector<FilmFrame> planned_frames(const RenderOptions& options);

/// Returns the outputs of the whole run: films, report, trace, saved options. The names of outputs that were not
/// requested are empty.
std::vector<std::filesystem::path> other_outputs(const RenderOptions& options);

}  // namespace tessera::apps
