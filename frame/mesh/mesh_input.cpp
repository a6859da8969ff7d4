// SPDX-License-Identifier: BSD-3-Clause
#include "frame/mesh/mesh_input.hpp"

#include <fmt/format.h>

#include "io/formats/identify.hpp"
#include "io/scene/time_series.hpp"
#include "scene/error.hpp"

namespace tessera::frame {

io::InputFile identify_input(const std::filesystem::path& input) {
  if (io::is_time_series(input))
    throw scene::bad_input(fmt::format(
        "{}: it is a time series, which only render and serve accept; give one of its meshes", input.string()));
  return io::identify(input);
}

std::vector<io::InputFile> identify_pieces(std::span<const std::filesystem::path> files, const io::InputFile& first) {
  std::vector<io::InputFile> all = {first};
  all.reserve(files.size());
  for (const std::filesystem::path& file : files.subspan(1)) all.push_back(identify_input(file));
  return all;
}

double default_unit_distance(const scene::MeshFacts& facts) {
  if (facts.mean_thickness > 0) return facts.mean_thickness / 10;
  const double extent = diagonal(facts.box);
  return extent > 0 ? extent / 20 : 1;
}

}  // namespace tessera::frame
