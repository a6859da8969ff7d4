// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "apps/exit_code.hpp"
#include "tessera/job.hpp"
#include "tessera/program/render_options.hpp"

namespace tessera::apps {

/// Implements `tessera render` for a mesh or a grid: plans the frames, checks all outputs, then reads, renders, writes,
/// verifies and reports, on all ranks of the job. The rank that assembles the images writes files and messages.
/// Collective.
///
/// Returns complete, or accuracy_not_met if --verify found a larger error than promised (the images are still written).
/// Throws Error.
ExitCode render(const RenderOptions& options, Job& job);

}  // namespace tessera::apps
