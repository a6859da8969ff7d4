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

/// Where the pictures of a run go: files of their own, films, standard output.
class PictureWriter {
 public:
  explicit PictureWriter(const RenderOptions& options) : options_(options) {}

  /// Before any rendering: throws Error(bad_input) if a film cannot be made of these frames.
  static void check(const RenderOptions& options, std::span<const FilmFrame> frames);

  /// Of frames in their order, the outputs that were planned, which come first. Deep pictures are written from `deep`.
  /// Throws Error(system_failure) if a picture cannot
  /// be written any more, as check_film_outputs() found it could.
  void write(const Image& image, const DeepImage& deep, const FilmFrame& frame);
  /// One more picture into a file of its own. Throws as write().
  static void write_file(const Image& image, const std::filesystem::path& file, const ImageFileOptions& options);
  /// After the last frame: films appear.
  void finish();

 private:
  const RenderOptions& options_;
  std::vector<std::unique_ptr<FilmFile>> films_;
};

}  // namespace tessera::apps
