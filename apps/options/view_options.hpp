// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "apps/options/cli_fwd.hpp"
#include "tessera/default_view.hpp"

namespace tessera::apps {

/// The options of a view that no camera file gives, or that turns the file's, as they stand on the command line.
struct ViewWords {
  std::string view, up, azimuth, elevation, zoom;
  bool fit = false;
};

void add_view_options(CLI::App& command, ViewWords& words);

/// Throws Error(bad_input) naming the option; also for those that a camera file says already, if there is one.
ViewRequest view_request(const ViewWords& words, bool has_camera_file);

}  // namespace tessera::apps
