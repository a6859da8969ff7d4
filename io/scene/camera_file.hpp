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

/// Implements tessera::read_cameras(). The first character determines the format: `{` or `[` is JSON, `<` is ParaView's
/// .pvcc, any other is plain text. The words of plain text and JSON are `position x y z`, `focal_point x y z`, either
/// `parallel_scale s` or `view_angle degrees`, and optionally `view_up x y z` (default 0 1 0, as in VTK),
/// `clipping_range near far` and `size W H`. Throws Error(bad_input) with a message of one line that names file and
/// line for unknown, repeated or missing words and for values that scene::validate refuses.
std::vector<CameraFile> read_cameras(const std::filesystem::path& file);

/// Implements tessera::write_camera().
void write_camera(const CameraFile& camera, const std::filesystem::path& file);

/// The parsers of the three formats. Messages contain `source` as the name of the file. JSON may be one object or a
/// list of objects.
std::vector<CameraFile> parse_json_cameras(std::string_view text, const std::string& source);
CameraFile parse_text_camera(std::string_view text, const std::string& source);
/// ParaView's PVCameraConfiguration: CameraPosition, CameraFocalPoint, CameraViewUp, CameraParallelProjection (absent:
/// perspective), which selects CameraParallelScale or CameraViewAngle. Other properties (CenterOfRotation, ...) do not
/// affect the image and are skipped.
CameraFile parse_pvcc_camera(std::string_view text, const std::string& source);
/// Parses a text of any of the three formats, which is determined as in read_cameras().
std::vector<CameraFile> parse_cameras(std::string_view text, const std::string& source);

/// Returns the JSON text that write_camera() writes.
std::string camera_json(const CameraFile& camera);

}  // namespace tessera::io
