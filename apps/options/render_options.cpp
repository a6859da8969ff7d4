// SPDX-License-Identifier: BSD-3-Clause
#include "apps/options/render_options.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <limits>
#include <string_view>

#include "apps/options/argument_values.hpp"
#include "apps/options/compositing_options.hpp"
#include "apps/options/film_options.hpp"
#include "apps/options/method_words.hpp"
#include "apps/options/peel_options.hpp"
#include "apps/options/setting_words.hpp"
#include "apps/options/time_options.hpp"
#include "apps/options/volume_options.hpp"
#include "tessera/error.hpp"
#include "tessera/higher_order.hpp"
#include "tessera/input_file.hpp"
#include "tessera/time_series.hpp"

namespace tessera::apps {
namespace {

constexpr int no_limit = std::numeric_limits<int>::max();

Integrator mesh_integrator(const RenderWords& words) {
  const double accuracy = words.accuracy.empty() ? 1e-4 : parse_positive("--accuracy", words.accuracy);
  const auto integrator = parse_integrator("--integrator", words.integrator, accuracy);
  if (!words.accuracy.empty() && integrator.kind != IntegratorKind::automatic)
    throw bad_input(
        fmt::format("--accuracy: has no effect with --integrator {}; leave one of the two out", words.integrator));
  return integrator;
}

/// 0: all cores.
int thread_count(const RenderWords& words) {
  return words.threads.empty() ? 0 : parse_count("--threads", words.threads, 1, 1024);
}

/// What meshes and grids share, and what is of meshes.
void set_common(const RenderWords& words, RenderOptions& options) {
  check_word("--emission", words.emission, {"absorption", "independent"});
  check_word("--rasterizer", words.rasterizer, {"planes", "scanline", "device"});
  Settings& settings = options.settings;
  if (!options.is_grid()) {
    settings.integrator = mesh_integrator(words);
    if (words.higher_order_tolerance.empty()) {
      options.higher_order_accuracy =
          words.accuracy.empty() ? default_higher_order_accuracy : settings.integrator.accuracy;
      // At first as coarsely as read_for_accuracy() begins.
      options.read.higher_order_tolerance = first_higher_order_tolerance(*options.higher_order_accuracy);
    }
  }
  if (words.rasterizer == "scanline") settings.mesh.rasterizer = Rasterizer::scanline;
  if (words.rasterizer == "device") settings.mesh.rasterizer = Rasterizer::device;
  if (words.emission == "independent") settings.emission = Emission::independent;
  if (!words.deep_accuracy.empty())
    options.frame.deep_accuracy = parse_positive("--deep-accuracy", words.deep_accuracy);
  settings.threads = thread_count(words);
  if (!words.tile_size.empty()) settings.mesh.tile_size = parse_count("--tile-size", words.tile_size, 1, 1024);
  if (!words.memory.empty()) settings.memory_bytes = parse_bytes("--memory", words.memory);
}

ImageFileOptions image_options(const RenderWords& words) {
  check_word("--png-bits", words.png_bits, {"8", "16"});
  ImageFileOptions image;
  image.half = words.half;
  image.png_bits = words.png_bits == "16" ? 16 : 8;
  image.encode_srgb = words.blend != "display";
  image.threads = thread_count(words);
  if (!words.background.empty()) {
    const auto color = parse_color("--background", words.background);
    image.background = glm::dvec3(color[0], color[1], color[2]);
  }
  return image;
}

/// Jobs of several ranks, and devices.
void set_ranks(const RenderWords& words, bool merges, RenderOptions& options) {
  Settings& settings = options.settings;
  RankSettings& ranks = settings.ranks;
  if (!words.projectors.empty()) ranks.projectors = parse_count("--projectors", words.projectors, 1, no_limit);
  if (!words.compositors.empty()) ranks.compositors = parse_count("--compositors", words.compositors, 1, no_limit);
  if (!words.exchange.empty()) check_word("--exchange", words.exchange, {"runs", "segments"});
  settings.mesh.device = device_settings(words, options.is_grid());
  if (words.exchange == "segments" || !merges) ranks.exchange = Exchange::segments;
  if (words.exchange == "runs") ranks.exchange = Exchange::runs;
  if (words.exchange == "runs" && !merges)
    throw bad_input("--without merging: is --exchange segments, but runs were asked for; leave one of the two out");
  check_word("--partition", words.partition, {"curve", "file", "random"});
  if (words.partition == "file") ranks.partition.kind = PartitionKind::file;
  if (words.partition == "random") ranks.partition.kind = PartitionKind::random;
  if (!words.frames_in_flight.empty())
    ranks.frames_in_flight = parse_count("--frames-in-flight", words.frames_in_flight, 1, 64);
  if (!words.seed.empty())
    ranks.tile_seed = ranks.partition.seed = static_cast<std::uint64_t>(parse_count("--seed", words.seed, 0, no_limit));
}

/// NAME, NAME:FACTOR or off.
std::optional<Warp> warp_of(const std::string& word) {
  if (word.empty()) return std::nullopt;
  if (word == "off") return Warp{};
  const std::size_t colon = word.rfind(':');
  if (colon == std::string::npos) return Warp{word};
  const auto fault = [&](const char* what) {
    return bad_input(fmt::format("--warp: '{}' {}; write NAME, NAME:FACTOR or off", word, what));
  };
  if (colon == 0) throw fault("names no vector");
  try {
    return Warp{word.substr(0, colon), parse_number("--warp", word.substr(colon + 1))};
  } catch (const Error&) {
    throw fault("has no number behind its colon");
  }
}

/// Pictures that cannot be annotated.
void refuse_unannotated(const RenderOptions& options) {
  if (options.show_balance) throw bad_input("--show balance: its pictures are not annotated; leave one of the two out");
  if (options.annotation.layer.empty() && options.films.empty() && !options.to_standard_output &&
      std::ranges::all_of(options.plan.outputs, is_deep_name))
    throw bad_input("deep picture: it is not annotated; name an .exr, .png or .pfm too, or an --annotation-layer");
}

}  // namespace

void add_mesh_options(CLI::App& command, RenderWords& words) {
  command
      .add_option("INPUT", words.input,
                  "mesh: .vtu .pvtu .vtk .vtm .foam .case .cgns .ex2 .ele .tets .stl ...; volume: .vti .pvti .vtr "
                  ".pvtr .vtk .mhd .nrrd "
                  ".nii .nii.gz .raw")
      ->required();
  command
      .add_option("--field", words.field, "scalar: NAME, NAME:mag, NAME:x; with point: or cell: before it if needed")
      ->type_name("NAME");
  command.add_flag("--smooth", words.smooth, "average cell data to the points");
  command
      .add_option("--warp", words.warp,
                  "meshes: move points by FACTOR (default: 1) times this vector; off: not even Exodus' displacements")
      ->type_name("NAME[:FACTOR]|off");
  command.add_option("--q", words.q, "PLOT3D solution file, if it is not beside the grid")->type_name("FILE");
  command.add_option("--max-volume", words.max_volume, "surfaces: largest tetrahedron TetGen fills them with")
      ->type_name("VOLUME");
  add_time_options(command, words.time_step);
  command
      .add_option("--block", words.blocks,
                  "files in blocks: draw this one alone, of those that info lists; may be repeated")
      ->type_name("NAME")
      ->allow_extra_args(false);
  command.add_flag("--drop-duplicates", words.drop_duplicates,
                   "draw cells that have the corners of others once, where parts of the mesh are given twice");
  command
      .add_option("--scale", words.axis_scale,
                  "multiplies the axes (default: 1,1,1; degrees beside metres: z by what makes the box no thinner than "
                  "1:20)")
      ->type_name("X,Y,Z");
  add_clip_options(command, words.clip);
  command
      .add_option("--higher-order-tolerance", words.higher_order_tolerance,
                  "higher-order cells become tets this near to them, of diagonal and range (default: by --accuracy)")
      ->type_name("REL");
  command
      .add_option("--higher-order-tets", words.higher_order_tets,
                  "and about so many at most (default: by the mesh, from 262144; 0: by their corners)")
      ->type_name("N");
  add_volume_options(command, words);
}

ReadOptions mesh_options(const RenderWords& words) {
  ReadOptions mesh;
  mesh.grid_as_mesh = true;
  mesh.field = words.field;
  mesh.smooth = words.smooth;
  mesh.warp = warp_of(words.warp);
  mesh.plot3d_q = words.q;
  if (!words.max_volume.empty()) mesh.max_volume = parse_positive("--max-volume", words.max_volume);
  mesh.axis_scale = axis_scale_of(words);
  mesh.time_step = one_time_step(words.time_step);
  mesh.blocks = words.blocks;
  mesh.drop_duplicates = words.drop_duplicates;
  mesh.selection = selection_of(words.clip);
  for (const IsoSurface& iso : iso_surfaces_of(words.surfaces)) mesh.selection.levels.push_back(iso.value);
  if (!words.higher_order_tolerance.empty())
    mesh.higher_order_tolerance = parse_positive("--higher-order-tolerance", words.higher_order_tolerance);
  if (!words.higher_order_tets.empty())
    mesh.higher_order_tets =
        static_cast<std::uint64_t>(parse_count("--higher-order-tets", words.higher_order_tets, 0, no_limit));
  mesh.threads = thread_count(words);
  return mesh;
}

void add_render_options(CLI::App& command, RenderWords& words) {
  add_mesh_options(command, words);
  command.add_option("MORE", words.more_inputs,
                     "more meshes: a time series, as is INPUT alone if it is a .pvd, a .series or mesh_%04d.vtu");
  command
      .add_option("-o,--output", words.outputs,
                  "picture: .exr .png .jpg .tif .pfm .deep.exr, frame_%04d.png for several; film: .mp4 .mov .mkv .webm "
                  ".gif; - for a PNG on standard output; may be repeated")
      ->type_name("FILE")
      ->required()
      ->allow_extra_args(false);  // else `-o out.png mesh.vtu` would take the mesh for a second picture

  command.add_option("--transfer-function", words.transfer_function, "file or preset (see the guide), or JSON itself")
      ->type_name("FILE|PRESET|JSON");
  command.add_flag("--rescale", words.rescale, "stretch a transfer function file's values over the field's range");
  command
      .add_option("--unit-distance", words.unit_distance,
                  "world length over which a file's opacity holds (default: the file's, else mean thickness / 10)")
      ->type_name("LENGTH");
  command.add_option("--opacity-scale,--opacity", words.opacity_scale, "multiplies the extinction")
      ->type_name("FACTOR");
  add_function_options(command, words.function);
  add_surface_options(command, words.surfaces);
  command.add_option("--blend", words.blend, "linear light (default), or sRGB values as VTK does")
      ->type_name("linear|display");

  command
      .add_option("--camera", words.camera,
                  "view or list of views: .json .pvcc text, or JSON itself (default: frames the mesh)")
      ->type_name("FILE|JSON");
  add_view_options(command, words.view);
  command.add_option("--orbit", words.orbit, "N frames once round the view's up axis")->type_name("N");
  command.add_option("--size", words.size, "pixels (default: the camera file's, else 1024x1024)")->type_name("WxH");
  command.add_option("--projection", words.projection, "of the default view (default: orthographic)")
      ->type_name("orthographic|perspective");

  command
      .add_option("--integrator", words.integrator,
                  "how a segment becomes colour (default: auto); of volumes auto, exact, sampled or preintegrated")
      ->type_name("auto|exact|sampled:N|preintegrated[:N]|partial");
  command.add_option("--accuracy", words.accuracy, "auto: largest error in linear RGBA (default 1e-4)")
      ->type_name("EPS");
  command
      .add_option("--deep-accuracy", words.deep_accuracy,
                  ".deep.exr: largest error in linear RGBA of a sample cut anywhere (default 1e-3)")
      ->type_name("EPS");
  command.add_option("--emission", words.emission, "source term (default: absorption)")
      ->type_name("absorption|independent");
  command
      .add_option(
          "--rasterizer", words.rasterizer,
          "how cells become ray segments (default: planes; the paper's: scanline; device: as planes, by gl-compute)")
      ->type_name("planes|scanline|device");
  add_compositing_options(command, words);
  add_volume_render_options(command, words);
  command.add_option("--threads", words.threads, "threads (default: all cores)")->type_name("T");
  command.add_option("--tile-size", words.tile_size, "pixels a side of a thread's tile (default 32)")
      ->type_name("PIXELS");
  command
      .add_option("--memory", words.memory,
                  "budget of the frame buffers, or of a volume's bricks, like 512M (default 4G)")
      ->type_name("SIZE");

  command.add_option("--projectors", words.projectors, "under mpirun: ranks that project (default: all)")
      ->type_name("N");
  command.add_option("--compositors", words.compositors, "under mpirun: ranks that composite (default: all)")
      ->type_name("P");
  command
      .add_option(
          "--exchange", words.exchange,
          "under mpirun: what projectors send (default: runs; segments for deep pictures, scanline and devices)")
      ->type_name("runs|segments");
  command.add_option("--partition", words.partition, "under mpirun: which rank gets which cells (default: curve)")
      ->type_name("curve|file|random");
  command.add_option("--frames-in-flight", words.frames_in_flight, "under mpirun: frames on their way (default: 2)")
      ->type_name("F");
  command.add_option("--seed", words.seed, "under mpirun: of the tile map and of --partition random (default: 1)")
      ->type_name("NUMBER");

  command
      .add_option("--background", words.background,
                  "linear R,G,B, sRGB #rrggbb or CSS's name; without it the picture has alpha")
      ->type_name("R,G,B|#RRGGBB|NAME");
  add_film_options(command, words);
  add_peel_options(command, words.peel);
  command.add_flag("--half", words.half, ".exr with 16-bit floats");
  command.add_option("--png-bits", words.png_bits, "of .png and .tif (default: 8)")->type_name("8|16");

  add_annotation_options(command, words.annotation);

  command
      .add_option(
          "--without", words.without,
          "leave out what saves work, to see what it is worth: culling, skipping, termination, lattice, sharing, "
          "merging")
      ->type_name("WORD,...");
  command.add_flag("--resume", words.resume, "skip frames whose pictures exist");
  command.add_option("--repeat", words.repeat, "render each frame K times and print frame_ms median and min")
      ->type_name("K");
  command.add_option("--verify", words.verify, "check K random pixels a frame against the exact reference")
      ->type_name("K");
  command.add_option("--report", words.report, "JSON file: everything chosen, all counters; - for standard output")
      ->type_name("FILE");
  command.add_option("--timing", words.timing, "Chrome trace-event JSON file of stages and threads")->type_name("FILE");
  command.add_flag("--progress", words.progress, "a progress line (default: if stderr is a terminal)");
  command.add_flag("--quiet", words.quiet, "nothing on stderr but errors and warnings");
}

bool draws_grids(const RenderWords& words) {
  return is_time_series(words.input) ? opens_as_grid(read_time_series(words.input).front().files.front())
                                     : is_grid_input(words);
}

RenderOptions render_options(const RenderWords& words) { return render_options(words, draws_grids(words)); }

RenderOptions render_options(const RenderWords& words, bool is_grid) {
  RenderOptions options;
  FilmPlan& plan = options.plan;
  plan.inputs = {words.input};
  plan.inputs.insert(plan.inputs.end(), words.more_inputs.begin(), words.more_inputs.end());
  set_outputs(words, options);
  options.read = mesh_options(words);

  options.transfer_function = words.transfer_function;
  if (words.rescale && words.transfer_function.empty())
    throw bad_input("--rescale: is for a --transfer-function file; name one, or leave it out");
  if (!words.unit_distance.empty())
    options.function.unit_distance = parse_positive("--unit-distance", words.unit_distance);
  options.function.opacity_scale = parse_positive("--opacity-scale", words.opacity_scale);
  check_word("--blend", words.blend, {"linear", "display"});
  options.function.rescale = words.rescale;
  options.function.display_colors = words.blend == "display";
  options.function.rescale_presets = true;
  set_function(words.function, options.function);
  options.read.shape = words.transfer_function.empty();

  plan.cameras = words.camera;
  if (!words.orbit.empty()) plan.orbit = parse_count("--orbit", words.orbit, 1, 1'000'000);
  options.view = view_request(words.view, !words.camera.empty());
  if (!words.size.empty()) plan.size = parse_size("--size", words.size);
  if (!words.projection.empty()) {
    check_word("--projection", words.projection, {"orthographic", "perspective"});
    if (!words.camera.empty())
      throw bad_input("--projection: has no effect with --camera, whose file says it; leave one of the two out");
    if (words.projection == "perspective") options.projection = ProjectionKind::perspective;
  }

  plan.grids = is_grid;
  plan.steps = time_steps(words.time_step);
  set_common(words, options);
  Settings& settings = options.settings;
  const WithoutWords without = parse_without("--without", words.without);
  options.without = words.without;
  settings.use = without.use;
  settings.integrator.terminates = without.use.termination;
  if (plan.grids) {
    const int threads = options.read.threads;
    options.read = volume_options(words);
    options.read.threads = threads;
    set_grid(words, settings);
    set_distribution(words, settings.ranks);
    set_balance(words, settings.ranks);
    options.show_balance = options.frame.keep_cost = !words.show.empty();
    refuse_mesh_words(words);
  } else {
    refuse_volume_options(words);
    settings.mesh.shading = shading_of(words);
  }
  if (options.read.time_step && is_series(plan)) {  // a step of the series, not of its files
    plan.steps = StepRange{*options.read.time_step, options.read.time_step};
    options.read.time_step.reset();
  }
  options.no_shade = words.no_shade;
  options.frame.deep = std::ranges::any_of(plan.outputs, is_deep_name);
  if (!options.frame.deep && words.peel.empty() && !words.deep_accuracy.empty())
    throw bad_input("--deep-accuracy: is for a deep picture; name one with -o FILE.deep.exr, or leave it out");
  set_peel(words, options);
  options.image = image_options(words);
  options.annotation = annotation_options(words.annotation, options.image);
  if (options.annotation.annotation) refuse_unannotated(options);
  if (words.function.log && words.annotation.scale.empty() && options.annotation.annotation) {
    auto& bar = options.annotation.annotation->color_bar;
    if (bar) bar->logarithmic = !bar->range || (*bar->range)[0] > 0;
  }
  settings.surfaces = surfaces_of(words.surfaces, options.block_surfaces);
  if (plan.grids && !options.block_surfaces.empty())
    throw bad_input("--surface: is for meshes, and the input is a volume; --iso VALUE shows a surface in one");
  set_ranks(words, without.merging, options);
  plan.resume = words.resume;
  if (!words.repeat.empty()) options.repeat = parse_count("--repeat", words.repeat, 1, no_limit);
  if (options.repeat > 0) settings.ranks.frames_in_flight = 1;  // a time is of one frame alone
  if (!words.verify.empty()) options.verify = parse_count("--verify", words.verify, 1, no_limit);
  options.frame.keep_uncertainty = plan.grids && options.verify > 0;
  options.report = words.report;
  options.timing = words.timing;
  options.saved_scene = words.save_config;
  options.scene = words.scene;
  options.quiet = words.quiet;
  options.progress = !words.quiet && (words.progress || isatty(STDERR_FILENO) == 1);
  return options;
}

void refuse_mesh_options(const RenderWords& words, const RenderOptions& options) {
  const auto refuse = [&](const char* option) {
    require_input(options.input());
    throw bad_input(fmt::format("{}: is for meshes, and the input is a volume; leave it out", option));
  };
  const ReadOptions& read = mesh_options(words);
  const bool deep = options.frame.deep && !options.frame.peel;
  if (deep && takes_steps(options.settings.integrator))
    throw bad_input(
        fmt::format("deep picture: --integrator {} gives a step other light than its parts; use auto or "
                    "exact",
                    method_word(options.settings.integrator.kind)));
  if (deep && options.settings.grid.shading) throw bad_input("deep picture: it is not shaded; leave --shade out");
  if (options.frame.deep && options.show_balance)
    throw bad_input("deep picture: --show balance draws none; name an .exr, .png or .pfm");
  if (options.settings.mesh.rasterizer != Rasterizer::planes) refuse("--rasterizer");
  if (read.smooth) refuse("--smooth");
  if (read.warp) refuse("--warp");
  if (read.drop_duplicates) refuse("--drop-duplicates");
  if (read.max_volume) refuse("--max-volume");
  if (!words.higher_order_tolerance.empty()) refuse("--higher-order-tolerance");
  if (!words.higher_order_tets.empty()) refuse("--higher-order-tets");
  if (!read.blocks.empty()) refuse("--block");
  if (!read.plot3d_q.empty()) refuse("--q");
}

LoadedTransferFunction transfer_function_of(const Dataset& data, const RenderOptions& options) {
  TransferFunctionOptions function = options.function;
  function.emission = options.settings.emission;
  function.with_surfaces = !options.settings.surfaces.empty() || !options.block_surfaces.empty();
  LoadedTransferFunction loaded = data.transfer_function(options.transfer_function, function);
  loaded.name = with_options(loaded.name);
  loaded.unit_distance_source = with_options(loaded.unit_distance_source);
  loaded.warnings = with_options(loaded.warnings);
  if (options.settings.mesh.shading && data.is_mesh() && data.association() == Association::cell)
    loaded.warnings.emplace_back(
        "--shade: lights nothing, a value of each cell has no gradient; --smooth gives values at the points");
  if (!options.settings.surfaces.empty())
    for (const std::string& warning : unseen_surfaces(options.settings.surfaces, data.range()))
      loaded.warnings.push_back(warning);
  return loaded;
}

bool shades_by_default(const LoadedTransferFunction& loaded, const RenderOptions& options) {
  const Settings& settings = options.settings;
  if (!loaded.shaded || options.no_shade || (options.frame.deep && !options.frame.peel) || settings.grid.shading)
    return false;
  return !takes_steps(settings.integrator) && settings.emission == Emission::absorption;
}

}  // namespace tessera::apps
