// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "apps/options/cli_fwd.hpp"
#include "tessera/program/film.hpp"

namespace tessera::apps {

/// The option that says which time steps are shown.
void add_time_options(CLI::App& command, std::string& time_step);

/// One step of a file, counted from 0. Nothing if no word is given, or those of a film. Throws Error(bad_input).
std::optional<std::size_t> one_time_step(const std::string& word);

/// Of commands that take but one: throws Error(bad_input) for the words of a film.
void refuse_time_steps(const std::string& word);

/// `all`, or FIRST:LAST, or FIRST:LAST:STRIDE; nothing for other words, which one_time_step() takes. Throws
/// Error(bad_input).
std::optional<StepRange> time_steps(const std::string& word);

}  // namespace tessera::apps
