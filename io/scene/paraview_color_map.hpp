// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "io/scene/transfer_function_file.hpp"

namespace tessera::io {

/// ParaView's colour-map JSON: an object, or a list whose first object is taken.
///
/// `RGBPoints` [x r g b ...] is sRGB, interpolated in `ColorSpace` (RGB, HSV, Lab, CIELAB, Diverging, Step;
/// LabCIEDE2000 as Lab, which the name then says) and decoded. `Points` [x opacity midpoint sharpness ...] is opacity
/// per unit distance, with vtkPiecewiseFunction's reading of midpoint and sharpness; without it the default ramp is
/// taken, which the name says. `ScalarOpacityUnitDistance`, if there, is the unit distance. `HSVWrap` 1 lets hue go
/// through 0.
/// Values are the field's own; with `rescale`, colours and opacities are each stretched over the field's range, which
/// the name says. Two points at one x are a step. NaN's colour, annotations and other keys are passed over. Maps of
/// `IndexedColors` alone (categories) are refused. Throws Error(bad_input) in one line.
colormaps::LoadedTransferFunction parse_paraview_color_map(std::string_view text, const std::string& source,
                                                           const colormaps::TransferFunctionOptions& options);

/// The same of JSON that is parsed.
colormaps::LoadedTransferFunction color_map_of(const nlohmann::json& root, const std::string& source,
                                               const colormaps::TransferFunctionOptions& options);

}  // namespace tessera::io
