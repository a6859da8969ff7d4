// SPDX-License-Identifier: BSD-3-Clause
#include "apps/commands/generate_command.hpp"

#include <fmt/format.h>

#include <map>

#include "apps/render/progress.hpp"
#include "apps/stderr_lines.hpp"
#include "datasets/arrays.hpp"
#include "datasets/generate.hpp"
#include "datasets/volumes.hpp"
#include "tessera/error.hpp"
#include "tessera/program/options.hpp"
#include "tessera/program/output_file.hpp"
#include "tessera/write.hpp"

namespace tessera::apps {
namespace {

std::string parameter_help(const std::vector<datasets::GeneratorParameter>& parameters) {
  std::string text;
  for (const auto& parameter : parameters)
    text += fmt::format("      {}={:g}  {}\n", parameter.name, parameter.default_value, parameter.help);
  return text;
}

}  // namespace

std::string generator_help() {
  std::string text = "Kinds, with their parameters and defaults:\n";
  for (const auto& generator : datasets::generators())
    text += fmt::format("  {}: {}\n{}", generator.name, generator.help, parameter_help(generator.parameters));
  for (const auto& generator : datasets::volume_generators())
    text += fmt::format("  {}: {}\n{}", generator.name, generator.help, parameter_help(generator.parameters));
  return text + "Parameters of every mesh:\n" + parameter_help(datasets::common_parameters());
}

std::vector<std::string> generator_names() {
  std::vector<std::string> names;
  for (const auto& generator : datasets::generators()) names.emplace_back(generator.name);
  for (const auto& generator : datasets::volume_generators()) names.emplace_back(generator.name);
  return names;
}

void generate(const std::string& kind, const std::filesystem::path& output, const std::vector<std::string>& parameters,
              bool quiet) {
  std::map<std::string, double> values;
  for (const auto& parameter : parameters) {
    const auto equals = parameter.find('=');
    if (equals == std::string::npos || equals == 0)
      throw bad_input(fmt::format("generate: '{}' is not a parameter; write NAME=VALUE", parameter));
    const auto name = parameter.substr(0, equals);
    if (!values.emplace(name, parse_number(name, parameter.substr(equals + 1))).second)
      throw bad_input(fmt::format("generate: {} is given twice; give it once", name));
  }
  StatusLine line(shows_progress(quiet));
  line.begin("generating " + output.filename().string());
  if (is_grid_output(output)) {
    check_output(output, {});
    const auto volume = datasets::generate_volume(kind, values);
    line.begin("writing " + output.filename().string());
    write_grid(*volume, output);
    line.begin("");
    const auto& points = volume->geometry().points;
    if (!quiet)
      print_lines(fmt::format("{}: {} of {}x{}x{} {} samples", output.string(), kind, points[0], points[1], points[2],
                              name_of(volume->grid().type)));
    return;
  }
  check_mesh_output(output, nullptr);
  const MeshArrays mesh = datasets::arrays_of(datasets::generate(kind, values));
  line.begin("writing " + output.filename().string());
  write_mesh(mesh, output);
  line.begin("");
  if (!quiet)
    print_lines(fmt::format("{}: {} with {} tets, {} points, field {}", output.string(), kind, mesh.tets.size() / 4,
                            mesh.points.size() / 3, mesh.field_name));
}

}  // namespace tessera::apps
