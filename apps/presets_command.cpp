#include "apps/presets_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <glm/vec3.hpp>

#include "tessera/annotation.hpp"
#include "tessera/dataset.hpp"
#include "tessera/image_file.hpp"
#include "tessera/presets.hpp"

namespace tessera::apps {
namespace {

/// A bar with its name, on white.
Image drawn(const std::string& name, ImageSize size) {
  Image image(size);
  Annotation annotation;
  annotation.color_bar = ColorBar{.title = name, .place = Place::bottom};
  annotation.style.background = glm::dvec3(1);
  annotation.style.text_size = 14;
  annotate(image, annotation, View{Camera{}, size}, Box{}, preset_function(name));
  return image;
}

}  // namespace

void presets(const std::filesystem::path& picture) {
  const auto names = preset_names();
  if (picture.empty()) {
    for (const std::string& name : names) fmt::print("{}\n", name);
    return;
  }
  check_image_path(picture);
  // Two columns; a name stands over its bar.
  constexpr ImageSize cell{400, 88};
  const int rows = (static_cast<int>(names.size()) + 1) / 2;
  Image sheet(ImageSize{2 * cell.width, rows * cell.height});
  for (int i = 0; i < static_cast<int>(names.size()); ++i) {
    const Image one = drawn(names[static_cast<std::size_t>(i)], cell);
    for (int y = 0; y < cell.height; ++y)
      std::copy_n(one.rgba.begin() + static_cast<std::ptrdiff_t>(4 * one.index(0, y)), 4 * cell.width,
                  sheet.rgba.begin() +
                      static_cast<std::ptrdiff_t>(4 * sheet.index(i / rows * cell.width, i % rows * cell.height + y)));
  }
  ImageFileOptions options;
  options.background = glm::dvec3(1);
  write_image(sheet, picture, options);
}

}  // namespace tessera::apps
