#pragma once

#include "apps/render_options.hpp"

namespace tessera::apps {

/// `tessera convert`: the mesh as it would be rendered (tets, one scalar), written as .tets or .vtu by the output's
/// extension. One line on stderr unless `quiet`. Throws scene::Error.
void convert(const std::filesystem::path& input, const std::filesystem::path& output, const io::MeshOptions& options,
             bool quiet);

/// Writes a mesh by the extension, .tets or .vtu. `check_mesh_output` throws for what this could not write, early.
void write_mesh(const scene::TetMesh& mesh, const std::filesystem::path& output);
void check_mesh_output(const std::filesystem::path& output, const std::filesystem::path& input);

}  // namespace tessera::apps
