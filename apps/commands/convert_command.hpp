// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "tessera/program/render_options.hpp"

namespace tessera::apps {

/// The option --pieces: a .pvtu with `count` .vtu files. Each tet is in exactly one of them.
struct ConvertPieces {
  int count = 1;
  Partition partition;
};

/// Reads the options --pieces and --partition. Returns none without --pieces. Throws Error(bad_input).
std::optional<ConvertPieces> convert_pieces(const OptionWords& words);

/// Implements `tessera convert` for a mesh: writes the mesh as it would be rendered (tets with one scalar). The format
/// is .tets or .vtu, depending on the output's extension, or .pvtu with `pieces`. Every tet is cut into eight,
/// `subdivide` times. Prints one line on stderr unless `quiet`. Throws Error.
void convert_mesh(const InputFile& input, const std::filesystem::path& output, ReadOptions options, int subdivide,
                  const std::optional<ConvertPieces>& pieces, bool quiet);

/// Implements `tessera convert` for a grid. The format is that of the output's extension: .vti .vtr .nrrd .raw .bricks.
/// `block` is the number of samples per side of the blocks of a brick file.
void convert_grid(const InputFile& input, const std::filesystem::path& output, const ReadOptions& options, int block,
                  bool quiet);

}  // namespace tessera::apps
