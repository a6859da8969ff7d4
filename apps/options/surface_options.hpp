// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <filesystem>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/options/cli_fwd.hpp"
#include "tessera/dataset.hpp"
#include "tessera/surfaces.hpp"

namespace tessera::apps {

/// The options that put surfaces into the volume, as they stand on the command line.
struct SurfaceWords {
  std::vector<std::string> iso, surface;
};

/// `--surface NAME[:COLOUR[:OPACITY]]` of a block of the input. Which of it is the name is known once that is read.
struct BlockSurfaceWord {
  std::string word;
  std::string name;  ///< until then what stands before the first colon, or all if no colour follows
  std::optional<glm::dvec3> color{};
  double opacity = 1;
};

void add_surface_options(CLI::App& command, SurfaceWords& words);

/// What they say, with the triangles of files; names of blocks go to `blocks`. Throws Error(bad_input) naming the
/// option or the file.
Surfaces surfaces_of(const SurfaceWords& words, std::vector<BlockSurfaceWord>& blocks);
/// Of them those of a value.
std::vector<IsoSurface> iso_surfaces_of(const SurfaceWords& words);

/// The blocks that words name in what was read: the longest name that there is, which may hold colons, and a look
/// behind it. Throws Error(bad_input) for what is no look.
std::vector<BlockSurfaceWord> found_blocks(std::span<const BlockSurfaceWord> words, const Dataset& data);

/// `surfaces`, scaled as the data's axes are, with those of blocks of its files, coloured by its field where they have
/// it. `read` is how the data were read. Throws Error(bad_input) for a block that is not there.
Surfaces with_block_surfaces(Surfaces surfaces, std::span<const BlockSurfaceWord> blocks, const Dataset& data,
                             std::span<const std::filesystem::path> files, ReadOptions read);

/// A line of warning for each surface of a value that the field, whose range that is, does not cross.
std::vector<std::string> unseen_surfaces(const Surfaces& surfaces, const std::array<double, 2>& range);

}  // namespace tessera::apps
