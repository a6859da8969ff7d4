// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tessera/program/render_options.hpp"

namespace tessera::apps {

/// What the pictures of a time series go by where no option says it.
///
/// Looked at are the first, the middle and the last of the steps that are shown and, only if nothing varies in these,
/// the two half-way between: at most five, whatever the series' length. The field is the one that would be chosen of a
/// file whose every array is that of the step where it spans most. Colours and opacities are those of the step where
/// this field spans most, over the values of all that were looked at where these reach more than a tenth further.
struct SeriesChoice {
  std::string field;                               ///< as ReadOptions has it; empty: each step's own choice
  std::vector<std::size_t> steps;                  ///< that were looked at, ascending
  std::array<double, 2> range{};                   ///< of the field's values in these
  std::optional<LoadedTransferFunction> function;  ///< none where a file says it
};

/// Opens a step; null if it cannot be read, which is said when it is shown. Never null for the first.
using OpenStep = std::function<const Dataset*(std::size_t step, const ReadOptions& read)>;

/// Whether the transfer function is of a file, or its text, with values that are not stretched.
bool function_has_values(const RenderOptions& options);

/// Whether field or colours of so many steps are not said by the options.
bool goes_by_steps(std::size_t steps, const RenderOptions& options);

/// The steps that may be looked at, ascending.
std::vector<std::size_t> steps_to_look_at(std::size_t steps);

/// `steps` are those of steps_to_look_at() that are there, the first among them, which is the last that is opened, with
/// the field chosen. The same on all ranks, where `open` is collective.
SeriesChoice choose_by_steps(std::vector<std::size_t> steps, const RenderOptions& options, const ReadOptions& read,
                             const OpenStep& open);

/// "field p and its colours go by time steps 0, 2 and 4 of 5, where it is from 0 to 3".
std::string series_note(const SeriesChoice& choice, std::size_t steps, const std::string& field);

}  // namespace tessera::apps
