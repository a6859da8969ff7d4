// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "scene/transfer_function.hpp"

namespace tessera::colormaps {

/// How a file's or a preset's numbers become extinction [1 / world unit] and linear colour.
struct TransferFunctionOptions {
  /// The field's smallest and largest value: presets span it, and files with `rescale`. low == high is a constant
  /// field.
  std::array<double, 2> field_range{0, 1};
  /// `--unit-distance`: the length, in world units, over which a file's opacity holds. Wins over the file's own.
  std::optional<double> unit_distance{};
  /// Used where neither the file nor the user names one; the caller derives it from the mesh and prints it.
  /// Meant to be a tenth of the mesh's mean thickness: the ramp of presets.hpp then makes an average ray the short way
  /// through it 0.26 to 0.89 opaque.
  double default_unit_distance = 1;
  /// `--blend display`: colours stay as the file shows them, undecoded from sRGB, as VTK composites them.
  bool display_colors = false;
  double opacity_scale = 1;  ///< multiplies extinction, >= 0
  /// `--rescale`: stretch a file's values over the field's range, as ParaView's "rescale to data range" does. Without
  /// it they are the field's own values, whatever they span.
  bool rescale = false;
  /// `--range`: presets, the default and files (which it stretches) span this instead of the field's range.
  std::optional<std::array<double, 2>> range{};
  /// `--opacity-points`: fractions of the range and opacities per unit distance, ascending, instead of a preset's or a
  /// colour map's own.
  std::vector<std::array<double, 2>> opacity_points{};
  /// A file over 0 to 1 or -1 to 1, as ParaView's presets are, is stretched as by `rescale` where the field lies almost
  /// all outside or fills a hundredth of it.
  bool rescale_presets = false;

  [[nodiscard]] std::array<double, 2> spanned() const { return range.value_or(field_range); }
};

using tessera::LoadedTransferFunction;

struct OpacityPoint;
/// opacity_points over [low, high]; beyond the first and last their opacities go on.
std::vector<OpacityPoint> points_over(const std::vector<std::array<double, 2>>& points, double low, double high);

/// Whether a function over `function` tells next to nothing of a field over `field`: less than a hundredth of the
/// field's range lies within, all the rest on one side; or the field fills less than a hundredth of it.
bool is_far_off(const std::array<double, 2>& function, const std::array<double, 2>& field);

/// Throws Error(bad_input) naming the option if a range, distance or scale is not what its comment says.
void check(const TransferFunctionOptions& options);

/// scene::TransferFunction's constructor with the file's name before its message.
scene::TransferFunction make_transfer_function(std::vector<scene::Knot> knots, const std::string& source);

}  // namespace tessera::colormaps
