// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "scene/tet_mesh.hpp"

/// Access to the generators by name, for a command line.
namespace tessera::datasets {

struct GeneratorParameter {
  std::string name;
  double default_value;
  std::string help;
};

struct Generator {
  std::string name, help;
  std::vector<GeneratorParameter> parameters;
};

/// Returns all kinds, in the order of a help text.
std::vector<Generator> generators();

/// Returns the parameters that every kind has. They change the finished mesh (inverted, cell_data, subdivide, shuffle,
/// scale, offset, in that order).
std::vector<GeneratorParameter> common_parameters();

/// Returns the values given, and defaults for the other parameters. Throws Error(bad_input) for a name that is not in
/// `known`, with a list of these.
std::map<std::string, double> with_defaults(const std::string& kind, const std::vector<GeneratorParameter>& known,
                                            const std::map<std::string, double>& given);

/// Returns the mesh `kind` with the parameters given and defaults for the others. Throws Error(bad_input) for an
/// unknown kind (listing the kinds), an unknown parameter (listing those of the kind), a number that must be an integer
/// and is not, or a value out of its generator's range.
scene::TetMesh generate(const std::string& kind, const std::map<std::string, double>& parameters);

}  // namespace tessera::datasets
