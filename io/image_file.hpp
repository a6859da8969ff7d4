#pragma once

#include <filesystem>
#include <glm/vec3.hpp>
#include <optional>

#include "scene/image.hpp"

namespace tessera::io {

/// What the user may say about an image file.
struct ImageFileOptions {
  bool half = false;        ///< .exr: R G B A as half instead of float; Z is float always
  int png_bits = 8;         ///< .png: 8 or 16 bits a channel
  bool encode_srgb = true;  ///< .png: false with --blend display, where colours are display values already
  /// Composited behind the picture, which is opaque then (A = 1; .png without an alpha channel). In the picture's own
  /// space: linear RGB, or display values where encode_srgb is false.
  std::optional<glm::dvec3> background{};
};

/// Writes a picture by its name's extension. It appears by rename, whole or not at all.
///   .exr  OpenEXR scan lines, ZIP: R G B A linear and premultiplied, Z planar depth (+inf where nothing is).
///   .png  sRGB. Without a background RGBA with straight alpha, as PNG has it: light that a pixel emits beyond its
///         alpha (independent emission) is clamped, give a background to see it.
///   .pfm  linear RGB, premultiplied, 32-bit floats, little endian, bottom row first. No alpha.
/// Working memory is a few rows. Throws Error(bad_input) for what check_image_path refuses and for a number that half
/// cannot hold, Error(system_failure) if the disk fails or a pixel is NaN or infinite (never written silently).
void write_image(const scene::Image& image, const std::filesystem::path& file, const ImageFileOptions& options);

/// Reads .exr (R G B, A if present, else 1; Z if present, else +inf) and .pfm (A = 1, Z = +inf). For tests and for
/// comparing with stored pictures. Throws Error(bad_input) for anything else and for broken files.
scene::Image read_image(const std::filesystem::path& file);

/// Throws Error(bad_input) unless write_image knows the extension and could create this file now: its folder exists and
/// lets us write, and the name is not that of a folder or device. To be called before any rendering.
void check_image_path(const std::filesystem::path& file);

}  // namespace tessera::io
