// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "apps/options/cli_fwd.hpp"
#include "apps/options/render_options.hpp"

/// `render --like FILE`: another run's views, size, field and transfer function, as its report (--report) has them, so
/// that two pictures can be compared: the same value has the same colour and the same extinction in both, whatever data
/// they show. Options given on the command line take precedence.
namespace tessera::apps {

/// Declares --like.
void add_like_option(CLI::App& render, RenderWords& words);

/// Sets what the report says and `render`, parsed, was not given. Throws Error(bad_input) unless the file is a report
/// of a run that rendered a frame.
void apply_like(const CLI::App& render, RenderWords& words);

}  // namespace tessera::apps
