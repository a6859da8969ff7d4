// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "server/scene_reader.hpp"
#include "tessera/job.hpp"
#include "tessera/program/options.hpp"

namespace tessera::apps {

/// What `tessera serve`, called with these words, has in common with `tessera render`: the same values and checks for
/// states of clients, so that a state's picture is that of its command line. Reads some steps of a time series, by all
/// ranks.
std::unique_ptr<server::SceneReader> scene_reader(const OptionWords& words, Job& job);

}  // namespace tessera::apps
