#include "frame/mesh_input.hpp"

#include <fmt/format.h>

#include "colormaps/presets.hpp"
#include "io/time_series.hpp"
#include "io/transfer_function_file.hpp"
#include "scene/error.hpp"

namespace tessera::frame {

io::MeshFile read_input(const std::filesystem::path& input, const io::MeshOptions& options) {
  if (io::is_time_series(input))
    throw scene::bad_input(
        fmt::format("{}: is a time series, which only render takes; give one of its meshes", input.string()));
  return io::read_mesh(input, options);
}

io::MeshFile read_input(std::span<const std::filesystem::path> files, const io::MeshOptions& options) {
  return files.size() == 1 ? read_input(files.front(), options) : io::read_mesh(files, options);
}

double default_unit_distance(const scene::MeshFacts& facts) {
  if (facts.mean_thickness > 0) return facts.mean_thickness / 10;
  const double extent = diagonal(facts.box);
  return extent > 0 ? extent / 20 : 1;
}

LoadedTransferFunction transfer_function_of(const scene::MeshFacts& facts, bool is_grid,
                                            const std::string& file_or_preset, const TransferFunctionOptions& options) {
  colormaps::TransferFunctionOptions loading;
  loading.field_range = facts.scalar_range;
  loading.unit_distance = options.unit_distance;
  loading.default_unit_distance = default_unit_distance(facts);
  loading.display_colors = options.display_colors;
  loading.rescale = options.rescale;
  loading.opacity_scale = options.opacity_scale;
  if (!file_or_preset.empty()) return io::load_transfer_function(file_or_preset, loading);
  if (!is_grid) return colormaps::default_transfer_function(loading);
  auto loaded = io::load_transfer_function("cool-warm:rise", loading);
  loaded.name += " (default)";
  return loaded;
}

}  // namespace tessera::frame
