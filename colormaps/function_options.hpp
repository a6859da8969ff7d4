// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "scene/transfer_function.hpp"

namespace tessera::colormaps {

/// How the numbers of a file or a preset become extinction [1 / world unit] and linear colour.
struct TransferFunctionOptions {
  /// The field's smallest and largest value: presets cover it, and files with `rescale`. low == high is a constant
  /// field.
  std::array<double, 2> field_range{0, 1};
  /// `--unit-distance`: the length, in world units, for which a file's opacity is given. Overrides the file's own.
  std::optional<double> unit_distance{};
  /// Used if neither the file nor the user specifies one; the caller derives it from the mesh and prints it. Intended
  /// to be a tenth of the mesh's mean thickness: the ramp of presets.hpp then makes an average ray along its short axis
  /// 0.26 to 0.89 opaque.
  double default_unit_distance = 1;
  /// `--blend display`: colours remain display values, not decoded from sRGB, which is how VTK composites them.
  bool display_colors = false;
  double opacity_scale = 1;  ///< multiplies extinction, >= 0
  /// `--rescale`: map a file's values to the field's range, like ParaView's "rescale to data range". Without it they
  /// are the field's own values, whatever their range.
  bool rescale = false;
  /// `--range`: presets, the default and files (which are mapped to it) cover this range instead of the field's.
  std::optional<std::array<double, 2>> range{};
  /// `--opacity-points`: fractions of the range and opacities per unit distance, ascending, which replace those of a
  /// preset or a colour map.
  std::vector<std::array<double, 2>> opacity_points{};
  /// Maps a file over 0 to 1 or -1 to 1, like ParaView's presets, as with `rescale` if the field is almost entirely
  /// outside of it or fills a hundredth of it.
  bool rescale_presets = false;

  [[nodiscard]] std::array<double, 2> spanned() const { return range.value_or(field_range); }
};

using tessera::LoadedTransferFunction;

struct OpacityPoint;
/// opacity_points mapped to [low, high]; constant beyond the first and last.
std::vector<OpacityPoint> points_over(const std::vector<std::array<double, 2>>& points, double low, double high);

/// Whether a function over `function` shows almost nothing of a field over `field`: less than a hundredth of the
/// field's range is within, all the rest on one side; or the field fills less than a hundredth of it.
bool is_far_off(const std::array<double, 2>& function, const std::array<double, 2>& field);

/// Throws Error(bad_input) naming the option if a range, distance or scale violates its documentation.
void check(const TransferFunctionOptions& options);

/// scene::TransferFunction's constructor; its messages are prefixed with the file's name.
scene::TransferFunction make_transfer_function(std::vector<scene::Knot> knots, const std::string& source);

}  // namespace tessera::colormaps
