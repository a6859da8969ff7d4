// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scene/error.hpp"

namespace tessera::scene {

/// The time step of a file that was read.
struct TimeStepRead {
  std::uint64_t count = 1;      ///< number of steps in the file; 0 or 1 if the data do not change with time
  std::uint64_t step = 0;       ///< the step that was read, counted from 0
  std::vector<double> times{};  ///< times of all `count` steps if the file states them; otherwise empty
};

/// Returns the requested one of `count` steps or, without a request, the last step. Throws Error(bad_input) if the
/// requested step does not exist.
inline TimeStepRead chosen_step(std::optional<std::size_t> requested, std::uint64_t count, const std::string& source) {
  if (requested && *requested >= std::max<std::uint64_t>(count, 1))
    throw bad_input(
        fmt::format("{}: there is no time step {}, the file has {}; count from 0", source, *requested, count));
  return {count, requested.value_or(count == 0 ? 0 : count - 1), {}};
}

/// Sets the times, but only if there is one for each step and all are finite.
inline void set_times(TimeStepRead& read, std::vector<double> times) {
  if (times.size() == read.count && std::ranges::all_of(times, [](double t) { return std::isfinite(t); }))
    read.times = std::move(times);
}

/// Returns `count` times, beginning with `first`, at intervals of `step`. Returns none if the times are not finite and
/// different from each other, or if there are more of them than an intact file would contain.
inline std::vector<double> even_times(double first, double step, std::uint64_t count) {
  constexpr std::uint64_t most = 1 << 20;
  std::vector<double> times;
  if (count < 2 || count > most || !std::isfinite(first) || !std::isfinite(step) || step == 0) return times;
  for (std::uint64_t k = 0; k < count; ++k) times.push_back(first + step * static_cast<double>(k));
  return times;
}

/// Returns the note about the time step, which the user has requested or not; none if there is only one step.
inline std::optional<std::string> note_on(const TimeStepRead& read, bool is_requested) {
  if (read.count <= 1) return std::nullopt;
  const std::string time =
      read.step < read.times.size() ? fmt::format(", time {:.6g}", read.times[read.step]) : std::string();
  return fmt::format(
      "time step {} of 0 to {}{}{}", read.step, read.count - 1, time,
      is_requested ? "" : ", which is the last and the default; `time_step` all shows all steps as a film");
}

}  // namespace tessera::scene
