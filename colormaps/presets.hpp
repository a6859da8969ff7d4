// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "colormaps/function_options.hpp"
#include "colormaps/transfer_curves.hpp"

namespace tessera::colormaps {

/// Named presets, `COLOURS` or `COLOURS:OPACITY`, over the field's range. preset_names() lists the colours. Opacities
/// are given as fractions of the range and opacity per unit distance (a constant field gets the colour of the middle
/// and 0.1):
///   ramp     0.03 at the low end to 0.2 at the high end: everything is visible, high values most (the default)
///   inverse  like ramp, but from high to low
///   ends     0.2 at both ends, 0.005 in the middle: for signed fields and their extremes
///   peaks    five thin shells on a clear ground, like nested level sets
///   rise     clear up to 10 % of the range, then 0.15 in the middle and 0.6 at the high end (volumes' default)
///   surface  clear below 45 % of the range, 0.9 above 55 %: nearly a surface at the middle value
///   flat     0.1 everywhere
/// is_preset() returns whether `name` is a preset, with any variant, even one that does not exist: preset() refuses
/// `viridis:peak` with a list of the variants.
bool is_preset(std::string_view name);

/// Returns a preset. Throws Error(bad_input) for an unknown variant.
LoadedTransferFunction preset(std::string_view name, const TransferFunctionOptions& options);

/// Returns the default preset: cool-warm with a gentle ramp of opacity that is nowhere zero, so that every field, even
/// a constant one, gives an image that is neither black nor saturated.
LoadedTransferFunction default_transfer_function(const TransferFunctionOptions& options);

/// The names of all colours, the default first.
std::vector<std::string> preset_names();
/// The names of all opacities.
std::vector<std::string> preset_opacity_names();

/// The opacities of `ramp`, over [0, 1], which are also used for a colour map without opacities.
std::vector<OpacityPoint> opacity_ramp();

}  // namespace tessera::colormaps
