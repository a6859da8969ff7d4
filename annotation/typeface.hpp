// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

extern "C" {
typedef struct _cairo cairo_t;  // NOLINT(bugprone-reserved-identifier, modernize-use-using): Cairo's
typedef struct _cairo_font_face cairo_font_face_t;  // NOLINT(bugprone-reserved-identifier, modernize-use-using)
}

namespace tessera::annotation {

/// Returns `text` as valid UTF-8 on one line. Each invalid byte becomes U+FFFD, and control characters become blanks.
std::string clean_text(const std::string& text);

/// The font of Cairo at one size: DejaVu Sans, or fontconfig's replacement. Missing glyphs are drawn as boxes.
class Typeface {
 public:
  /// `size` in pixels. Throws Error(system_failure) if there is no font.
  explicit Typeface(double size);

  [[nodiscard]] double size() const { return size_; }
  /// Largest distances of letters above and below the baseline, in pixels.
  [[nodiscard]] double ascent() const { return ascent_; }
  [[nodiscard]] double descent() const { return descent_; }
  [[nodiscard]] double line() const { return ascent_ + descent_; }
  /// Returns the width of a text in pixels. `text` must be clean (clean_text()).
  [[nodiscard]] double width(const std::string& text) const;
  /// Shortens clean text to at most this width by replacing its middle by "…". The result is empty if not even one
  /// letter fits next to "…".
  [[nodiscard]] std::string fitted(const std::string& text, double width) const;

  /// Sets this font in a context, without hinting, so that letters have the same shape at any position.
  void select(cairo_t* cairo) const;

 private:
  struct Destroy {
    void operator()(cairo_t* cairo) const;
    void operator()(cairo_font_face_t* face) const;
  };
  double size_, ascent_ = 0, descent_ = 0;
  std::unique_ptr<cairo_font_face_t, Destroy> face_;
  std::unique_ptr<cairo_t, Destroy> measure_;
};

}  // namespace tessera::annotation
