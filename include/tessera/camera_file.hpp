// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "tessera/camera.hpp"

namespace tessera {
inline namespace v0_1 {

/// A view read from a file, with the image size if the file states one.
struct CameraFile {
  Camera camera;
  std::optional<ImageSize> size{};
  bool operator==(const CameraFile&) const = default;
};

}  // namespace v0_1
}  // namespace tessera
