// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

extern "C" {
typedef struct _cairo cairo_t;  // NOLINT(bugprone-reserved-identifier, modernize-use-using): Cairo's
}

namespace tessera::analysis {

/// Draws a few kinds of shapes with Cairo. Lengths are in points, y points downwards, and colours are 0xRRGGBB.
class Canvas {
 public:
  explicit Canvas(cairo_t* cairo);

  void rectangle(double x, double y, double width, double height, std::uint32_t rgb);
  void disc(double x, double y, double radius, std::uint32_t rgb);
  void line(double x0, double y0, double x1, double y1, double width, std::uint32_t rgb);
  [[nodiscard]] double text_width(const std::string& text, double size);
  /// Draws UTF-8 text with its baseline at y. x is the left end of the text if `align` is 0, its middle for 0.5, and
  /// its right end for 1.
  void text(double x, double y, const std::string& text, double size, double align = 0, std::uint32_t rgb = 0x222222);
  /// Draws text that runs upwards, with its middle at (x, y).
  void upward_text(double x, double y, const std::string& label, double size);

 private:
  void color(std::uint32_t rgb);
  cairo_t* cairo_;
};

/// Throws Error(bad_input) unless the name ends in .svg or .png.
void check_figure_path(const std::filesystem::path& file);

/// Writes a drawing of this size (in points) as .svg, or as .png with two pixels per point. The file appears by rename.
/// Throws the errors of check_figure_path() and of AtomicFile, and Error(system_failure) if Cairo fails.
void write_drawing(double width, double height, const std::filesystem::path& file,
                   const std::function<void(Canvas&)>& draw);

}  // namespace tessera::analysis
