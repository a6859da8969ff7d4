// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "tessera/deep_image.hpp"
#include "tessera/film_file.hpp"
#include "tessera/image.hpp"
#include "tessera/program/film.hpp"
#include "tessera/program/render_options.hpp"

namespace tessera::apps {

/// The destinations of a run's images: separate files, films, standard output.
class PictureWriter {
 public:
  explicit PictureWriter(const RenderOptions& options) : options_(options) {}

  /// For use before rendering: throws Error(bad_input) if these frames cannot be made into a film.
  static void check(const RenderOptions& options, std::span<const FilmFrame> frames);

  /// Writes the planned outputs of frames in their order, which come first. Deep images are written from `deep`. Throws
  /// Error(system_failure) if an image can no longer be written, although check_film_outputs() found that it could.
  void write(const Image& image, const DeepImage& deep, const FilmFrame& frame);
  /// Writes an additional image to its own file. Throws as write().
  static void write_file(const Image& image, const std::filesystem::path& file, const ImageFileOptions& options);
  /// Call after the last frame: the films appear.
  void finish();

 private:
  const RenderOptions& options_;
  std::vector<std::unique_ptr<FilmFile>> films_;
};

}  // namespace tessera::apps
