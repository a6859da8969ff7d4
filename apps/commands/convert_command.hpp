// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "tessera/program/render_options.hpp"

namespace tessera::apps {

/// --pieces: a .pvtu of so many .vtu files, each tet in one of them.
struct ConvertPieces {
  int count = 1;
  Partition partition;
};

/// --pieces and --partition; none without pieces. Throws Error(bad_input).
std::optional<ConvertPieces> convert_pieces(const OptionWords& words);

/// `tessera convert` of a mesh: as it would be rendered (tets, one scalar), written as .tets or .vtu by the output's
/// extension, or with `pieces` as .pvtu, every tet cut into eight `subdivide` times. One line on stderr unless `quiet`.
/// Throws Error.
void convert_mesh(const InputFile& input, const std::filesystem::path& output, ReadOptions options, int subdivide,
                  const std::optional<ConvertPieces>& pieces, bool quiet);

/// Of a grid, by the output's extension: .vti .vtr .nrrd .raw .bricks. `block` is a side of a brick file's blocks.
void convert_grid(const InputFile& input, const std::filesystem::path& output, const ReadOptions& options, int block,
                  bool quiet);

}  // namespace tessera::apps
