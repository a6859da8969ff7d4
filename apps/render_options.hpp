#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "frame/distributed.hpp"
#include "frame/render.hpp"
#include "frame/sort_first.hpp"
#include "io/image_file.hpp"
#include "io/mesh_reader.hpp"
#include "io/volume_reader.hpp"
#include "projection/partition.hpp"
#include "scene/camera.hpp"
#include "volume/render.hpp"

namespace tessera::apps {

/// How `tessera render` was called, checked and in values. Files are not looked at yet.
struct RenderOptions {
  std::filesystem::path input;                     ///< a mesh, or what names a time series
  std::vector<std::filesystem::path> more_inputs;  ///< with `input` the steps of a time series
  std::vector<std::filesystem::path> outputs;      ///< at least one; several are the same frame in several formats
  io::MeshOptions mesh;
  bool is_volume = false;  ///< the input is a grid: `volume` and `volume_settings` count, not `mesh` and `settings`
  io::VolumeOptions volume;
  volume::RenderSettings volume_settings;
  frame::SortFirstSettings balance;  ///< of a volume's picture between ranks
  bool show_balance = false;

  std::string transfer_function;  ///< file or preset; empty: the default one
  std::optional<double> unit_distance;
  double opacity_scale = 1;
  bool display_blend = false;
  bool rescale = false;  ///< stretch a file's values over the field's range

  std::filesystem::path camera_file;                                       ///< empty: the view that frames the mesh
  int orbit = 0;                                                           ///< frames of one turn; 0: no orbit
  std::optional<scene::ImageSize> size;                                    ///< wins over the camera file's
  scene::ProjectionKind projection = scene::ProjectionKind::orthographic;  ///< of the view that frames the mesh

  frame::RenderSettings settings;
  std::string without;  ///< the words of --without, as given
  io::ImageFileOptions image;
  bool deep = false;  ///< an output is a deep picture

  // Jobs of several ranks; a single process has no use for them.
  std::optional<int> projectors, compositors;
  frame::Exchange exchange = frame::Exchange::runs;
  projection::Partition partition;
  frame::CompositingSettings compositing_on;
  int frames_in_flight = 2;
  std::uint64_t tile_seed = 1;  ///< of the tile map

  bool resume = false;
  int repeat = 0;  ///< 0: render once and print no times
  int verify = 0;  ///< pixels a frame to check against the reference; 0: none
  std::filesystem::path report, timing;
  bool progress = false;
  bool quiet = false;
};

/// The words as they stand on the command line. CLI11 keeps references to them until it has parsed.
struct RenderWords {
  std::string input, field, q, max_volume, time_step;
  std::vector<std::string> more_inputs, outputs;
  std::string transfer_function, unit_distance, opacity_scale = "1", blend = "linear";
  std::string camera, orbit, size, projection;
  std::string integrator = "auto", accuracy, deep_accuracy, emission = "absorption", rasterizer = "planes";
  std::string backend, compositor, framebuffer, egl_device;
  std::string without;
  std::string threads, tile_size, memory, background, png_bits = "8", repeat, verify, report, timing;
  std::string dims, type, spacing, origin, endian, skip, step, brick_size, cache, preload, light;
  std::string balance, balance_resolution, balance_weights, show;
  std::string projectors, compositors, exchange, partition = "curve", frames_in_flight, seed;
  bool smooth = false, shade = false, half = false, rescale = false, resume = false, progress = false, quiet = false;
};

/// Declares the options of `tessera render` on its subcommand.
void add_render_options(CLI::App& command, RenderWords& words);

/// The options that say how a mesh is read; `info` and `convert` have them too.
void add_mesh_options(CLI::App& command, RenderWords& words);
io::MeshOptions mesh_options(const RenderWords& words);

/// Words to values. Throws scene::Error(bad_input) naming the option: what it was given, what it takes; also for words
/// that the design knows but this version cannot do yet, and for options that would have no effect together.
RenderOptions render_options(const RenderWords& words);

}  // namespace tessera::apps
