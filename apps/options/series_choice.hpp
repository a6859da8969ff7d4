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

/// Field and colours for the images of a time series that options do not state.
///
/// Examines the first, the middle and the last of the selected steps and, only if nothing varies in these, the two
/// midway between: at most five, whatever the length of the series. The field is chosen as for a file whose arrays each
/// have the values of the step with the widest range. Colours and opacities are those of the step in which this field
/// has the widest range, or over the range of all examined steps if that is more than a tenth wider.
struct SeriesChoice {
  std::string field;                               ///< in the form of ReadOptions; empty: each step's own choice
  std::vector<std::size_t> steps;                  ///< examined, ascending
  std::array<double, 2> range{};                   ///< of the field's values in these steps
  std::optional<LoadedTransferFunction> function;  ///< none if a file specifies it
};

/// Opens a step; null if it cannot be read, which is reported when it is shown. Never null for the first.
using OpenStep = std::function<const Dataset*(std::size_t step, const ReadOptions& read)>;

/// Whether the transfer function is a file, or its text, with values that are not stretched.
bool function_has_values(const RenderOptions& options);

/// Whether the options leave the field or the colours of several steps open.
bool depends_on_steps(std::size_t steps, const RenderOptions& options);

/// The steps to examine, ascending.
std::vector<std::size_t> steps_to_examine(std::size_t steps);

/// `steps` are the existing ones of steps_to_examine(). They must include the first, which is opened last, with the
/// chosen field. The result is the same on all ranks, where `open` is collective.
SeriesChoice choose_by_steps(std::vector<std::size_t> steps, const RenderOptions& options, const ReadOptions& read,
                             const OpenStep& open);

/// "field p and its colours are chosen by time steps 0, 2 and 4 of 5, where it is from 0 to 3".
std::string series_note(const SeriesChoice& choice, std::size_t steps, const std::string& field);

}  // namespace tessera::apps
