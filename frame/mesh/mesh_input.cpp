// SPDX-License-Identifier: BSD-3-Clause
#include "frame/mesh/mesh_input.hpp"

#include <fmt/format.h>

#include "io/scene/time_series.hpp"
#include "scene/error.hpp"

namespace tessera::frame {

cells::MeshFile read_input(const std::filesystem::path& input, const cells::MeshOptions& options) {
  if (io::is_time_series(input))
    throw scene::bad_input(
        fmt::format("{}: it is a time series, which render and serve take; give one of its meshes", input.string()));
  return io::read_mesh(input, options);
}

cells::MeshFile read_input(std::span<const std::filesystem::path> files, const cells::MeshOptions& options) {
  return files.size() == 1 ? read_input(files.front(), options) : io::read_mesh(files, options);
}

double default_unit_distance(const scene::MeshFacts& facts) {
  if (facts.mean_thickness > 0) return facts.mean_thickness / 10;
  const double extent = diagonal(facts.box);
  return extent > 0 ? extent / 20 : 1;
}

}  // namespace tessera::frame
