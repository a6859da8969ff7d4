// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "io/scene/transfer_function_file.hpp"

namespace tessera::io {

/// ParaView's colour-map JSON: an object, or the first object of a list.
///
/// `RGBPoints` [x r g b ...] is sRGB, interpolated in `ColorSpace` (RGB, HSV, Lab, CIELAB, Diverging, Step;
/// LabCIEDE2000 is treated as Lab, and the name mentions it) and decoded. `Points` [x opacity midpoint sharpness ...]
/// is opacity per unit distance, with vtkPiecewiseFunction's interpretation of midpoint and sharpness; without `Points`
/// the default ramp is used, and the name mentions it. `ScalarOpacityUnitDistance`, if present, is the unit distance.
/// `HSVWrap` 1 lets hue wrap through 0.
/// Values are those of the field; with `rescale`, colours and opacities are each stretched over the field's range, and
/// the name mentions it. Two points at one x form a step. NaN's colour, annotations and other keys are ignored. Maps
/// that contain only `IndexedColors` (categories) are refused. Throws Error(bad_input) in one line.
colormaps::LoadedTransferFunction parse_paraview_color_map(std::string_view text, const std::string& source,
                                                           const colormaps::TransferFunctionOptions& options);

/// Like parse_paraview_color_map(), for JSON that is already parsed.
colormaps::LoadedTransferFunction color_map_of(const nlohmann::json& root, const std::string& source,
                                               const colormaps::TransferFunctionOptions& options);

}  // namespace tessera::io
