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

/// Writes a run's images to their destinations: separate files, films, standard output.
class PictureWriter {
 public:
  explicit PictureWriter(const RenderOptions& options) : options_(options) {}

  /// For use before rendering: throws Error(bad_input) if these frames cannot be made into a film.
  static void check(const RenderOptions& options, std::span<const FilmFrame> frames);

  /// Writes a frame to its planned outputs. To be called for the frames in their order. Deep images are written from
  /// `deep`. Throws Error(system_failure) if an image can no longer be written, although check_film_outputs() found
  /// that it could.
  void write(const Image& image, const DeepImage& deep, const FilmFrame& frame);
  /// Writes an additional image to a separate file. Throws the same errors as write().
  static void write_file(const Image& image, const std::filesystem::path& file, const ImageFileOptions& options);
  /// To be called after the last frame: makes the films appear.
  void finish();

 private:
  const RenderOptions& options_;
  std::vector<std::unique_ptr<FilmFile>> films_;
};

}  // namespace tessera::apps
