// SPDX-License-Identifier: BSD-3-Clause
#include "annotation/painter.hpp"

#include <cairo.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>

#include "tessera/error.hpp"

namespace tessera::annotation {
namespace {

constexpr double halo_opacity = 0.8;

/// Corners of a rectangle, in pixels.
struct Bounds {
  double left = 1e300, top = 1e300, right = -1e300, bottom = -1e300;
  void add(const glm::dvec2& p, double by) {
    left = std::min(left, p.x - by);
    top = std::min(top, p.y - by);
    right = std::max(right, p.x + by);
    bottom = std::max(bottom, p.y + by);
  }
  void add(const Bounds& other) {
    left = std::min(left, other.left);
    top = std::min(top, other.top);
    right = std::max(right, other.right);
    bottom = std::max(bottom, other.bottom);
  }
};

struct Block {
  int x, y, width, height;
  [[nodiscard]] bool meets(const Bounds& b) const {
    return b.right > x && b.left < x + width && b.bottom > y && b.top < y + height;
  }
};

/// Distance by which the halo extends beyond the ink. For text it is the width of a letter's stem; for lines it is
/// smaller.
double halo_width(const Mark& mark, const Typeface& typeface) {
  if (const auto* stroke = std::get_if<Stroke>(&mark)) return std::max(1.0, 0.75 * stroke->width);
  return std::max(1.0, 0.12 * typeface.size());
}

Bounds bounds_of(const Mark& mark, const Typeface& typeface) {
  const double halo = halo_width(mark, typeface) + 1;
  Bounds bounds;
  if (const auto* stroke = std::get_if<Stroke>(&mark)) {
    for (const glm::dvec2& p : stroke->points) bounds.add(p, stroke->width + halo);
  } else if (const auto* label = std::get_if<Label>(&mark)) {
    // Letters may extend beyond their advance.
    const double size = typeface.size();
    bounds.add(label->at - glm::dvec2(0.5 * size, 1.2 * size), halo);
    bounds.add(label->at + glm::dvec2(typeface.width(label->text) + 0.5 * size, 0.6 * size), halo);
  } else {
    for (const glm::dvec2& p : std::get<Shape>(mark).corners) bounds.add(p, halo);
  }
  return bounds;
}

/// A mask of Cairo for one block of the image. Marks that share a colour are drawn together into the mask, which is
/// then added to the layer in this colour. The colours of the layer therefore have single precision, although Cairo has
/// only 8 bits.
class Mask {
 public:
  Mask(const Block& block, const Typeface& typeface) : block_(block) {
    surface_.reset(cairo_image_surface_create(CAIRO_FORMAT_A8, block.width, block.height));
    cairo_.reset(cairo_create(surface_.get()));
    cairo_translate(cairo_.get(), -block.x, -block.y);
    cairo_set_line_join(cairo_.get(), CAIRO_LINE_JOIN_ROUND);
    typeface.select(cairo_.get());
  }

  /// Draws the mark, extended by `widened` on all sides.
  void draw(const Mark& mark, const Bounds& bounds, double widened) {
    if (!block_.meets(bounds)) return;
    touched_.add(bounds);
    cairo_t* cairo = cairo_.get();
    cairo_new_path(cairo);
    if (const auto* stroke = std::get_if<Stroke>(&mark)) {
      cairo_set_line_cap(cairo, widened > 0 ? CAIRO_LINE_CAP_SQUARE : CAIRO_LINE_CAP_BUTT);
      for (const glm::dvec2& p : stroke->points) cairo_line_to(cairo, p.x, p.y);
      cairo_set_line_width(cairo, stroke->width + 2 * widened);
      cairo_stroke(cairo);
      return;
    }
    if (const auto* label = std::get_if<Label>(&mark)) {
      // Text is drawn as outlines, which can be positioned to a fraction of a pixel and widened.
      cairo_move_to(cairo, label->at.x, label->at.y);
      cairo_text_path(cairo, label->text.c_str());
    } else {
      for (const glm::dvec2& p : std::get<Shape>(mark).corners) cairo_line_to(cairo, p.x, p.y);
      cairo_close_path(cairo);
    }
    if (widened > 0) {
      cairo_set_line_width(cairo, 2 * widened);
      cairo_stroke_preserve(cairo);
    }
    cairo_fill(cairo);
  }

