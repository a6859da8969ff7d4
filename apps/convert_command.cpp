#include "apps/convert_command.hpp"

#include <fmt/format.h>

#include "apps/mesh_input.hpp"
#include "apps/output_check.hpp"
#include "apps/report.hpp"
#include "scene/error.hpp"

namespace tessera::apps {

void check_mesh_output(const std::filesystem::path& output, const std::filesystem::path& input) {
  const auto extension = output.extension();
  if (extension == ".pvtu")
    throw scene::bad_input(
        fmt::format("{}: meshes in pieces are not written yet; choose .vtu or .tets", output.string()));
  if (extension != ".vtu" && extension != ".tets")
    throw scene::bad_input(
        fmt::format("{}: '{}' is no mesh format to write; choose .vtu or .tets", output.string(), extension.string()));
  check_output_file(output, input);
}

void write_mesh(const scene::TetMesh& mesh, const std::filesystem::path& output) {
  output.extension() == ".tets" ? io::write_tets(mesh, output) : io::write_vtu(mesh, output);
}

void convert(const std::filesystem::path& input, const std::filesystem::path& output, const io::MeshOptions& options,
             bool quiet) {
  check_mesh_output(output, input);
  const auto file = read_input(input, options);
  write_mesh(file.mesh, output);
  if (!quiet)
    fmt::print(stderr, "{}: {}; field {} written to {}\n", input.string(), cells_line(file.counts),
               file.mesh.field_name, output.string());
}

}  // namespace tessera::apps
