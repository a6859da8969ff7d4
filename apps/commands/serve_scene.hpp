// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "server/scene_reader.hpp"
#include "tessera/job.hpp"
#include "tessera/program/options.hpp"

namespace tessera::apps {

/// Makes the part of `tessera serve` that is shared with `tessera render`: states of clients are converted and checked
/// like command lines, so that a state gives the same image as its command line. Reads some steps of a time series, on
/// all ranks.
std::unique_ptr<server::SceneReader> scene_reader(const OptionWords& words, Job& job);

}  // namespace tessera::apps
