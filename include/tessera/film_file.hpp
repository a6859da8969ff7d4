// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "tessera/export.hpp"
#include "tessera/image.hpp"
#include "tessera/image_file_options.hpp"

namespace tessera {
inline namespace v0_1 {

struct FilmFileOptions {
  ImageFileOptions image;         ///< background and encode_srgb count: films have 8 bits and no alpha
  double frames_per_second = 25;  ///< least_film_rate to most_film_rate
};

/// What ffmpeg and players of films take.
inline constexpr double least_film_rate = 0.01, most_film_rate = 1000;

/// Whether a film is written by this name: .mp4 .mov .mkv .webm or .gif, upper or lower case.
TESSERA_EXPORT bool is_film_name(const std::filesystem::path& file);

/// Before any rendering: throws Error(bad_input) unless the name is a film's, the program `ffmpeg` is on PATH and the
/// file could be created now.
TESSERA_EXPORT void check_film_file(const std::filesystem::path& file);

/// A film that the program `ffmpeg` writes from pictures, one after the other: H.264 (.mp4 .mov .mkv), VP9 (.webm), or
/// a .gif of 256 colours. Without a background the pictures stand on black. Sides are made even, as these encoders need
/// them, by a line more of that ground. It appears whole, by commit(), or not at all, even where the process is killed.
class TESSERA_EXPORT FilmFile {
 public:
  /// Starts ffmpeg. `size` is every picture's. Throws as check_film_file(), Error(system_failure) if it does not start.
  FilmFile(std::filesystem::path file, ImageSize size, const FilmFileOptions& options);
  ~FilmFile();
  FilmFile(const FilmFile&) = delete;
  FilmFile& operator=(const FilmFile&) = delete;

  /// Throws Error(bad_input) for a picture of another size, Error(system_failure) with ffmpeg's own last line if it has
  /// ended, and as write_image() for what is no number.
  void add(const Image& image);
  /// Throws Error(system_failure) as add().
  void commit();
  /// In place of commit(): the film itself. No file appears. Throws Error(system_failure) as add().
  std::string take();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace v0_1
}  // namespace tessera
