// SPDX-License-Identifier: BSD-3-Clause
#include "apps/commands/presets_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <glm/vec3.hpp>

#include "tessera/annotation.hpp"
#include "tessera/dataset.hpp"
#include "tessera/image_file.hpp"
#include "tessera/presets.hpp"

namespace tessera::apps {
namespace {

/// Draws the colours from low to high, below their name, on white.
Image drawn(const std::string& name, ImageSize size) {
  constexpr int margin = 8, top = 28;
  const TransferFunction function = preset_function(name);
  Image image(size);
  std::ranges::fill(image.rgba, 1.0f);  // every colour map except a white one is visible on white
  const int width = size.width - 2 * margin;
  for (int y = top; y < size.height - margin; ++y)
    for (int x = 0; x < width; ++x) {
      const glm::dvec3 color = function.evaluate((x + 0.5) / width).color;
      for (int i = 0; i < 3; ++i)
        image.rgba[4 * image.index(x + margin, y) + static_cast<std::size_t>(i)] = static_cast<float>(color[i]);
    }
  Annotation annotation;
  annotation.texts.push_back({name, Place::top_left});
  annotation.style.background = glm::dvec3(1);
  annotation.style.text_size = 14;
  annotate(image, annotation, View{Camera{}, size}, Box{}, function);
  return image;
}

}  // namespace

void presets(const std::filesystem::path& picture) {
  const auto names = preset_names();
  if (picture.empty()) {
    for (const std::string& name : names) fmt::print("{}\n", name);
    fmt::print("\nwith an opacity, like {}:peaks:\n", names[1]);
    for (const std::string& name : preset_opacity_names()) fmt::print("{}\n", name);
    return;
  }
  check_image_path(picture);
  // Two columns; the name of each preset is above its bar.
  constexpr ImageSize cell{400, 64};
  const int rows = (static_cast<int>(names.size()) + 1) / 2;
  Image sheet(ImageSize{2 * cell.width, rows * cell.height});
  std::ranges::fill(sheet.rgba, 1.0f);
  for (int i = 0; i < static_cast<int>(names.size()); ++i) {
    const Image one = drawn(names[static_cast<std::size_t>(i)], cell);
    for (int y = 0; y < cell.height; ++y)
      std::copy_n(one.rgba.begin() + static_cast<std::ptrdiff_t>(4 * one.index(0, y)), 4 * cell.width,
                  sheet.rgba.begin() +
                      static_cast<std::ptrdiff_t>(4 * sheet.index(i / rows * cell.width, i % rows * cell.height + y)));
  }
  write_image(sheet, picture);
}

}  // namespace tessera::apps
