#pragma once

#include "apps/render_options.hpp"
#include "io/volume_reader.hpp"

/// The volume that a command is about: regular and rectilinear grids take another way than meshes from here on.
namespace tessera::apps {

/// `tessera info` of a volume. Throws scene::Error.
void volume_info(const std::filesystem::path& input, const io::VolumeOptions& options, bool as_json);

/// `tessera convert` of a volume, by the output's extension: .vti .vtr .nrrd .raw .bricks. `block` is a side of a brick
/// file's blocks. One line on stderr unless `quiet`.
void convert_volume(const std::filesystem::path& input, const std::filesystem::path& output,
                    const io::VolumeOptions& options, int block, bool quiet);

}  // namespace tessera::apps
