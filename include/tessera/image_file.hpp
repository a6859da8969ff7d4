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

// Files are written under a temporary name and then renamed, so that they appear complete or not at all.

/// Writes an image in the format that the file's extension denotes.
///   .exr  OpenEXR scan lines, ZIP: R G B A linear and premultiplied, Z planar depth (+inf where nothing is visible).
///   .png  sRGB, 8 or 16 bits. Without a background: RGBA with straight alpha, as PNG requires. Premultiplied
///         colours above alpha (from independent emission) are clamped; they are only visible with a background.
///   .tif  as .png, compressed by deflate (.tiff too); BigTIFF if larger than 4 GB.
///   .jpg  sRGB, 8 bits, without chroma subsampling (.jpeg too). No alpha: without a background the image is on black.
///   .pfm  linear RGB, premultiplied, 32-bit floats, little endian, bottom row first. No alpha.
/// Throws Error(bad_input) for another extension, for .jpg or .tif if the library was built without support for it, for
/// a missing directory, and for a number beyond the range of half; Error(system_failure) if the disk fails or a pixel
/// is NaN or infinite.
TESSERA_EXPORT void write_image(const Image& image, const std::filesystem::path& file,
                                const ImageFileOptions& options = {});

// These functions return the bytes that write_image() would write into a .png, .exr or .jpg file. They throw the same
// errors as write_image(), with "image" as the file's name.
TESSERA_EXPORT std::vector<std::byte> png_bytes(const Image& image, const ImageFileOptions& options = {});
TESSERA_EXPORT std::vector<std::byte> exr_bytes(const Image& image, const ImageFileOptions& options = {});
/// Throws Error(bad_input) if the library was built without libjpeg (TESSERA_JPEG).
TESSERA_EXPORT std::vector<std::byte> jpeg_bytes(const Image& image, const ImageFileOptions& options = {});

/// Reads .exr (R G B, A if present, else 1; Z if present, else +inf) and .pfm (A = 1, Z = +inf). Throws
/// Error(bad_input) for other formats and for damaged files.
TESSERA_EXPORT Image read_image(const std::filesystem::path& file);

/// Writes a deep image as OpenEXR (.exr). Throws the same errors as write_image().
TESSERA_EXPORT void write_deep_image(const DeepImage& image, const std::filesystem::path& file);

/// Whether a file of this name is written as a deep image: the name ends in `.deep.exr` (upper or lower case).
TESSERA_EXPORT bool is_deep_name(const std::filesystem::path& file);

/// For use before rendering: throws Error(bad_input) unless write_image() supports the extension and the file can be
/// created.
TESSERA_EXPORT void check_image_path(const std::filesystem::path& file);

}  // namespace v0_1
}  // namespace tessera
