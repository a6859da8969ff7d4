// SPDX-License-Identifier: BSD-3-Clause
#include "apps/command_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "apps/commands/generate_command.hpp"
#include "apps/help/help_pages.hpp"
#include "apps/options/like_report.hpp"
#include "apps/options/method_preset.hpp"
#include "apps/options/scene_file.hpp"
#include "tessera/version.hpp"

namespace tessera::apps {

CommandLine::CommandLine()
    : app("Tessera renders scientific volumes: unstructured meshes and regular grids, exactly, on the CPU.",
          "tessera") {
  app.set_version_flag("--version",
                       fmt::format("tessera {}\ncommit {}\nbuilt by {}", version(), commit(), build_facts()),
                       "print the version, the commit and how it was built, and end");
  app.set_help_flag("-h,--help", "say how it is called and end");
  app.require_subcommand(1);
  app.formatter(std::make_shared<HelpPages>());

  render = app.add_subcommand("render", "Render a mesh or a volume to pictures");
  render->set_help_all_flag("--help-all", "say every option and end");
  add_render_options(*render, words);
  add_like_option(*render, words);
  add_method_preset_option(*render, words);
  add_stall_options(*render, stalls);
  add_scene_options(*render, words);

  serve = app.add_subcommand("serve", "Show a mesh or a volume in a browser, as it is turned and changed");
  add_serve_options(*serve, words, serve_words);
  add_stall_options(*serve, stalls);

  info = app.add_subcommand("info", "Say what a mesh or volume holds and how it would be rendered");
  add_mesh_options(*info, words);
  info->add_flag("--json", as_json, "for machines");
  info->add_flag("--check", check, "meshes: overlapping cells, folds, unmatched faces, slivers, duplicates");

  convert = app.add_subcommand("convert", "Write a mesh as tetrahedra, or a volume, with one scalar");
  declare_convert();
  generate = app.add_subcommand("generate", "Make a mesh or a volume");
  declare_generate();
  chart = app.add_subcommand("chart", "Chart time against error of every method on this data and view");
  add_chart_options(*chart, words, chart_words);
  timing = app.add_subcommand("timing", "Say where the time of traced runs went");
  declare_timing();
  formats = app.add_subcommand("formats", "List the formats of files that are read, and known ones that are not");
  formats->add_flag("--json", as_json, "for machines");
  presets = app.add_subcommand("presets", "List the colour presets of --transfer-function, or draw them");
  presets->add_option("-o,--output", picture, "draw them into this picture: .png .exr .jpg .tif")->type_name("FILE");
  help = app.add_subcommand("help", "Say how a command is called");
  declare_help();
  completion = app.add_subcommand("completion", "Print the script by which a shell completes words of tessera");
  completion->add_option("SHELL", shell, "bash, zsh or fish")->required();
}

void CommandLine::declare_convert() {
  add_mesh_options(*convert, words);
  convert
      ->add_option("OUT", mesh_output,
                   "of a mesh .vtu, .tets, or .pvtu with --pieces; of a volume .vti .vtr .nrrd .raw .bricks")
      ->required();
  convert->add_option("--pieces", pieces, "write OUT.pvtu and so many pieces, for mpirun")->type_name("N");
  convert
      ->add_option("--partition", pieces_partition,
                   "which piece a cell goes to: curve (compact, the default), file (order kept), random")
      ->type_name("curve|file|random");
  convert->add_option("--subdivide", subdivide, "of a mesh: times every tetrahedron is cut into eight")
      ->type_name("TIMES");
  convert->get_option("--block")->description(
      "of a mesh in blocks: write this one alone; may be repeated; of .bricks: samples a side of a block (default 64)");
  convert->add_flag("--quiet", words.quiet, "nothing on stderr but errors");
}

void CommandLine::declare_generate() {
  generate->add_option("KIND", kind, "what to make, see below")->required();
  generate->add_option("OUT", mesh_output, "of a mesh .vtu or .tets; of a volume .vti .nrrd .raw .bricks")->required();
  generate->add_option("PARAMETERS", parameters, "NAME=VALUE ...");
  generate->add_flag("--quiet", words.quiet, "nothing on stderr but errors");
  generate->footer(generator_help);
}

void CommandLine::declare_timing() {
  timing->add_option("TRACE", traces, "what render --timing wrote; several are compared")->required();
  timing->add_option("--csv", csv, "the same figures as a table")->type_name("FILE");
  timing->add_option("--figure", figure, "stacked bars, .svg or .png")->type_name("FILE");
}

void CommandLine::declare_help() {
  help->add_option("COMMAND", help_of, "one of the commands; without it what there is");
  help->add_flag("--all", help_all, "every option");
  help->add_flag("--man", manual, "as a manual page (roff)")->group("");
}

CLI::App* CommandLine::command(const std::string& name) const {
  for (CLI::App* command : commands())
    if (command->get_name() == name) return command;
  return nullptr;
}

std::vector<CLI::App*> CommandLine::commands() const {
  return {render, serve, info, convert, generate, chart, timing, formats, presets, help, completion};
}

}  // namespace tessera::apps
