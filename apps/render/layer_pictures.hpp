// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "apps/options/render_options.hpp"
#include "tessera/program/film.hpp"
#include "tessera/sink.hpp"

namespace tessera::apps {

/// Gives each frame the names of its layers, behind those of the plan: `a.exr` has a.layer1.exr, a.layer2.exr and so
/// on. A frame is then finished if they exist, too. None without layers, and none of deep pictures, which hold them.
void name_layers(const RenderOptions& options, std::vector<FilmFrame>& frames);

/// Writes a frame's layers into the files that name_layers() gave it, without background. Throws as
/// PictureWriter::write_file().
void write_layers(const RenderedFrame& rendered, const FilmFrame& frame, const RenderOptions& options);

}  // namespace tessera::apps
