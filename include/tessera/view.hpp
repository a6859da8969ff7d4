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

/// Reads one view, or the views of a camera path, from a file in JSON, ParaView's .pvcc or plain text
/// (docs/FORMATS.md). The result is never empty. Throws Error(bad_input), with a message of one line that states the
/// file and the line.
TESSERA_EXPORT std::vector<CameraFile> read_cameras(const std::filesystem::path& file);

/// Does the same for the text of a file. `name` replaces the name of the file in messages.
TESSERA_EXPORT std::vector<CameraFile> parse_cameras(std::string_view text, const std::string& name);

/// Whether an argument is JSON text instead of the name of a file: text that begins with `{` or `[`. A file whose name
/// begins with one of these is given as `./{...`.
TESSERA_EXPORT bool is_json_text(std::string_view file_or_json);
/// Calls parse_cameras() for JSON text, with the name `camera` for messages, and read_cameras() for the name of a file.
TESSERA_EXPORT std::vector<CameraFile> cameras_of(const std::string& file_or_json);

/// Writes one view as JSON, with every double in the shortest form that reads back the same. The file appears by
/// rename.
TESSERA_EXPORT void write_camera(const CameraFile& camera, const std::filesystem::path& file);
/// Returns the text that write_camera() writes.
TESSERA_EXPORT std::string camera_json(const CameraFile& camera);

}  // namespace v0_1
}  // namespace tessera
