// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "io/image/image_file.hpp"

namespace tessera::io {

// One writer per format. image_file.cpp chooses the writer by extension, after checking the sizes of the image. Every
// writer gets its rows from composited_row().

void write_exr(const scene::Image& image, const std::filesystem::path& file, const ImageFileOptions& options);
void write_png(const scene::Image& image, const std::filesystem::path& file, const ImageFileOptions& options);
void write_jpeg(const scene::Image& image, const std::filesystem::path& file, const ImageFileOptions& options);
void write_tiff(const scene::Image& image, const std::filesystem::path& file, const ImageFileOptions& options);
void write_pfm(const scene::Image& image, const std::filesystem::path& file, const ImageFileOptions& options);
std::vector<std::byte> png_bytes(const scene::Image& image, const ImageFileOptions& options);
std::vector<std::byte> exr_bytes(const scene::Image& image, const ImageFileOptions& options);
std::vector<std::byte> jpeg_bytes(const scene::Image& image, const ImageFileOptions& options);
/// Whether write_jpeg() is available.
bool has_jpeg();
/// Whether write_tiff() is available.
bool has_tiff();
scene::Image read_exr(const std::filesystem::path& file);
scene::Image read_pfm(const std::filesystem::path& file);

/// Computes row `y` as the file stores it: 4 floats per pixel, premultiplied, composited over the background. Throws
/// Error(system_failure) for a NaN or infinite component or a NaN depth; the message names file and pixel.
void composited_row(const scene::Image& image, int y, const ImageFileOptions& options,
                    const std::filesystem::path& file, float* rgba);

}  // namespace tessera::io
