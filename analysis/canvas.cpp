// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/canvas.hpp"

#include <cairo-svg.h>
#include <cairo.h>
#include <fmt/format.h>

#include <cmath>

#include "tessera/error.hpp"
#include "tessera/program/output_file.hpp"
#include "tessera/program/text.hpp"

namespace tessera::analysis {
namespace {

cairo_status_t append(void* text, const unsigned char* bytes, unsigned int count) {
  static_cast<std::string*>(text)->append(reinterpret_cast<const char*>(bytes), count);
  return CAIRO_STATUS_SUCCESS;
}

void check(cairo_status_t status, const std::filesystem::path& file) {
  if (status != CAIRO_STATUS_SUCCESS)
    throw Error(ErrorCode::system_failure,
                fmt::format("{}: the figure could not be drawn: {}; try .png instead of .svg, or .svg instead of .png",
                            file.string(), cairo_status_to_string(status)));
}

std::string lower_extension(const std::filesystem::path& file) { return lower_case(file.extension().string()); }

}  // namespace

Canvas::Canvas(cairo_t* cairo) : cairo_(cairo) {
  cairo_select_font_face(cairo_, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
}

void Canvas::color(std::uint32_t rgb) {
  cairo_set_source_rgb(cairo_, (rgb >> 16 & 255) / 255.0, (rgb >> 8 & 255) / 255.0, (rgb & 255) / 255.0);
}

void Canvas::rectangle(double x, double y, double width, double height, std::uint32_t rgb) {
  color(rgb);
  cairo_rectangle(cairo_, x, y, width, height);
  cairo_fill(cairo_);
}

void Canvas::disc(double x, double y, double radius, std::uint32_t rgb) {
  color(rgb);
  cairo_new_path(cairo_);
  cairo_arc(cairo_, x, y, radius, 0, 2 * M_PI);
  cairo_fill(cairo_);
}

void Canvas::line(double x0, double y0, double x1, double y1, double width, std::uint32_t rgb) {
  color(rgb);
  cairo_set_line_width(cairo_, width);
  cairo_move_to(cairo_, x0, y0);
  cairo_line_to(cairo_, x1, y1);
  cairo_stroke(cairo_);
}

double Canvas::text_width(const std::string& text, double size) {
  cairo_set_font_size(cairo_, size);
  cairo_text_extents_t extents;
  cairo_text_extents(cairo_, text.c_str(), &extents);
  return extents.x_advance;
}

void Canvas::text(double x, double y, const std::string& text, double size, double align, std::uint32_t rgb) {
  const double width = text_width(text, size);
  color(rgb);
  cairo_move_to(cairo_, x - align * width, y);
  cairo_show_text(cairo_, text.c_str());
}

void Canvas::upward_text(double x, double y, const std::string& label, double size) {
  cairo_save(cairo_);
  cairo_translate(cairo_, x, y);
  cairo_rotate(cairo_, -M_PI / 2);
  text(0, 0, label, size, 0.5);
  cairo_restore(cairo_);
}

void check_figure_path(const std::filesystem::path& file) {
  const std::string extension = lower_extension(file);
  if (extension != ".svg" && extension != ".png")
    throw bad_input(
        fmt::format("{}: the name of a figure must end in .svg or .png; choose one of them", file.string()));
}

void write_drawing(double width, double height, const std::filesystem::path& file,
                   const std::function<void(Canvas&)>& draw) {
  check_figure_path(file);
  struct DestroySurface {
    void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
  };
  struct DestroyContext {
    void operator()(cairo_t* cairo) const { cairo_destroy(cairo); }
  };
  using Surface = std::unique_ptr<cairo_surface_t, DestroySurface>;
  const auto draw_on = [&](cairo_surface_t* surface, double scale) {
    const std::unique_ptr<cairo_t, DestroyContext> cairo(cairo_create(surface));
    cairo_scale(cairo.get(), scale, scale);
    Canvas canvas(cairo.get());
    draw(canvas);
  };
  std::string bytes;
  if (lower_extension(file) == ".svg") {
    const Surface surface(cairo_svg_surface_create_for_stream(append, &bytes, width, height));
    draw_on(surface.get(), 1);
    cairo_surface_finish(surface.get());
    check(cairo_surface_status(surface.get()), file);
  } else {
    constexpr double pixels_a_point = 2;
    const auto pixels = [](double points) { return static_cast<int>(std::lround(points * pixels_a_point)); };
    const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, pixels(width), pixels(height)));
    check(cairo_surface_status(surface.get()), file);
    draw_on(surface.get(), pixels_a_point);
    check(cairo_surface_write_to_png_stream(surface.get(), append, &bytes), file);
  }
  AtomicFile output(file);
  output.write(bytes);
  output.commit();
}

}  // namespace tessera::analysis
