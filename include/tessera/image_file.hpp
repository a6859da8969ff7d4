// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "tessera/deep_image.hpp"
#include "tessera/export.hpp"
#include "tessera/image.hpp"
#include "tessera/image_file_options.hpp"

namespace tessera {
inline namespace v0_1 {

// Files appear by rename, complete or not at all.

/// Writes an image in the format of its file's extension.
///   .exr  OpenEXR scan lines, ZIP: R G B A linear and premultiplied, Z planar depth (+inf where nothing is visible).
///   .png  sRGB, 8 or 16 bits. Without a background RGBA with straight alpha, as PNG requires: light that a pixel emits
///         beyond its alpha (independent emission) is clamped; a background shows it.
///   .tif  as .png: 8 or 16 bits, deflated, straight alpha (.tiff too); BigTIFF beyond 4 GB.
///   .jpg  sRGB, 8 bits, without chroma subsampling (.jpeg too). No alpha: without a background the image is on black.
///   .pfm  linear RGB, premultiplied, 32-bit floats, little endian, bottom row first. No alpha.
/// Throws Error(bad_input) for another extension, .jpg or .tif if the library was built without it, a missing
/// directory, or a number beyond the range of half; Error(system_failure) if the disk fails or a pixel is NaN or
/// infinite.
TESSERA_EXPORT void write_image(const Image& image, const std::filesystem::path& file,
                                const ImageFileOptions& options = {});

// The bytes that write_image() writes into a .png, .exr or .jpg file, in memory. They throw as it does, with "image"
// as the file's name.
TESSERA_EXPORT std::vector<std::byte> png_bytes(const Image& image, const ImageFileOptions& options = {});
TESSERA_EXPORT std::vector<std::byte> exr_bytes(const Image& image, const ImageFileOptions& options = {});
/// Throws Error(bad_input) where the library was built without libjpeg (TESSERA_JPEG).
TESSERA_EXPORT std::vector<std::byte> jpeg_bytes(const Image& image, const ImageFileOptions& options = {});

/// Reads .exr (R G B, A if present, else 1; Z if present, else +inf) and .pfm (A = 1, Z = +inf). Throws
/// Error(bad_input) for anything else and for broken files.
TESSERA_EXPORT Image read_image(const std::filesystem::path& file);

/// Writes a deep image as OpenEXR, .exr. Throws as write_image.
TESSERA_EXPORT void write_deep_image(const DeepImage& image, const std::filesystem::path& file);

/// Whether a file of this name is a deep image: it ends in `.deep.exr` (upper or lower case).
TESSERA_EXPORT bool is_deep_name(const std::filesystem::path& file);

/// For use before rendering: throws Error(bad_input) unless write_image knows the extension and the file can be
/// created.
TESSERA_EXPORT void check_image_path(const std::filesystem::path& file);

}  // namespace v0_1
}  // namespace tessera
