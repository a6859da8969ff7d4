// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "io/mesh/mesh_reader.hpp"
#include "scene/mesh_facts.hpp"
#include "tessera/dataset.hpp"

/// The files of meshes, and the default for a unit distance that is not given.
namespace tessera::frame {

/// Calls io::identify, but refuses a time series with a message of its own. Throws scene::Error.
io::InputFile identify_input(const std::filesystem::path& input);

/// The pieces of one mesh, whose first one has been identified.
std::vector<io::InputFile> identify_pieces(std::span<const std::filesystem::path> files, const io::InputFile& first);

using tessera::diagonal;

/// The default unit distance (the length to which opacities refer), used if neither the file nor the user specifies
/// one, in world units. It is a tenth of the mesh's mean thickness, so that the presets' ramps (0.03 to 0.2) make an
/// average ray 0.26 to 0.89 opaque, also in plates and scattered parts. For a mesh without volume it is a twentieth of
/// the mesh's diagonal; for a mesh without extent it is 1.
double default_unit_distance(const scene::MeshFacts& facts);

}  // namespace tessera::frame
