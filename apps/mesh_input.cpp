#include "apps/mesh_input.hpp"

#include "apps/setting_words.hpp"

namespace tessera::apps {

MeshSummary summary_of(const io::MeshFile& file, int threads) {
  return summary_of(file, scene::facts_of(file.mesh, threads));
}

MeshSummary summary_of(const io::MeshFile& description, const scene::MeshFacts& facts) {
  return {description.counts, description.fields,          with_options(description.notes),
          description.format, description.mesh.field_name, facts};
}

io::MeshOptions options_of_later_steps(io::MeshOptions options, const io::MeshFile& first) {
  if (!options.field.empty() || first.fields.empty()) return options;
  options.field = first.mesh.field_name;
  // Smoothing has made point data of cell data, so only the name is sure.
  if (!options.smooth)
    options.field = (first.mesh.association == scene::Association::point ? "point:" : "cell:") + options.field;
  return options;
}

colormaps::LoadedTransferFunction transfer_function_of(const scene::MeshFacts& facts, const RenderOptions& options) {
  colormaps::LoadedTransferFunction loaded = frame::transfer_function_of(
      facts, options.is_volume, options.transfer_function,
      {options.unit_distance, options.opacity_scale, options.display_blend, options.rescale});
  loaded.name = with_options(loaded.name);
  loaded.unit_distance_source = with_options(loaded.unit_distance_source);
  return loaded;
}

}  // namespace tessera::apps
