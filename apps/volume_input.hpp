#pragma once

#include <nlohmann/json.hpp>

#include "apps/render_options.hpp"
#include "io/transfer_function_file.hpp"
#include "io/volume_reader.hpp"
#include "scene/mesh_facts.hpp"

/// The volume that a command is about: regular and rectilinear grids take another way than meshes from here on.
namespace tessera::apps {

/// What views and transfer functions have to know; `tets` is 0.
scene::MeshFacts facts_of(const io::VolumeFile& volume);

/// File, format, lattice, samples, bounds, chosen field, all fields, notes: the report's "volume".
nlohmann::ordered_json volume_json(const std::filesystem::path& input, const io::VolumeFile& volume);

/// `256x256x128 uint8 samples, 12 blank`
std::string samples_line(const io::VolumeFile& volume);

/// `tessera info` of a volume. Throws scene::Error.
void volume_info(const std::filesystem::path& input, const io::VolumeOptions& options, bool as_json);

/// `tessera convert` of a volume, by the output's extension: .vti .vtr .nrrd .raw .bricks. `block` is a side of a brick
/// file's blocks. One line on stderr unless `quiet`.
void convert_volume(const std::filesystem::path& input, const std::filesystem::path& output,
                    const io::VolumeOptions& options, int block, bool quiet);

}  // namespace tessera::apps
