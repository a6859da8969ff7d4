// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "scene/transfer_function.hpp"

namespace tessera::colormaps {

/// Options for converting the numbers of a file or a preset to extinction [1 / world unit] and linear colour.
struct TransferFunctionOptions {
  /// Smallest and largest value of the field. Presets cover this range; files cover it with `rescale`. If low == high,
  /// the field is constant.
  std::array<double, 2> field_range{0, 1};
  /// `--unit-distance`: the length, in world units, for which the opacities of a file are given. Overrides the length
  /// that the file states.
  std::optional<double> unit_distance{};
  /// Unit distance if neither the file nor the user specifies one; the caller derives it from the mesh and prints it.
  /// It should be a tenth of the mesh's mean thickness: the ramp of presets.hpp then makes an average ray along the
  /// mesh's short axis 0.26 to 0.89 opaque.
  double default_unit_distance = 1;
  /// `--blend display`: colours remain display values, not decoded from sRGB, which is how VTK composites them.
  bool display_colors = false;
  double opacity_scale = 1;  ///< multiplies extinction, >= 0
  /// `--rescale`: maps a file's values to the field's range, like ParaView's "rescale to data range". Without it the
  /// values are used unchanged, whatever the field's range.
  bool rescale = false;
  /// `--range`: the range that presets, the default function and files cover instead of the field's range; files are
  /// mapped to it.
  std::optional<std::array<double, 2>> range{};
  /// `--opacity-points`: pairs of a fraction of the range and an opacity per unit distance, ascending. They replace the
  /// opacities of a preset or a colour map.
  std::vector<std::array<double, 2>> opacity_points{};
  /// Applies to files whose values are from 0 to 1 or from -1 to 1, like those of ParaView's presets. Such a file is
  /// mapped to the field's range as with `rescale` if the field is almost entirely outside of the file's range or fills
  /// only a hundredth of it.
  bool rescale_presets = false;

  [[nodiscard]] std::array<double, 2> spanned() const { return range.value_or(field_range); }
};

using tessera::LoadedTransferFunction;

struct OpacityPoint;
/// Returns opacity_points mapped to [low, high]; opacity is constant beyond the first and last point.
std::vector<OpacityPoint> points_over(const std::vector<std::array<double, 2>>& points, double low, double high);

/// Whether a function that covers the range `function` shows almost nothing of a field with the range `field`: less
/// than a hundredth of the field's range is within the function's range and the rest is on one side of it, or the field
/// fills less than a hundredth of the function's range.
bool is_far_off(const std::array<double, 2>& function, const std::array<double, 2>& field);

/// Throws Error(bad_input) naming the option if a range, distance or scale is not what its documentation requires.
void check(const TransferFunctionOptions& options);

/// Calls the constructor of scene::TransferFunction; its error messages are prefixed with the name of the file.
scene::TransferFunction make_transfer_function(std::vector<scene::Knot> knots, const std::string& source);

}  // namespace tessera::colormaps
