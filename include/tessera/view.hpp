// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "tessera/camera.hpp"
#include "tessera/camera_file.hpp"
#include "tessera/export.hpp"

namespace tessera {
inline namespace v0_1 {

/// A camera and the size of its image.
struct View {
  Camera camera;
  ImageSize size;
  bool operator==(const View&) const = default;
};

/// Reads one view, or the list of views of a camera path; the list is never empty. JSON, ParaView's .pvcc or plain text
/// (docs/FORMATS.md). Throws Error(bad_input) in one line naming file and line.
TESSERA_EXPORT std::vector<CameraFile> read_cameras(const std::filesystem::path& file);

/// The same for a file's text. `name` replaces the file's name in messages.
TESSERA_EXPORT std::vector<CameraFile> parse_cameras(std::string_view text, const std::string& name);

/// Whether an argument is JSON text instead of a file's name: it begins with `{` or `[`. A file with such a name is
/// given as `./{...`.
TESSERA_EXPORT bool is_json_text(std::string_view file_or_json);
/// read_cameras() for a file, or parse_cameras() for JSON text, which messages call `camera`.
TESSERA_EXPORT std::vector<CameraFile> cameras_of(const std::string& file_or_json);

/// Writes one view as JSON, every double in the shortest form that reads back the same. The file appears by rename.
TESSERA_EXPORT void write_camera(const CameraFile& camera, const std::filesystem::path& file);
/// The text that write_camera writes.
TESSERA_EXPORT std::string camera_json(const CameraFile& camera);

}  // namespace v0_1
}  // namespace tessera
