// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/camera.hpp"
#include "tessera/camera_file.hpp"

namespace tessera::io {

using tessera::CameraFile;

/// tessera::read_cameras(): the format is seen from the first character: `{` or `[` is JSON, `<` ParaView's .pvcc,
/// anything else plain text. Words: `position x y z`, `focal_point x y z`, either `parallel_scale s` or `view_angle
/// degrees`; and, if wanted, `view_up x y z` (0 1 0 without it, as in VTK), `clipping_range near far`, `size W H`.
/// Throws Error(bad_input) in one line naming file and line for unknown, repeated or missing words and for what
/// scene::validate refuses.
std::vector<CameraFile> read_cameras(const std::filesystem::path& file);

/// tessera::write_camera().
void write_camera(const CameraFile& camera, const std::filesystem::path& file);

/// The three formats by themselves; `source` is the name in messages. JSON may be one object or a list.
std::vector<CameraFile> parse_json_cameras(std::string_view text, const std::string& source);
CameraFile parse_text_camera(std::string_view text, const std::string& source);
/// ParaView's PVCameraConfiguration: CameraPosition, CameraFocalPoint, CameraViewUp, CameraParallelProjection (absent:
/// perspective), and CameraParallelScale or CameraViewAngle by that. Other properties (CenterOfRotation, ...) do not
/// change the picture and are passed over.
CameraFile parse_pvcc_camera(std::string_view text, const std::string& source);
/// Any of the three, told apart as read_cameras does.
std::vector<CameraFile> parse_cameras(std::string_view text, const std::string& source);

/// The JSON text that write_camera writes.
std::string camera_json(const CameraFile& camera);

}  // namespace tessera::io
