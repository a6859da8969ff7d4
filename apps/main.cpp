// The `tessera` program: subcommands over the libraries. Everything that goes wrong ends here, in one line on stderr
// and an exit status (ExitCode).

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <optional>
#include <sstream>

#include "apps/argument_values.hpp"
#include "apps/chart_command.hpp"
#include "apps/convert_command.hpp"
#include "apps/film.hpp"
#include "apps/formats_command.hpp"
#include "apps/generate_command.hpp"
#include "apps/info_command.hpp"
#include "apps/render_options.hpp"
#include "apps/setting_words.hpp"
#include "apps/stall_options.hpp"
#include "apps/standard_streams.hpp"
#include "apps/timing_command.hpp"
#include "apps/volume_options.hpp"
#include "tessera/input_file.hpp"
#include "tessera/job.hpp"
#include "tessera/output_file.hpp"
#include "tessera/version.hpp"

namespace tessera::apps {
namespace {

/// One line whatever the message holds: file names may contain line breaks, and libraries' messages do. Nothing if the
/// run's line has been said. Settings are options in it.
int fail(const Error& error) {
  std::string line = "tessera: ";
  for (const char c : with_stream_names(with_options(error.what())))
    line += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
  while (line.ends_with(' ')) line.pop_back();
  Job::say_once(line);
  return static_cast<int>(error.code());
}

/// Whether a rectilinear grid, which is a volume, is asked for as the mesh that it is too.
bool to_mesh(const std::filesystem::path& input, const std::filesystem::path& output) {
  const auto extension = output.extension();
  return (extension == ".vtu" || extension == ".tets" || extension == ".pvtu") && opens_as_mesh(input);
}

ExitCode run(int argc, char** argv, Job& job) {
  job.answer_termination();
  job.agree_instruction_sets();

  CLI::App app("Tessera renders scientific volumes: unstructured meshes and regular grids, exactly, on the CPU.",
               "tessera");
  app.set_version_flag("--version", std::string("tessera ") + TESSERA_VERSION);
  app.require_subcommand(1);

  RenderWords words;
  StallWords stall_words;
  auto* render_command = app.add_subcommand("render", "Render a mesh or a volume to pictures");
  add_render_options(*render_command, words);
  add_stall_options(*render_command, stall_words);

  bool as_json = false;
  auto* info_command = app.add_subcommand("info", "Say what a mesh or volume holds and how it would be rendered");
  add_mesh_options(*info_command, words);
  info_command->add_flag("--json", as_json, "for machines");
  bool check = false;
  info_command->add_flag("--check", check, "meshes: overlapping cells, folds, unmatched faces, slivers, duplicates");

  auto* convert_command = app.add_subcommand("convert", "Write a mesh as tetrahedra, or a volume, with one scalar");
  add_mesh_options(*convert_command, words);
  std::string mesh_output;
  convert_command
      ->add_option("OUT", mesh_output,
                   "of a mesh .vtu, .tets, or .pvtu with --pieces; of a volume .vti .vtr .nrrd .raw .bricks")
      ->required();
  std::string pieces, pieces_partition = "curve";
  convert_command->add_option("--pieces", pieces, "write OUT.pvtu and so many pieces, for mpirun");
  convert_command->add_option("--partition", pieces_partition,
                              "which piece a cell goes to: curve (compact, the default), file (order kept), random");
  std::string subdivide = "0";
  convert_command->add_option("--subdivide", subdivide, "of a mesh: times every tetrahedron is cut into eight");
  convert_command->get_option("--block")->description(
      "of a mesh in blocks: write this one alone; may be repeated; of .bricks: samples a side of a block (default 64)");
  convert_command->add_flag("--quiet", words.quiet, "nothing on stderr but errors");

  auto* generate_command = app.add_subcommand("generate", "Make a mesh or a volume");
  std::string kind;
  std::vector<std::string> parameters;
  generate_command->add_option("KIND", kind, "what to make, see below")->required();
  generate_command->add_option("OUT", mesh_output, "of a mesh .vtu or .tets; of a volume .vti .nrrd .raw .bricks")
      ->required();
  generate_command->add_option("PARAMETERS", parameters, "NAME=VALUE ...");
  generate_command->add_flag("--quiet", words.quiet, "nothing on stderr but errors");
  generate_command->footer(generator_help);

  auto* chart_command = app.add_subcommand("chart", "Chart time against error of every method on this data and view");
  ChartWords chart_words;
  add_chart_options(*chart_command, words, chart_words);

  auto* timing_command = app.add_subcommand("timing", "Say where the time of traced runs went");
  std::vector<std::string> traces;
  std::string csv, figure;
  timing_command->add_option("TRACE", traces, "what render --timing wrote; several are compared")->required();
  timing_command->add_option("--csv", csv, "the same figures as a table")->type_name("FILE");
  timing_command->add_option("--figure", figure, "stacked bars, .svg or .png")->type_name("FILE");

  auto* formats_command =
      app.add_subcommand("formats", "List the formats of files that are read, and known ones that are not");
  formats_command->add_flag("--json", as_json, "for machines");

  // CLI11 would only say that a subcommand is missing.
  if (argc > 1 && argv[1][0] != '-' &&
      app.get_subcommands([&](const CLI::App* command) { return command->get_name() == argv[1]; }).empty())
    throw bad_input(fmt::format(
        "arguments: '{}' is no command; use render, info, convert, generate, chart, timing or formats", argv[1]));
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {  // --help, --version
    std::ostringstream unheard;
    app.exit(asked, job.rank() == 0 ? std::cout : unheard, job.rank() == 0 ? std::cerr : unheard);
    return ExitCode::complete;
  } catch (const CLI::ParseError& error) {
    std::string help = "tessera --help";
    for (const CLI::App* command : app.get_subcommands({}))
      if (argc > 1 && command->get_name() == argv[1]) help = fmt::format("tessera {} --help", argv[1]);
    throw bad_input(fmt::format("arguments: {}; see {}", error.what(), help));
  }

  if (words.input == standard_stream) {
    if (job.size() > 1) throw bad_input("standard input: only one process has it; give a file that all can open");
    words.input = spool_standard_input().string();
  }
  if (*render_command) {
    const RenderOptions options = render_options(words);
    if (const auto stalls = stall_settings(stall_words, words.quiet)) job.watch_stalls(*stalls);
    if (options.is_grid()) refuse_mesh_options(words, options);
    return render(options, job);
  }
  if (job.rank() != 0) return ExitCode::complete;  // the other commands are for one process
  if (*info_command) {
    const bool is_grid = is_grid_input(words);
    if (check && is_grid) {
      require_input(words.input);
      throw bad_input("--check: is for meshes, and the input is a volume; leave it out");
    }
    info(words.input, is_grid ? volume_options(words) : mesh_options(words), as_json, check);
  }
  if (*convert_command) require_input(words.input);
  if (*convert_command && is_grid_input(words) && !to_mesh(words.input, mesh_output)) {
    ReadOptions options = volume_options(words);
    const std::string side = options.blocks.empty() ? "64" : options.blocks.back();
    options.blocks.clear();
    convert_grid(words.input, mesh_output, options, parse_count("--block", side, 8, 1024), words.quiet);
  } else if (*convert_command) {
    convert_mesh(words.input, mesh_output, mesh_options(words), parse_count("--subdivide", subdivide, 0, 8),
                 convert_pieces(pieces, pieces_partition), words.quiet);
  }
  if (*chart_command) chart(words, chart_words);
  if (*formats_command) formats(as_json);
  if (*timing_command) timing({traces.begin(), traces.end()}, csv, figure);
  if (*generate_command) generate(kind, mesh_output, parameters, words.quiet);
  return ExitCode::complete;
}

}  // namespace
}  // namespace tessera::apps

