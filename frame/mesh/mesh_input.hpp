// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "io/mesh/mesh_reader.hpp"
#include "scene/mesh_facts.hpp"
#include "tessera/dataset.hpp"

/// Meshes as files have them, and what stands in for settings that were not given.
namespace tessera::frame {

/// io::identify, but a time series is refused as one. Throws scene::Error.
io::InputFile identify_input(const std::filesystem::path& input);

/// io::read_mesh of a mesh's files, whose first has been identified.
cells::MeshFile read_input(std::span<const std::filesystem::path> files, const io::InputFile& first,
                           const ReadOptions& options);

using tessera::diagonal;

/// The length over which an opacity holds where neither file nor user says it, world units: a tenth of the mesh's mean
/// thickness, so that the presets' ramps (0.03 to 0.2) make an average ray 0.26 to 0.89 opaque, in plates and scattered
/// parts too. A mesh of no volume: a twentieth of its diagonal; of no extent: 1.
double default_unit_distance(const scene::MeshFacts& facts);

}  // namespace tessera::frame
