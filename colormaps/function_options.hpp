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
};

/// A preset's or a file's function over a field, and where its numbers came from.
struct LoadedTransferFunction {
  scene::TransferFunction function;
  std::string name;                       ///< the preset's or the file's, with what was assumed in brackets
  std::optional<double> unit_distance{};  ///< that was used; none where the file gives extinctions
  /// "file", "`unit_distance`", "default", or "" where extinctions are absolute.
  std::string unit_distance_source;
};

/// Throws Error(bad_input) naming the option if a range, distance or scale is not what its comment says.
void check(const TransferFunctionOptions& options);

/// scene::TransferFunction's constructor with the file's name before its message.
scene::TransferFunction make_transfer_function(std::vector<scene::Knot> knots, const std::string& source);

}  // namespace tessera::colormaps
