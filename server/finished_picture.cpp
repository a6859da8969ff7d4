// SPDX-License-Identifier: BSD-3-Clause
#include "server/finished_picture.hpp"

#include "server/frame_message.hpp"
#include "tessera/image_file.hpp"

namespace tessera::server {

SharedBytes finished_picture(Image image, PictureFormat format, const Scene& scene, const View& view,
                             const Dataset& data, const TransferFunction& function) {
  if (scene.explains()) scene.explain(image, view, data, function);
  return bare_picture(image, format, scene);
}

SharedBytes bare_picture(const Image& image, PictureFormat format, const Scene& scene) {
  const ImageFileOptions options = scene.image_options();
  const auto bytes = format == PictureFormat::png    ? png_bytes(image, options)
                     : format == PictureFormat::jpeg ? jpeg_bytes(image, options)
                                                     : exr_bytes(image, options);
  return std::make_shared<const std::string>(string_of(bytes));
}

const char* media_type(PictureFormat format) {
  return format == PictureFormat::png ? "image/png" : format == PictureFormat::jpeg ? "image/jpeg" : "image/x-exr";
}

}  // namespace tessera::server
