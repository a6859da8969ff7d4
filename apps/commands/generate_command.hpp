// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tessera::apps {

/// `tessera generate KIND OUT [NAME=VALUE ...]`: writes a mesh of datasets/ as .tets or .vtu. Prints one line on stderr
/// unless `quiet`. Throws Error for an unknown kind or parameter, listing the known ones.
void generate(const std::string& kind, const std::filesystem::path& output, const std::vector<std::string>& parameters,
              bool quiet);

/// Kinds with their parameters and defaults, several lines, for the help.
std::string generator_help();

/// Names of all kinds.
std::vector<std::string> generator_names();

}  // namespace tessera::apps