namespace {

using tessera::Error;
using tessera::ErrorCode;
using tessera::apps::ExitCode;

/// What any exception is to the user.
Error as_error() {
  try {
    throw;
  } catch (const tessera::OutputFault& fault) {
    return fault.since_changed();  // every command has looked at its outputs before it began
  } catch (...) {
    return tessera::error_of(std::current_exception());
  }
}

/// An exception that nobody caught: on a thread of oneTBB's, say, which cannot start another.
[[noreturn]] void on_terminate() {
  static std::atomic<bool> again = false;
  if (std::current_exception() == nullptr || again.exchange(true)) std::abort();
  const Error error = as_error();
  tessera::apps::fail(error);
  std::_Exit(static_cast<int>(error.code()));
}

}  // namespace

int main(int argc, char** argv) {
  using tessera::apps::fail;
  std::set_terminate(on_terminate);
  std::optional<tessera::Job> job;
  try {
    constexpr auto remedy = "finished pictures stay, and the same command with --resume goes on from there";
    job.emplace(tessera::JobVoice{"tessera", remedy, [](const Error& error) { fail(error); }});
  } catch (...) {
    return fail(as_error());
  }
  ExitCode code = ExitCode::complete;
  try {
    code = tessera::apps::run(argc, argv, *job);
    // A result that did not reach its reader (a full disk behind `>`) is not a success.
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
      throw Error(ErrorCode::system_failure, "standard output: cannot be written; make room or close the pipe later");
  } catch (...) {
    job->fail(as_error());
  }
  if (const std::optional<Error> error = job->finish()) return static_cast<int>(error->code());
  return static_cast<int>(code);
}
