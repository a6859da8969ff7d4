// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "scene/tet_mesh.hpp"

/// The generators by name, for a command line.
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

/// All kinds, in the order of a help text.
std::vector<Generator> generators();

/// Parameters of every kind: they change the finished mesh (inverted, cell_data, subdivide, shuffle, scale, offset, in
/// that order).
std::vector<GeneratorParameter> common_parameters();

/// The values given, and defaults for the rest. Throws Error(bad_input) for a name that is not in `known`, listing
/// those.
std::map<std::string, double> with_defaults(const std::string& kind, const std::vector<GeneratorParameter>& known,
                                            const std::map<std::string, double>& given);

/// The mesh `kind` with the parameters given and defaults for the rest.
/// Throws Error(bad_input) for an unknown kind (lists the kinds), an unknown parameter (lists the kind's), a parameter
/// that must be an integer and is not, or a value out of its generator's range.
scene::TetMesh generate(const std::string& kind, const std::map<std::string, double>& parameters);

}  // namespace tessera::datasets
