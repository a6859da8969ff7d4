// SPDX-License-Identifier: BSD-3-Clause
// The public functions: a sheet is sketched, painted in two layers, and composited.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "annotation/painter.hpp"
#include "annotation/sketch.hpp"
#include "tessera/annotation.hpp"
#include "tessera/error.hpp"

namespace tessera::annotation {
namespace {

constexpr double least_text = 4, largest_text = 1000;

double text_size(const AnnotationStyle& style, ImageSize size) {
  if (style.text_size) return *style.text_size;
  return std::clamp(0.02 * std::min<double>(size.width, 1.5 * size.height), 8.0, 400.0);
}

void check_color(const char* name, const std::optional<glm::dvec3>& color) {
  if (!color) return;
  for (int c = 0; c < 3; ++c)
    if (!((*color)[c] >= 0) || !std::isfinite((*color)[c]))
      throw bad_input(
          fmt::format("`{}`: component {} is {}; it must be finite and at least 0", name, c + 1, (*color)[c]));
}

Sheet sketched(const Annotation& annotation, const Screen& screen, const Typeface& typeface, const Box& box,
               const TransferFunction& function) {
  const double margin = std::max(2.0, 0.7 * typeface.size());
  Sketch sketch{screen, typeface, annotation.style, Layout(screen.view().size, margin)};
  if (annotation.outline) add_outline(sketch, box);
  if (annotation.axes && annotation.axes->triad) add_triad(sketch, annotation.axes->place);
  if (annotation.color_bar) add_color_bar(sketch, *annotation.color_bar, function);
  if (annotation.scale_bar) add_scale_bar(sketch, *annotation.scale_bar);
  for (const Text& text : annotation.texts) add_text(sketch, text);
  if (annotation.axes && annotation.axes->box) add_box_axes(sketch, box, annotation.outline.has_value());
  return std::move(sketch.sheet);
}

using Pixel = TiledLayer::Pixel;

/// Returns the pixel of the annotation alone: the layer in front of the data and, as seen through `picture`, the layer
/// behind the data. For a layer L behind the image P, the result P + (1 - A_P) L equals "over" of the pixel ((1 - A_P)
/// L + A_L P, A_L) and P.
Pixel joined(const Pixel* over, const Pixel* behind, const float* picture) {
  Pixel pixel{};
  if (behind != nullptr && (*behind)[3] > 0) {
    for (std::size_t c = 0; c < 3; ++c) pixel[c] = (1 - picture[3]) * (*behind)[c] + (*behind)[3] * picture[c];
    pixel[3] = (*behind)[3];
  }
  if (over != nullptr)
    for (std::size_t c = 0; c < 4; ++c) pixel[c] = (*over)[c] + (1 - (*over)[3]) * pixel[c];
  return pixel;
}

/// Calls `pixel(index, value)` for each pixel of the image that the annotation touches.
template <class Use>
void for_each_pixel(const Image& picture, const TiledLayer& over, const TiledLayer& behind, const Use& use) {
  constexpr int side = TiledLayer::side;
  for (int row = 0; row < over.rows(); ++row)
    for (int column = 0; column < over.columns(); ++column) {
      const TiledLayer::Tile *front = over.tile(column, row), *back = behind.tile(column, row);
      if (front == nullptr && back == nullptr) continue;
      const int height = std::min(side, picture.size.height - row * side);
      const int width = std::min(side, picture.size.width - column * side);
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
          const auto i = static_cast<std::size_t>(y) * side + static_cast<std::size_t>(x);
          const std::size_t at = picture.index(column * side + x, row * side + y);
          const Pixel pixel = joined(front != nullptr ? &(*front)[i] : nullptr, back != nullptr ? &(*back)[i] : nullptr,
                                     &picture.rgba[4 * at]);
          if (pixel[3] > 0) use(at, pixel);
        }
    }
}

template <class Use>
void draw(const Image& picture, const Annotation& annotation, const View& view, const Box& box,
          const TransferFunction& function, const Use& use) {
  validate(annotation, function);
  const Screen screen(view);
  if (picture.size != view.size ||
      picture.rgba.size() != 4 * std::size_t(view.size.width) * std::size_t(view.size.height))
    throw bad_input(fmt::format(
        "annotation: the image has {}x{} pixels, but its view {}x{}; give the view from which the image was rendered",
        picture.size.width, picture.size.height, view.size.width, view.size.height));
  const Typeface typeface(text_size(annotation.style, view.size));
  const Ink ink(annotation.style);
  const Sheet sheet = sketched(annotation, screen, typeface, box, function);
  TiledLayer over(view.size), behind(view.size);
  paint(sheet.before, ink, typeface, over);
  paint(sheet.on_top, ink, typeface, over);
  paint(sheet.behind, ink, typeface, behind);
  for_each_pixel(picture, over, behind, use);
}

}  // namespace
}  // namespace tessera::annotation

namespace tessera {
inline namespace v0_1 {

void annotate(Image& picture, const Annotation& annotation, const View& view, const Box& box,
              const TransferFunction& transfer_function) {
  annotation::draw(picture, annotation, view, box, transfer_function,
                   [&](std::size_t at, const annotation::Pixel& pixel) {
                     for (std::size_t c = 0; c < 4; ++c) {
                       float& value = picture.rgba[4 * at + c];
                       value = pixel[c] + (1 - pixel[3]) * value;
                     }
                   });
}

Image annotation_layer(const Image& picture, const Annotation& annotation, const View& view, const Box& box,
                       const TransferFunction& transfer_function) {
  Image layer(picture.size);
  annotation::draw(
      picture, annotation, view, box, transfer_function,
      [&](std::size_t at, const annotation::Pixel& pixel) { std::ranges::copy(pixel, &layer.rgba[4 * at]); });
  return layer;
}

void validate(const Annotation& annotation, const TransferFunction& transfer_function) {
  const AnnotationStyle& style = annotation.style;
  annotation::check_color("annotation_color", style.ink);
  annotation::check_color("background", style.background);
  if (style.text_size && !(*style.text_size >= annotation::least_text && *style.text_size <= annotation::largest_text))
    throw bad_input(fmt::format("`annotation_size` {}: it must be {} to {} pixels", *style.text_size,
                                annotation::least_text, annotation::largest_text));
  if (annotation.color_bar) {
    const auto [low, high] = annotation::range_of(*annotation.color_bar, transfer_function);
    if (!std::isfinite(low) || !std::isfinite(high) || low > high)
      throw bad_input(fmt::format("`color_bar_range` {} to {}: it must be finite and ascending", low, high));
    if (annotation.color_bar->logarithmic && !(low > 0))
      throw bad_input(
          fmt::format("colour bar: its range, {} to {}, includes 0 or negative values, which have no logarithm; give "
                      "`color_bar_range`",
                      low, high));
  }
  annotation::Typeface(12);  // throws if there is no font
}

}  // namespace v0_1
}  // namespace tessera
