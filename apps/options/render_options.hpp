// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/options/annotation_options.hpp"
#include "apps/options/cli_fwd.hpp"
#include "apps/options/clip_options.hpp"
#include "apps/options/function_options.hpp"
#include "apps/options/surface_options.hpp"
#include "apps/options/view_options.hpp"
#include "tessera/camera.hpp"
#include "tessera/dataset.hpp"
#include "tessera/image_file.hpp"
#include "tessera/program/film.hpp"
#include "tessera/settings.hpp"

namespace tessera::apps {

/// How `tessera render` was called, checked and in values. Files are not looked at yet.
struct RenderOptions {
  FilmPlan plan;  ///< at least one output
  ReadOptions read;
  Settings settings;
  FrameSettings frame;
  bool show_balance = false;

  std::string transfer_function;  ///< file or preset; empty: the default one
  TransferFunctionOptions function;
  ViewRequest view;
  ProjectionKind projection = ProjectionKind::orthographic;  ///< of the view that frames the data
  std::string without;                                       ///< the words of --without, as given
  ImageFileOptions image;
  AnnotationOptions annotation;

  std::vector<BlockSurfaceWord> block_surfaces;  ///< beside settings.surfaces, which has them once the input is read

  bool no_shade = false;                        ///< not even where the default transfer function asks for it
  std::optional<double> higher_order_accuracy;  ///< of read_for_accuracy(); none: `read` has the tolerance

  int repeat = 0;  ///< 0: render once and print no times
  int verify = 0;  ///< pixels a frame to check against the reference; 0: none
  std::filesystem::path report, timing, saved_scene;
  std::string scene;                         ///< text of saved_scene
  std::vector<std::filesystem::path> films;  ///< of all frames, beside the plan's pictures
  double frame_rate = 25;                    ///< of films
  bool to_standard_output = false;           ///< every picture as .png
  bool report_to_standard_output = false;
  bool progress = false;
  bool quiet = false;

  /// The run's input: a mesh, a grid, or what names a time series; of several the first.
  [[nodiscard]] const std::filesystem::path& input() const { return plan.inputs.front(); }
  [[nodiscard]] bool is_grid() const { return plan.grids; }
};

/// The words as they stand on the command line. CLI11 keeps references to them until it has parsed.
struct RenderWords {
  std::string input, field, warp, q, max_volume, axis_scale, time_step, higher_order_tolerance, higher_order_tets;
  std::vector<std::string> blocks;
  std::vector<std::string> more_inputs, outputs;
  std::string transfer_function, unit_distance, opacity_scale = "1", blend = "linear";
  std::string camera, orbit, size, projection;
  std::string integrator = "auto", accuracy, deep_accuracy, emission = "absorption", rasterizer = "planes";
  std::string backend, compositor, framebuffer, egl_device;
  std::string without;
  std::string threads, tile_size, memory, background, png_bits = "8", frame_rate, repeat, verify, report, timing, peel;
  std::string dims, type, spacing, origin, endian, skip, labels, step, brick_size, edge_bricks, cache, preload, light;
  std::string distribution, direct_send, balance, balance_resolution, balance_weights, show;
  std::string projectors, compositors, exchange, partition = "curve", frames_in_flight, seed;
  std::string like, preset, config, save_config;
  std::string scene;  ///< text of save_config
  AnnotationWords annotation;
  ClipWords clip;
  ViewWords view;
  FunctionWords function;
  SurfaceWords surfaces;
  bool smooth = false, drop_duplicates = false, shade = false, no_shade = false, half = false, rescale = false,
       resume = false, progress = false, quiet = false;
};

/// Declares the options of `tessera render` on its subcommand.
void add_render_options(CLI::App& command, RenderWords& words);

/// The options that say how a mesh is read; `info` and `convert` have them too.
void add_mesh_options(CLI::App& command, RenderWords& words);
ReadOptions mesh_options(const RenderWords& words);

/// Whether volumes are drawn: of a list of files its first says it.
bool draws_grids(const RenderWords& words);

/// Words to values. Throws Error(bad_input) naming the option: what it was given, what it takes; also for words
/// that the design knows but this version cannot do yet, and for options that would have no effect together.
RenderOptions render_options(const RenderWords& words);
/// The same where it is known already whether the input is a grid, which else is looked into.
RenderOptions render_options(const RenderWords& words, bool is_grid);

/// Of `render`, once it is known that a grid is rendered: throws for options that are for meshes, and for deep pictures
/// that cannot be made.
void refuse_mesh_options(const RenderWords& words, const RenderOptions& options);

/// The transfer function that the options name, or the default one, its words as the program says them.
LoadedTransferFunction transfer_function_of(const Dataset& data, const RenderOptions& options);

/// Whether a picture is shaded because the default transfer function means it to be, and no option speaks against it.
bool shades_by_default(const LoadedTransferFunction& loaded, const RenderOptions& options);

}  // namespace tessera::apps
