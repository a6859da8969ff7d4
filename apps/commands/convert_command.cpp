// SPDX-License-Identifier: BSD-3-Clause
#include "apps/commands/convert_command.hpp"

#include <fmt/format.h>

#include "apps/render/progress.hpp"
#include "apps/render/report.hpp"
#include "apps/stderr_lines.hpp"
#include "datasets/arrays.hpp"
#include "datasets/modify.hpp"
#include "tessera/error.hpp"
#include "tessera/program/output_file.hpp"
#include "tessera/write.hpp"

namespace tessera::apps {
namespace {

const char* order_words(PartitionKind kind) {
  switch (kind) {
    case PartitionKind::file:
      return "file order";
    case PartitionKind::random:
      return "random";
    case PartitionKind::curve:
      break;
  }
  return "curve";
}

}  // namespace

std::optional<ConvertPieces> convert_pieces(const OptionWords& words) {
  const auto kind = words.choice("partition", {PartitionKind::curve, PartitionKind::file, PartitionKind::random});
  const auto count = words.count("pieces", 1, 100000);
  if (count) return ConvertPieces{*count, {.kind = kind.value_or(PartitionKind::curve)}};
  if (kind && *kind != PartitionKind::curve)
    throw bad_input("--partition: it needs --pieces; give the number of pieces too");
  return std::nullopt;
}

void convert_mesh(const InputFile& input, const std::filesystem::path& output, ReadOptions options, int subdivide,
                  const std::optional<ConvertPieces>& pieces, bool quiet) {
  check_mesh_output(output, &input, pieces ? std::optional(pieces->count) : std::nullopt);
  options.keep_corners = true;
  StatusLine line(shows_progress(quiet));
  const Dataset data = open_watched(input, options, line);
  line.begin("making tets");
  MeshArrays mesh = data.mesh_arrays();
  for (int time = 0; time < subdivide; ++time)
    mesh = datasets::arrays_of(datasets::subdivided(datasets::mesh_of(mesh)));
  line.begin("writing " + output.filename().string());
  pieces ? write_mesh_pieces(mesh, output, pieces->count, pieces->partition) : write_mesh(mesh, output);
  line.begin("");
  if (quiet) return;
  std::string parts;
  if (pieces)
    parts = fmt::format(
        " and {} pieces ({}{})", pieces->count, order_words(pieces->partition.kind),
        pieces->partition.kind == PartitionKind::random ? fmt::format(", seed {}", pieces->partition.seed) : "");
  print_lines(fmt::format("{}: {}; field {} written to {}{}", input.path().string(), cells_line(data.mesh_counts()),
                          data.field_name(), output.string(), parts));
}

void convert_grid(const InputFile& input, const std::filesystem::path& output, const ReadOptions& options, int block,
                  bool quiet) {
  if (!is_grid_output(output))
    throw bad_input(fmt::format("{}: '{}' is not a volume format to write; choose .vti, .vtr, .nrrd, .raw or .bricks",
                                output.string(), output.extension().string()));
  check_output(output, input.path());
  if (!options.selection.clip.empty())
    throw bad_input("--clip: volumes are always written as a whole; leave --clip out here, and give it to render");
  StatusLine line(shows_progress(quiet));
  ReadOptions as_stored = options;
  as_stored.labels = false;
  const Dataset data = open_watched(input, as_stored, line);
  line.begin("writing " + output.filename().string());
  write_grid(data, output, block);
  line.begin("");
  if (quiet) return;
  const GridGeometry& g = data.grid_geometry();
  std::string how_to_read;
  if (output.extension() == ".raw")
    how_to_read = fmt::format("; read it with --dims {}x{}x{} --type {} --spacing {},{},{} --origin {},{},{}",
                              g.points[0], g.points[1], g.points[2], name_of(written_type(data)), g.spacing.x,
                              g.spacing.y, g.spacing.z, g.origin.x, g.origin.y, g.origin.z);
  print_lines(fmt::format("{}: {}; field {} written to {}{}", input.path().string(), samples_line(described(data)),
                          data.field_name(), output.string(), how_to_read));
}

}  // namespace tessera::apps
