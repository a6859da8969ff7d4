#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "tessera/surfaces.hpp"

namespace tessera::apps {

/// The options that put surfaces into the volume, as they stand on the command line.
struct SurfaceWords {
  std::vector<std::string> iso;
};

void add_surface_options(CLI::App& command, SurfaceWords& words);

/// What they say. Throws Error(bad_input) naming the option.
Surfaces surfaces_of(const SurfaceWords& words);

}  // namespace tessera::apps
