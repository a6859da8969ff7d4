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

/// Field and colours for the images of a time series, if options do not specify them.
///
/// The first, the middle and the last of the selected steps are examined and, only if nothing varies in these steps,
/// also the two steps midway between them: at most five steps for any length of the series. The field is chosen as for
/// a file in which each array has the values of the step where its range is widest. Colours and opacities are those of
/// the step in which this field has the widest range. If the range of all examined steps extends beyond this range by
/// more than a tenth of its width, colours and opacities cover the range of all examined steps.
struct SeriesChoice {
  std::string field;                               ///< as in ReadOptions::field; empty: each step has its own choice
  std::vector<std::size_t> steps;                  ///< the examined steps, ascending
  std::array<double, 2> range{};                   ///< range of the field's values in the examined steps
  std::optional<LoadedTransferFunction> function;  ///< none if a file specifies the function
};

/// Opens a step. Returns null if the step cannot be read; the error is reported when the step is shown. Never returns
/// null for the first step.
using OpenStep = std::function<const Dataset*(std::size_t step, const ReadOptions& read)>;

/// Whether the transfer function is given by a file or JSON text with values that are not stretched.
bool function_has_values(const RenderOptions& options);

/// Whether the options do not specify the field or the colours of several steps.
bool depends_on_steps(std::size_t steps, const RenderOptions& options);

/// The steps to examine, ascending.
std::vector<std::size_t> steps_to_examine(std::size_t steps);

/// Chooses field and colours. `steps` are the existing steps among those of steps_to_examine(). They must include the
/// first, which is opened last, with the chosen field. The result is the same on all ranks; `open` is called
/// collectively.
SeriesChoice choose_by_steps(std::vector<std::size_t> steps, const RenderOptions& options, const ReadOptions& read,
                             const OpenStep& open);

/// Returns a note like "field p and its colours are chosen by time steps 0, 2 and 4 of 0 to 4, where it is from 0 to
/// 3".
std::string series_note(const SeriesChoice& choice, std::size_t steps, const std::string& field);

}  // namespace tessera::apps
