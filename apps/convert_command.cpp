#include "apps/convert_command.hpp"

#include <fmt/format.h>

#include "apps/argument_values.hpp"
#include "apps/output_check.hpp"
#include "apps/report.hpp"
#include "datasets/modify.hpp"
#include "frame/mesh_input.hpp"
#include "io/mesh_parts.hpp"
#include "io/pvtu_writer.hpp"
#include "scene/error.hpp"

namespace tessera::apps {

void check_mesh_output(const std::filesystem::path& output, const std::filesystem::path& input) {
  const auto extension = output.extension();
  if (extension == ".pvtu")
    throw scene::bad_input(
        fmt::format("{}: one mesh in pieces is what convert --pieces writes; choose .vtu or .tets", output.string()));
  if (extension != ".vtu" && extension != ".tets")
    throw scene::bad_input(
        fmt::format("{}: '{}' is no mesh format to write; choose .vtu or .tets", output.string(), extension.string()));
  check_output_file(output, input);
}

void write_mesh(const scene::TetMesh& mesh, const std::filesystem::path& output) {
  output.extension() == ".tets" ? io::write_tets(mesh, output) : io::write_vtu(mesh, output);
}

namespace {

const char* order_words(projection::PartitionKind kind) {
  switch (kind) {
    case projection::PartitionKind::file:
      return "file order";
    case projection::PartitionKind::random:
      return "random";
    case projection::PartitionKind::curve:
      break;
  }
  return "curve";
}

void check_pieces_output(const std::filesystem::path& output, const std::filesystem::path& input, int pieces) {
  if (output.extension() != ".pvtu")
    throw scene::bad_input(fmt::format("{}: --pieces writes a .pvtu; name one", output.string()));
  std::vector<std::filesystem::path> inputs = {input};
  if (io::readable_in_parts(input, {}) && input.extension() != ".tets") {
    const auto read = io::pvtu_pieces(input);
    inputs.insert(inputs.end(), read.begin(), read.end());
  }
  // A name may exist, but not as something that is read.
  for (const auto& file : inputs) {
    check_output_file(output, file);
    for (int p = 0; p < pieces; ++p) {
      const auto name = io::pvtu_piece_name(output, p);
      std::error_code absent;
      if (std::filesystem::exists(name, absent)) check_output_file(name, file);
    }
  }
}

void write_pieces(const scene::TetMesh& mesh, const std::filesystem::path& output, const ConvertPieces& pieces) {
  const std::vector<std::uint32_t> part_of = projection::parts_of_whole(mesh, pieces.partition, pieces.count);
  std::vector<std::vector<std::uint32_t>> tets(static_cast<std::size_t>(pieces.count));
  for (std::size_t t = 0; t < part_of.size(); ++t) tets[part_of[t]].push_back(static_cast<std::uint32_t>(t));
  io::PvtuWriter writer(output, mesh);
  for (auto& piece : tets) {
    writer.add(scene::subset(mesh, piece));
    piece = {};
  }
  writer.commit();
}

}  // namespace

std::optional<ConvertPieces> convert_pieces(const std::string& pieces, const std::string& partition) {
  ConvertPieces result;
  if (partition == "file")
    result.partition.kind = projection::PartitionKind::file;
  else if (partition == "random")
    result.partition.kind = projection::PartitionKind::random;
  else if (partition != "curve")
    throw scene::bad_input(fmt::format("--partition: '{}' is none; use curve, file or random", partition));
  if (pieces.empty()) {
    if (partition != "curve") throw scene::bad_input("--partition: is of --pieces; give their number too");
    return std::nullopt;
  }
  result.count = parse_count("--pieces", pieces, 1, 100000);
  return result;
}

void convert(const std::filesystem::path& input, const std::filesystem::path& output, const io::MeshOptions& options,
             int subdivide, const std::optional<ConvertPieces>& pieces, bool quiet) {
  pieces ? check_pieces_output(output, input, pieces->count) : check_mesh_output(output, input);
  auto file = frame::read_input(input, options);
  for (int time = 0; time < subdivide; ++time) file.mesh = datasets::subdivided(file.mesh);
  pieces ? write_pieces(file.mesh, output, *pieces) : write_mesh(file.mesh, output);
  if (!quiet)
    fmt::print(stderr, "{}: {}; field {} written to {}{}\n", input.string(), cells_line(file.counts),
               file.mesh.field_name, output.string(),
               pieces ? fmt::format(" and {} pieces ({}{})", pieces->count, order_words(pieces->partition.kind),
                                    pieces->partition.kind == projection::PartitionKind::random
                                        ? fmt::format(", seed {}", pieces->partition.seed)
                                        : "")
                      : "");
}

}  // namespace tessera::apps
