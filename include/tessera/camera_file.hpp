// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "tessera/camera.hpp"

namespace tessera {
inline namespace v0_1 {

/// A view as a file gives it, with the picture's size if the file names one.
struct CameraFile {
  Camera camera;
  std::optional<ImageSize> size{};
  bool operator==(const CameraFile&) const = default;
};

}  // namespace v0_1
}  // namespace tessera
