#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/cli_fwd.hpp"
#include "apps/render_options.hpp"
#include "tessera/film.hpp"
#include "tessera/sink.hpp"

namespace tessera::apps {

/// `--peel THRESHOLD[:LAYERS]`: pictures in layers.
void add_peel_options(CLI::App& command, std::string& word);

/// The word's layers, if it is not empty, into options whose outputs and methods are set. Throws Error(bad_input) for
/// numbers out of range and for options that have no effect with layers, or none that is theirs.
void set_peel(const RenderWords& words, RenderOptions& options);

/// Gives each frame the names of its layers, behind those of the plan: `a.exr` has a.layer1.exr, a.layer2.exr and so
/// on. A frame is then finished if they exist, too. None without layers, and none of deep pictures, which hold them.
void name_layers(const RenderOptions& options, std::vector<FilmFrame>& frames);

/// Writes a frame's layers into the files that name_layers() gave it, without background. Throws as
/// PictureWriter::write_file().
void write_layers(const RenderedFrame& rendered, const FilmFrame& frame, const RenderOptions& options);

}  // namespace tessera::apps
