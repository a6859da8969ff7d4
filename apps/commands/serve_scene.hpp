// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "apps/options/cli_fwd.hpp"
#include "apps/options/render_options.hpp"
#include "apps/options/state_words.hpp"
#include "server/scene_reader.hpp"
#include "tessera/job.hpp"

namespace tessera::apps {

/// What `tessera serve` has in common with `tessera render`: options of the latter that a server takes, and the same
/// parser and checks for states of clients, so that a state's picture is that of its command line. Reads some steps of
/// a time series, by all ranks.
std::unique_ptr<server::SceneReader> scene_reader(const RenderWords& words, const CLI::App& serve, Job& job);

/// Declares the options of `render` that `serve` has too.
void add_scene_reader_options(CLI::App& serve, RenderWords& words);

}  // namespace tessera::apps
