// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tessera::apps {

/// Implements `tessera generate KIND OUT [NAME=VALUE ...]`: writes a mesh of datasets/ as .tets or .vtu. Prints one
/// line on stderr unless `quiet`. Throws Error, which lists the known kinds or parameters, for an unknown one.
void generate(const std::string& kind, const std::filesystem::path& output, const std::vector<std::string>& parameters,
              bool quiet);

/// Several lines for the help: the kinds with their parameters and defaults.
std::string generator_help();

/// Names of all kinds.
std::vector<std::string> generator_names();

}  // namespace tessera::apps
