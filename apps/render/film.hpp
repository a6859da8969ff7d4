// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "apps/exit_code.hpp"
#include "tessera/job.hpp"
#include "tessera/program/render_options.hpp"

namespace tessera::apps {

/// `tessera render`, of a mesh or a grid: plan the frames, check all outputs, read, render, write, verify, report; on
/// all ranks of the job, or in this process if it is the only one. The rank that assembles the pictures writes
/// and speaks. Collective.
///
/// complete, or accuracy_not_met where --verify found more error than promised (the pictures are written then too).
/// Throws Error.
ExitCode render(const RenderOptions& options, Job& job);

}  // namespace tessera::apps
