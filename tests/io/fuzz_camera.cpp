// SPDX-License-Identifier: BSD-3-Clause
// Any text is parsed as a camera or refused in one line; an accepted camera is valid and survives being written.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "io/scene/camera_file.hpp"
#include "support/fuzz_check.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tessera;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  test::parse_or_refuse([&] {
    const auto views = io::parse_cameras(text, "f");
    test::require(!views.empty());
    for (const io::CameraFile& view : views) {
      scene::validate(view.camera);
      const auto again = io::parse_json_cameras(io::camera_json(view), "written");
      test::require(again.size() == 1 && again.front() == view);
    }
  });
  // Also each format separately, whatever the first character.
  test::parse_or_refuse([&] { io::parse_text_camera(text, "f"); });
  test::parse_or_refuse([&] { io::parse_pvcc_camera(text, "f"); });
  return 0;
}
