// SPDX-License-Identifier: BSD-3-Clause
#include "annotation/typeface.hpp"

#include <cairo.h>
#include <fmt/format.h>

#include <cstddef>
#include <vector>

#include "tessera/error.hpp"

namespace tessera::annotation {

void Typeface::Destroy::operator()(cairo_t* cairo) const { cairo_destroy(cairo); }
void Typeface::Destroy::operator()(cairo_font_face_t* face) const { cairo_font_face_destroy(face); }

Typeface::Typeface(double size) : size_(size) {
  face_.reset(cairo_toy_font_face_create("DejaVu Sans", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL));
  cairo_surface_t* surface = cairo_image_surface_create(CAIRO_FORMAT_A8, 1, 1);
  measure_.reset(cairo_create(surface));
  cairo_surface_destroy(surface);  // the context keeps the surface alive
  select(measure_.get());
  cairo_scaled_font_t* font = cairo_get_scaled_font(measure_.get());
  if (const cairo_status_t status = cairo_status(measure_.get()); status != CAIRO_STATUS_SUCCESS)
    throw Error(ErrorCode::system_failure, fmt::format("annotation: Cairo failed: {}", cairo_status_to_string(status)));
  // If the machine has no font, Cairo uses its built-in font, which has only ASCII characters made of strokes.
  if (cairo_scaled_font_get_type(font) == CAIRO_FONT_TYPE_USER)
    throw Error(ErrorCode::system_failure,
                "annotation: no font was found; install one that fontconfig can find (Debian: fonts-dejavu-core)");
  cairo_font_extents_t extents;
  cairo_font_extents(measure_.get(), &extents);
  ascent_ = extents.ascent;
  descent_ = extents.descent;
}

void Typeface::select(cairo_t* cairo) const {
  cairo_font_options_t* options = cairo_font_options_create();
  cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
  cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
  cairo_set_font_options(cairo, options);
  cairo_font_options_destroy(options);
  cairo_set_font_face(cairo, face_.get());
  cairo_set_font_size(cairo, size_);
}

double Typeface::width(const std::string& text) const {
  cairo_text_extents_t extents;
  cairo_text_extents(measure_.get(), text.c_str(), &extents);
  return extents.x_advance;
}

std::string Typeface::fitted(const std::string& text, double room) const {
  constexpr std::size_t longest = 1000;  // largest number of letters examined at either end
  const auto begins = [&](std::size_t i) { return (static_cast<unsigned char>(text[i]) & 0xC0u) != 0x80u; };
  std::vector<std::size_t> after, before;  // positions where the first k letters end and where the last k letters begin
  for (std::size_t i = 0; i < text.size() && after.size() <= longest; ++i)
    if (begins(i)) after.push_back(i);
  if (after.size() <= longest) {
    if (width(text) <= room) return text;
    after.push_back(text.size());
  }
  before.push_back(text.size());
  for (std::size_t i = text.size(); i > 0 && before.size() <= longest; --i)
    if (begins(i - 1)) before.push_back(i - 1);
  const auto with = [&](std::size_t kept) {  // keeps less of the end, which may be a unit, than of the beginning
    return text.substr(0, after[kept - kept / 3]) + "…" + text.substr(before[kept / 3]);
  };
  std::size_t fits = 0, too_many = after.size() - 1;
  while (too_many - fits > 1) {
    const std::size_t middle = (fits + too_many) / 2;
    (width(with(middle)) <= room ? fits : too_many) = middle;
  }
  return fits == 0 ? std::string() : with(fits);
}

}  // namespace tessera::annotation
