#include "apps/render_options.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <limits>
#include <string_view>

#include "apps/argument_values.hpp"
#include "apps/compositing_options.hpp"
#include "apps/volume_options.hpp"
#include "io/image_deep_exr.hpp"
#include "scene/error.hpp"

namespace tessera::apps {
namespace {

constexpr int no_limit = std::numeric_limits<int>::max();

scene::Integrator chosen_integrator(const RenderWords& words) {
  const double accuracy = words.accuracy.empty() ? 1e-4 : parse_positive("--accuracy", words.accuracy);
  const auto integrator = parse_integrator("--integrator", words.integrator, accuracy);
  if (!words.accuracy.empty() && integrator.kind != scene::IntegratorKind::automatic)
    throw scene::bad_input(
        fmt::format("--accuracy: has no effect with --integrator {}; leave one of the two out", words.integrator));
  return integrator;
}

/// 0: all cores.
int thread_count(const RenderWords& words) {
  return words.threads.empty() ? 0 : parse_count("--threads", words.threads, 1, 1024);
}

frame::RenderSettings render_settings(const RenderWords& words, bool for_volume) {
  check_word("--emission", words.emission, {"absorption", "independent"});
  check_word("--rasterizer", words.rasterizer, {"planes", "scanline"});
  frame::RenderSettings settings;
  if (!for_volume) settings.integrator = chosen_integrator(words);
  if (words.rasterizer == "scanline") settings.rasterizer = frame::Rasterizer::scanline;
  if (words.emission == "independent") settings.emission = scene::Emission::independent;
  if (!words.deep_accuracy.empty()) settings.deep_accuracy = parse_positive("--deep-accuracy", words.deep_accuracy);
  settings.threads = thread_count(words);
  if (!words.tile_size.empty()) settings.tile_size = parse_count("--tile-size", words.tile_size, 1, 1024);
  if (!words.memory.empty()) settings.memory_bytes = parse_bytes("--memory", words.memory);
  return settings;
}

io::ImageFileOptions image_options(const RenderWords& words) {
  check_word("--png-bits", words.png_bits, {"8", "16"});
  io::ImageFileOptions image;
  image.half = words.half;
  image.png_bits = words.png_bits == "16" ? 16 : 8;
  image.encode_srgb = words.blend != "display";
  if (!words.background.empty()) {
    const auto color = parse_color("--background", words.background);
    image.background = glm::dvec3(color[0], color[1], color[2]);
  }
  return image;
}

}  // namespace

void add_mesh_options(CLI::App& command, RenderWords& words) {
  command
      .add_option("INPUT", words.input,
                  "mesh: .vtu .pvtu .vtk .ex2 .xyz .ele .tets .stl ...; volume: .vti .pvti .vtr .pvtr .vtk .mhd .nrrd "
                  ".nii .nii.gz .raw")
      ->required();
  command
      .add_option("--field", words.field, "scalar: NAME, NAME:mag, NAME:x; with point: or cell: before it if needed")
      ->type_name("NAME");
  command.add_flag("--smooth", words.smooth, "average cell data to the points");
  command.add_option("--q", words.q, "PLOT3D solution file, if it is not beside the grid")->type_name("FILE");
  command.add_option("--max-volume", words.max_volume, "surfaces: largest tetrahedron TetGen fills them with")
      ->type_name("VOLUME");
  command.add_option("--time-step", words.time_step, "Exodus: step counted from 0 (default: the last)")
      ->type_name("STEP");
  add_volume_options(command, words);
}

io::MeshOptions mesh_options(const RenderWords& words) {
  io::MeshOptions mesh;
  mesh.field = words.field;
  mesh.smooth = words.smooth;
  mesh.plot3d_q = words.q;
  if (!words.max_volume.empty()) mesh.max_volume = parse_positive("--max-volume", words.max_volume);
  if (!words.time_step.empty())
    mesh.time_step = static_cast<std::size_t>(parse_count("--time-step", words.time_step, 0, no_limit));
  mesh.threads = thread_count(words);
  return mesh;
}

void add_render_options(CLI::App& command, RenderWords& words) {
  add_mesh_options(command, words);
  command.add_option("MORE", words.more_inputs,
                     "more meshes: a time series, as is INPUT alone if it is a .pvd or mesh_%04d.vtu");
  command
      .add_option("-o,--output", words.outputs,
                  "picture: .exr .png .pfm .deep.exr; frame_%04d.exr numbers several frames; may be repeated")
      ->type_name("FILE")
      ->required()
      ->allow_extra_args(false);  // else `-o out.png mesh.vtu` would take the mesh for a second picture

  command.add_option("--transfer-function", words.transfer_function, "file or preset (see the guide)")
      ->type_name("FILE|PRESET");
  command.add_flag("--rescale", words.rescale, "stretch a transfer function file's values over the field's range");
  command
      .add_option("--unit-distance", words.unit_distance,
                  "world length over which a file's opacity holds (default: the file's, else mean thickness / 10)")
      ->type_name("LENGTH");
  command.add_option("--opacity-scale", words.opacity_scale, "multiplies the extinction")->type_name("FACTOR");
  command.add_option("--blend", words.blend, "linear light (default), or sRGB values as VTK does")
      ->type_name("linear|display");

  command.add_option("--camera", words.camera, "view or list of views: .json .pvcc text (default: frames the mesh)")
      ->type_name("FILE");
  command.add_option("--orbit", words.orbit, "N frames once round the view's up axis")->type_name("N");
  command.add_option("--size", words.size, "pixels (default: the camera file's, else 1024x1024)")->type_name("WxH");
  command.add_option("--projection", words.projection, "of the default view (default: orthographic)")
      ->type_name("orthographic|perspective");

  command.add_option("--integrator", words.integrator, "how a segment becomes colour (default: auto)")
      ->type_name("auto|exact|sampled:N|preintegrated[:N]|partial; of volumes auto|exact|sampled|preintegrated");
  command.add_option("--accuracy", words.accuracy, "auto: largest error in linear RGBA (default 1e-4)")
      ->type_name("EPS");
  command
      .add_option("--deep-accuracy", words.deep_accuracy,
                  ".deep.exr: largest error in linear RGBA of a sample cut anywhere (default 1e-3)")
      ->type_name("EPS");
  command.add_option("--emission", words.emission, "source term (default: absorption)")
      ->type_name("absorption|independent");
  command
      .add_option("--rasterizer", words.rasterizer,
                  "how cells become ray segments (default: planes; the paper's: scanline)")
      ->type_name("planes|scanline");
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
  command.add_option("--exchange", words.exchange, "under mpirun: what projectors send (default: runs)")
      ->type_name("runs|segments");
  command.add_option("--partition", words.partition, "under mpirun: which rank gets which cells (default: curve)")
      ->type_name("curve|file|random");
  command.add_option("--frames-in-flight", words.frames_in_flight, "under mpirun: frames on their way (default: 2)")
      ->type_name("F");
  command.add_option("--seed", words.seed, "under mpirun: of the tile map and of --partition random (default: 1)")
      ->type_name("NUMBER");

  command.add_option("--background", words.background, "linear light; without it the picture has alpha")
      ->type_name("R,G,B|NAME");
  command.add_flag("--half", words.half, ".exr with 16-bit floats");
  command.add_option("--png-bits", words.png_bits, "default: 8")->type_name("8|16");

  command
      .add_option(
          "--without", words.without,
          "leave out what saves work, to see what it is worth: culling, skipping, termination, lattice, merging")
      ->type_name("WORD,...");
  command.add_flag("--resume", words.resume, "skip frames whose pictures exist");
  command.add_option("--repeat", words.repeat, "render each frame K times and print frame_ms median and min")
      ->type_name("K");
  command.add_option("--verify", words.verify, "check K random pixels a frame against the exact reference")
      ->type_name("K");
  command.add_option("--report", words.report, "JSON file: everything chosen, all counters")->type_name("FILE");
  command.add_option("--timing", words.timing, "Chrome trace-event JSON file of stages and threads")->type_name("FILE");
  command.add_flag("--progress", words.progress, "a progress line (default: if stderr is a terminal)");
  command.add_flag("--quiet", words.quiet, "nothing on stderr but errors");
}

RenderOptions render_options(const RenderWords& words) {
  RenderOptions options;
  options.input = words.input;
  options.more_inputs = {words.more_inputs.begin(), words.more_inputs.end()};
  options.outputs.assign(words.outputs.begin(), words.outputs.end());
  options.mesh = mesh_options(words);

  options.transfer_function = words.transfer_function;
  if (words.rescale && words.transfer_function.empty())
    throw scene::bad_input("--rescale: is for a --transfer-function file; name one, or leave it out");
  if (!words.unit_distance.empty()) options.unit_distance = parse_positive("--unit-distance", words.unit_distance);
  options.opacity_scale = parse_positive("--opacity-scale", words.opacity_scale);
  check_word("--blend", words.blend, {"linear", "display"});
  options.rescale = words.rescale;
  options.display_blend = words.blend == "display";

  options.camera_file = words.camera;
  if (!words.orbit.empty()) options.orbit = parse_count("--orbit", words.orbit, 1, 1'000'000);
  if (!words.size.empty()) options.size = parse_size("--size", words.size);
  if (!words.projection.empty()) {
    check_word("--projection", words.projection, {"orthographic", "perspective"});
    if (!words.camera.empty())
      throw scene::bad_input("--projection: has no effect with --camera, whose file says it; leave one of the two out");
    if (words.projection == "perspective") options.projection = scene::ProjectionKind::perspective;
  }

  options.is_volume = is_volume_input(words);
  options.settings = render_settings(words, options.is_volume);
  const WithoutWords without = parse_without("--without", words.without);
  options.without = words.without;
  options.settings.use = without.use;
  options.settings.integrator.terminates = without.use.termination;
  if (options.is_volume) {
    options.volume = volume_options(words);
    options.volume_settings = volume_settings(words, options.settings);
    options.balance = balance_settings(words);
    options.show_balance = !words.show.empty();
    refuse_mesh_words(words);
  } else {
    refuse_volume_options(words);
  }
  options.deep = std::ranges::any_of(options.outputs, io::is_deep_name);
  if (!options.deep && !words.deep_accuracy.empty())
    throw scene::bad_input("--deep-accuracy: is for a deep picture; name one with -o FILE.deep.exr, or leave it out");
  options.image = image_options(words);
  if (!words.projectors.empty()) options.projectors = parse_count("--projectors", words.projectors, 1, no_limit);
  if (!words.compositors.empty()) options.compositors = parse_count("--compositors", words.compositors, 1, no_limit);
  if (!words.exchange.empty()) check_word("--exchange", words.exchange, {"runs", "segments"});
  options.compositing_on = compositing_settings(words, options.is_volume);
  options.settings.bounded = !composites_as_printed(options.compositing_on);
  if (words.exchange.empty() && (options.settings.rasterizer == frame::Rasterizer::scanline || options.deep ||
                                 !options.compositing_on.backends.empty()))
    // The paper's do not touch; deep samples are cut within segments; a device that only got runs had nothing to do.
    options.exchange = frame::Exchange::segments;
  if (words.exchange == "segments" || !without.merging) options.exchange = frame::Exchange::segments;
  if (words.exchange == "runs" && !without.merging)
    throw scene::bad_input(
        "--without merging: is --exchange segments, but runs were asked for; leave one of the two out");
  check_word("--partition", words.partition, {"curve", "file", "random"});
  if (words.partition == "file") options.partition.kind = projection::PartitionKind::file;
  if (words.partition == "random") options.partition.kind = projection::PartitionKind::random;
  if (!words.frames_in_flight.empty())
    options.frames_in_flight = parse_count("--frames-in-flight", words.frames_in_flight, 1, 64);
  if (!words.seed.empty())
    options.tile_seed = options.partition.seed =
        static_cast<std::uint64_t>(parse_count("--seed", words.seed, 0, no_limit));
  options.resume = words.resume;
  if (!words.repeat.empty()) options.repeat = parse_count("--repeat", words.repeat, 1, no_limit);
  if (!words.verify.empty()) options.verify = parse_count("--verify", words.verify, 1, no_limit);
  options.report = words.report;
  options.timing = words.timing;
  options.quiet = words.quiet;
  options.progress = !words.quiet && (words.progress || isatty(STDERR_FILENO) == 1);
  return options;
}

}  // namespace tessera::apps
