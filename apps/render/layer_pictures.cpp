// SPDX-License-Identifier: BSD-3-Clause
#include "apps/render/layer_pictures.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <string>

#include "apps/render/picture_writer.hpp"
#include "tessera/image_file.hpp"

namespace tessera::apps {
namespace {

std::filesystem::path layer_name(const std::filesystem::path& picture, int layer) {
  std::filesystem::path name = picture;
  return name.replace_extension().concat(fmt::format(".layer{}", layer)).concat(picture.extension().string());
}

}  // namespace

void name_layers(const RenderOptions& options, std::vector<FilmFrame>& frames) {
  if (!options.frame.peel) return;
  const std::size_t planned = options.plan.outputs.size();
  for (FilmFrame& frame : frames) {
    std::vector<std::filesystem::path> names;
    for (std::size_t i = 0; i < planned; ++i)
      for (int layer = 1; layer <= options.frame.peel->layers && !is_deep_name(frame.outputs[i]); ++layer) {
        names.push_back(layer_name(frame.outputs[i], layer));
        frame.finished = frame.finished && std::filesystem::exists(names.back());
      }
    frame.outputs.insert(frame.outputs.begin() + static_cast<std::ptrdiff_t>(planned), names.begin(), names.end());
  }
}

void write_layers(const RenderedFrame& rendered, const FilmFrame& frame, const RenderOptions& options) {
  if (!options.frame.peel) return;
  ImageFileOptions transparent = options.image;
  transparent.background.reset();
  std::size_t next = options.plan.outputs.size();
  for (std::size_t i = 0; i < options.plan.outputs.size(); ++i) {
    if (is_deep_name(frame.outputs[i])) continue;
    for (const Image& layer : rendered.layers) PictureWriter::write_file(layer, frame.outputs[next++], transparent);
  }
}

}  // namespace tessera::apps
