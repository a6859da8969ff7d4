// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "server/scene_reader.hpp"
#include "server/service.hpp"
#include "tessera/transfer_function.hpp"

namespace tessera::server {

enum class PictureFormat { png, jpeg, exr };

/// Returns a rendered image, with its annotation, as the bytes of the file that `tessera render` would write for the
/// scene.
SharedBytes finished_picture(Image image, PictureFormat format, const Scene& scene, const View& view,
                             const Dataset& data, const TransferFunction& function);

/// Does the same without the annotation.
SharedBytes bare_picture(const Image& image, PictureFormat format, const Scene& scene);

const char* media_type(PictureFormat format);

}  // namespace tessera::server
