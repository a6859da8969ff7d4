// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "scene/image.hpp"
#include "tessera/image_file_options.hpp"

namespace tessera::io {

using tessera::ImageFileOptions;

/// Implements tessera::write_image().
void write_image(const scene::Image& image, const std::filesystem::path& file, const ImageFileOptions& options);

/// Implement tessera::png_bytes(), exr_bytes() and jpeg_bytes().
std::vector<std::byte> checked_png_bytes(const scene::Image& image, const ImageFileOptions& options);
std::vector<std::byte> checked_exr_bytes(const scene::Image& image, const ImageFileOptions& options);
std::vector<std::byte> checked_jpeg_bytes(const scene::Image& image, const ImageFileOptions& options);

/// Implements tessera::read_image().
scene::Image read_image(const std::filesystem::path& file);

/// Throws Error(bad_input) unless write_image supports the extension and could create this file now: the directory
/// exists and is writable, and the name is not that of a directory or device. Should be called before any rendering.
void check_image_path(const std::filesystem::path& file);

}  // namespace tessera::io