  /// Adds the contents of the mask to the layer in one colour, and clears the mask.
  void take(const glm::dvec3& color, double opacity, TiledLayer& layer) {
    if (touched_.right < touched_.left) return;
    const auto within = [](double v, int size) { return static_cast<int>(std::clamp(v, 0.0, double(size))); };
    const int left = within(std::floor(touched_.left) - block_.x, block_.width);
    const int right = within(std::ceil(touched_.right) - block_.x, block_.width);
    const int top = within(std::floor(touched_.top) - block_.y, block_.height);
    const int bottom = within(std::ceil(touched_.bottom) - block_.y, block_.height);
    touched_ = {};
    cairo_surface_flush(surface_.get());
    if (const cairo_status_t status = cairo_status(cairo_.get()); status != CAIRO_STATUS_SUCCESS)
      throw Error(ErrorCode::system_failure,
                  fmt::format("annotation: Cairo failed: {}", cairo_status_to_string(status)));
    unsigned char* pixels = cairo_image_surface_get_data(surface_.get());
    const std::ptrdiff_t stride = cairo_image_surface_get_stride(surface_.get());
    for (int y = top; y < bottom; ++y) {
      unsigned char* row = pixels + y * stride;
      for (int x = left; x < right;) {
        // Most of the mask is empty, so eight pixels are skipped at once.
        if (std::uint64_t eight = 0; x + 8 <= right && (std::memcpy(&eight, row + x, 8), eight == 0)) {
          x += 8;
          continue;
        }
        if (row[x] != 0) layer.blend(block_.x + x, block_.y + y, color, row[x] / 255.0 * opacity);
        ++x;
      }
      std::memset(row + left, 0, static_cast<std::size_t>(right - left));
    }
    cairo_surface_mark_dirty(surface_.get());
  }

 private:
  struct Destroy {
    void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
    void operator()(cairo_t* cairo) const { cairo_destroy(cairo); }
  };
  Block block_;
  std::unique_ptr<cairo_surface_t, Destroy> surface_;
  std::unique_ptr<cairo_t, Destroy> cairo_;
  Bounds touched_;
};

void paint(const Swatch& swatch, TiledLayer& layer) {
  std::size_t i = 0;
  for (int y = swatch.y; y < swatch.y + swatch.height; ++y)
    for (int x = swatch.x; x < swatch.x + swatch.width; ++x, ++i)
      if (x >= 0 && y >= 0 && x < layer.size().width && y < layer.size().height) layer.blend(x, y, swatch.colors[i], 1);
}

/// Calls `in_block`, with a mask, for each block of the image that overlaps one of the bounds. A single mask would be
/// as large as the image, and images of Cairo have at most 32767 pixels per side.
template <class InBlock>
void for_each_block(std::span<const Bounds> bounds, const Typeface& typeface, ImageSize size, const InBlock& in_block) {
  constexpr int side = 1024;
  for (int y = 0; y < size.height; y += side)
    for (int x = 0; x < size.width; x += side) {
      const Block block{x, y, std::min(side, size.width - x), std::min(side, size.height - y)};
      if (std::ranges::none_of(bounds, [&](const Bounds& b) { return block.meets(b); })) continue;
      Mask mask(block, typeface);
      in_block(mask);
    }
}

Pen pen_of(const Mark& mark) {
  return std::visit([](const auto& m) { return m.pen; }, mark);
}

double opacity_of(const Mark& mark) {
  const auto* shape = std::get_if<Shape>(&mark);
  return shape != nullptr ? shape->opacity : 1;
}

bool same_ink(const Mark& a, const Mark& b) { return pen_of(a) == pen_of(b) && opacity_of(a) == opacity_of(b); }

}  // namespace

void paint(const Drawing& drawing, const Ink& ink, const Typeface& typeface, TiledLayer& layer) {
  const std::vector<Mark>& marks = drawing.marks;
  std::vector<Bounds> bounds;
  bounds.reserve(marks.size());
  for (const Mark& mark : marks) bounds.push_back(bounds_of(mark, typeface));
  for_each_block(bounds, typeface, layer.size(), [&](Mask& mask) {
    for (std::size_t i = 0; i < marks.size(); ++i) mask.draw(marks[i], bounds[i], halo_width(marks[i], typeface));
    mask.take(ink.halo(), halo_opacity, layer);
  });
  for (const Swatch& swatch : drawing.swatches) paint(swatch, layer);
  for_each_block(bounds, typeface, layer.size(), [&](Mask& mask) {
    for (std::size_t i = 0; i < marks.size(); ++i) {
      mask.draw(marks[i], bounds[i], 0);
      if (i + 1 == marks.size() || !same_ink(marks[i], marks[i + 1]))
        mask.take(ink.color(pen_of(marks[i])), opacity_of(marks[i]), layer);
    }
  });
}

}  // namespace tessera::annotation
