// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "tessera/program/render_options.hpp"

namespace tessera::apps {

/// --pieces: a .pvtu with `count` .vtu files, each tet in one of them.
struct ConvertPieces {
  int count = 1;
  Partition partition;
};

/// --pieces and --partition; none without pieces. Throws Error(bad_input).
std::optional<ConvertPieces> convert_pieces(const OptionWords& words);

/// `tessera convert` for a mesh: writes it as it would be rendered (tets, one scalar), as .tets or .vtu by the output's
/// extension, or with `pieces` as .pvtu, with every tet cut into eight `subdivide` times. Prints one line on stderr
/// unless `quiet`. Throws Error.
void convert_mesh(const InputFile& input, const std::filesystem::path& output, ReadOptions options, int subdivide,
                  const std::optional<ConvertPieces>& pieces, bool quiet);

/// For a grid, in the format of the output's extension: .vti .vtr .nrrd .raw .bricks. `block`: samples per side of a
/// brick file's blocks.
void convert_grid(const InputFile& input, const std::filesystem::path& output, const ReadOptions& options, int block,
                  bool quiet);

}  // namespace tessera::apps
