// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "io/mesh/mesh_reader.hpp"
#include "scene/mesh_facts.hpp"
#include "tessera/dataset.hpp"

/// Reading meshes from files, and the default for a unit distance that is not given.
namespace tessera::frame {

/// io::identify, but refuses a time series with its own message. Throws scene::Error.
io::InputFile identify_input(const std::filesystem::path& input);

/// io::read_mesh for a mesh's files, whose first one has been identified.
cells::MeshFile read_input(std::span<const std::filesystem::path> files, const io::InputFile& first,
                           const ReadOptions& options);

using tessera::diagonal;

/// The length to which an opacity refers if neither the file nor the user states it, world units: a tenth of the mesh's
/// mean thickness, so that the presets' ramps (0.03 to 0.2) make an average ray 0.26 to 0.89 opaque, also in plates and
/// scattered parts. For a mesh without volume: a twentieth of its diagonal; without extent: 1.
double default_unit_distance(const scene::MeshFacts& facts);

}  // namespace tessera::frame
