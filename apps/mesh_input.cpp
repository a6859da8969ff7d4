#include "apps/mesh_input.hpp"

#include <fmt/format.h>

#include <glm/geometric.hpp>

#include "apps/setting_words.hpp"
#include "colormaps/presets.hpp"
#include "io/time_series.hpp"
#include "io/volume_file.hpp"
#include "scene/error.hpp"

namespace tessera::apps {

MeshSummary summary_of(const io::MeshFile& file, int threads) {
  return summary_of(file, scene::facts_of(file.mesh, threads));
}

MeshSummary summary_of(const io::MeshFile& description, const scene::MeshFacts& facts) {
  return {description.counts, description.fields,          with_options(description.notes),
          description.format, description.mesh.field_name, facts};
}

io::MeshFile read_input(const std::filesystem::path& input, const io::MeshOptions& options) {
  if (io::is_volume_file(input) && !io::is_mesh_file(input))
    throw scene::bad_input(fmt::format(
        "{}: is a regular grid by its name, no mesh; give a mesh, or write .vti, .nrrd or .bricks", input.string()));
  if (io::is_time_series(input))
    throw scene::bad_input(
        fmt::format("{}: is a time series, which only render takes; give one of its meshes", input.string()));
  return io::read_mesh(input, options);
}

io::MeshFile read_input(std::span<const std::filesystem::path> files, const io::MeshOptions& options) {
  return files.size() == 1 ? read_input(files.front(), options) : io::read_mesh(files, options);
}

io::MeshOptions options_of_later_steps(io::MeshOptions options, const io::MeshFile& first) {
  if (!options.field.empty() || first.fields.empty()) return options;
  options.field = first.mesh.field_name;
  // Smoothing has made point data of cell data, so only the name is sure.
  if (!options.smooth)
    options.field = (first.mesh.association == scene::Association::point ? "point:" : "cell:") + options.field;
  return options;
}

double diagonal(const scene::Box& box) {
  if (box.empty()) return 0;
  const glm::dvec3 extent = box.high - box.low;
  const double longest = std::max({extent.x, extent.y, extent.z});
  return longest > 0 ? glm::length(extent / longest) * longest : 0;  // 1e-200 must not underflow when squared
}

double default_unit_distance(const scene::MeshFacts& facts) {
  if (facts.mean_thickness > 0) return facts.mean_thickness / 10;
  const double extent = diagonal(facts.box);
  return extent > 0 ? extent / 20 : 1;
}

namespace {

colormaps::LoadedTransferFunction loaded_function(const scene::MeshFacts& facts, const RenderOptions& options) {
  colormaps::TransferFunctionOptions loading;
  loading.field_range = facts.scalar_range;
  loading.unit_distance = options.unit_distance;
  loading.default_unit_distance = default_unit_distance(facts);
  loading.display_colors = options.display_blend;
  loading.rescale = options.rescale;
  loading.opacity_scale = options.opacity_scale;
  if (options.transfer_function.empty() && options.is_volume) {
    auto loaded = io::load_transfer_function("cool-warm:rise", loading);
    loaded.name += " (default)";
    return loaded;
  }
  return options.transfer_function.empty() ? colormaps::default_transfer_function(loading)
                                           : io::load_transfer_function(options.transfer_function, loading);
}

}  // namespace

colormaps::LoadedTransferFunction transfer_function_of(const scene::MeshFacts& facts, const RenderOptions& options) {
  colormaps::LoadedTransferFunction loaded = loaded_function(facts, options);
  loaded.name = with_options(loaded.name);
  loaded.unit_distance_source = with_options(loaded.unit_distance_source);
  return loaded;
}

}  // namespace tessera::apps
