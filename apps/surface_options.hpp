#pragma once

#include <array>
#include <filesystem>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/cli_fwd.hpp"
#include "tessera/dataset.hpp"
#include "tessera/surfaces.hpp"

namespace tessera::apps {

/// The options that put surfaces into the volume, as they stand on the command line.
struct SurfaceWords {
  std::vector<std::string> iso, surface;
};

/// `--surface NAME` of a block of the input, which is looked for once that is read.
struct BlockSurfaceWord {
  std::string name;
  std::optional<glm::dvec3> color{};
  double opacity = 1;
};

void add_surface_options(CLI::App& command, SurfaceWords& words);

/// What they say, with the triangles of files; names of blocks go to `blocks`. Throws Error(bad_input) naming the
/// option or the file.
Surfaces surfaces_of(const SurfaceWords& words, std::vector<BlockSurfaceWord>& blocks);
/// Of them those of a value.
std::vector<IsoSurface> iso_surfaces_of(const SurfaceWords& words);

/// `surfaces`, scaled as the data's axes are, with those of blocks of its files, coloured by its field where they have
/// it. `read` is how the data were read. Throws Error(bad_input) for a block that is not there.
Surfaces with_block_surfaces(Surfaces surfaces, std::span<const BlockSurfaceWord> blocks, const Dataset& data,
                             std::span<const std::filesystem::path> files, ReadOptions read);

/// A line of warning for each surface of a value that the field, whose range that is, does not cross.
std::vector<std::string> unseen_surfaces(const Surfaces& surfaces, const std::array<double, 2>& range);

}  // namespace tessera::apps
