// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "server/scene_reader.hpp"
#include "tessera/job.hpp"
#include "tessera/program/options.hpp"

namespace tessera::apps {

/// The part of `tessera serve` that it shares with `tessera render`: states of clients get the same values and checks,
/// so that a state's image is that of its command line. Reads some steps of a time series, with all ranks.
std::unique_ptr<server::SceneReader> scene_reader(const OptionWords& words, Job& job);

}  // namespace tessera::apps
