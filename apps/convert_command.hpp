#pragma once

#include <optional>

#include "apps/render_options.hpp"
#include "projection/partition.hpp"

namespace tessera::apps {

/// --pieces: a .pvtu of so many .vtu files, each tet in one of them.
struct ConvertPieces {
  int count = 1;
  projection::Partition partition;
};

/// The words of --pieces and --partition; none without pieces. Throws Error(bad_input).
std::optional<ConvertPieces> convert_pieces(const std::string& pieces, const std::string& partition);

/// `tessera convert`: the mesh as it would be rendered (tets, one scalar), written as .tets or .vtu by the output's
/// extension, or with `pieces` as .pvtu, every tet cut into eight `subdivide` times. One line on stderr unless `quiet`.
/// Throws scene::Error.
void convert(const std::filesystem::path& input, const std::filesystem::path& output, const io::MeshOptions& options,
             int subdivide, const std::optional<ConvertPieces>& pieces, bool quiet);

/// Writes a mesh by the extension, .tets or .vtu. `check_mesh_output` throws for what this could not write, early.
void write_mesh(const scene::TetMesh& mesh, const std::filesystem::path& output);
void check_mesh_output(const std::filesystem::path& output, const std::filesystem::path& input);

}  // namespace tessera::apps
