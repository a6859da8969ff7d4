#include "apps/session_options.hpp"

#include "apps/setting_words.hpp"

namespace tessera::apps {
namespace {

IntegratorKind kind_of(volume::Method method) {
  switch (method) {
    case volume::Method::exact:
      return IntegratorKind::exact;
    case volume::Method::sampled:
      return IntegratorKind::sampled;
    case volume::Method::preintegrated:
      return IntegratorKind::preintegrated;
    case volume::Method::automatic:
      break;
  }
  return IntegratorKind::automatic;
}

}  // namespace

Settings session_settings(const RenderOptions& o) {
  Settings s;
  s.integrator = o.settings.integrator;
  s.emission = o.settings.emission;
  s.use = o.settings.use;
  s.threads = o.settings.threads;
  s.memory_bytes = o.settings.memory_bytes;
  s.mesh = {o.settings.rasterizer, o.settings.tile_size};
  s.ranks.projectors = o.projectors;
  s.ranks.compositors = o.compositors;
  s.ranks.exchange = o.exchange;
  s.ranks.partition = o.partition;
  s.ranks.frames_in_flight = o.repeat > 0 ? 1 : o.frames_in_flight;  // a time is of one frame alone
  s.ranks.tile_seed = o.tile_seed;
  if (!o.is_volume) return s;
  const volume::RenderSettings& v = o.volume_settings;
  s.integrator.kind = kind_of(v.method);
  s.integrator.accuracy = v.accuracy;
  s.emission = v.emission;
  s.use = v.use;
  s.threads = v.threads;
  s.memory_bytes = v.memory_bytes;
  s.grid = {v.step, v.shading, v.brick_size, v.edge_bricks, v.cache, v.preload_limit};
  s.ranks.balance = o.balance.balance;
  s.ranks.balance_resolution = o.balance.resolution;
  s.ranks.balance_weights = o.balance.weights;
  return s;
}

ReadOptions read_options(const io::MeshOptions& o) {
  ReadOptions read;
  read.field = o.field;
  read.threads = o.threads;
  read.smooth = o.smooth;
  read.plot3d_q = o.plot3d_q;
  read.max_volume = o.max_volume;
  read.time_step = o.time_step;
  read.grid_as_mesh = true;
  return read;
}

ReadOptions read_options(const io::VolumeOptions& o) {
  ReadOptions read;
  read.field = o.field;
  read.dims = o.dims;
  read.type = o.type;
  read.spacing = o.spacing, read.origin = o.origin;
  read.big_endian = o.big_endian;
  read.skip = o.skip;
  return read;
}

ReadOptions read_options(const RenderOptions& o) {
  if (!o.is_volume) return read_options(o.mesh);
  ReadOptions read = read_options(o.volume);
  read.threads = o.volume_settings.threads;
  return read;
}

ReadOptions read_of_later_steps(ReadOptions options, const Dataset& first) {
  if (first.is_grid() || !options.field.empty() || first.fields().empty()) return options;
  options.field = first.field_name();
  // Smoothing has made point data of cell data, so only the name is sure.
  if (!options.smooth) options.field = (first.association() == Association::point ? "point:" : "cell:") + options.field;
  return options;
}

LoadedTransferFunction transfer_function_of(const Dataset& data, const RenderOptions& options) {
  LoadedTransferFunction loaded =
      data.transfer_function(options.transfer_function,
                             {options.unit_distance, options.opacity_scale, options.display_blend, options.rescale});
  loaded.name = with_options(loaded.name);
  loaded.unit_distance_source = with_options(loaded.unit_distance_source);
  return loaded;
}

}  // namespace tessera::apps
