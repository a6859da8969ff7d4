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
  ImageFileOptions image;         ///< only background and encode_srgb are used; films have 8 bits and no alpha
  double frames_per_second = 25;  ///< least_film_rate to most_film_rate
};

/// Frame rates that ffmpeg and video players accept.
inline constexpr double least_film_rate = 0.01, most_film_rate = 1000;

/// Whether a file of this name is written as a film: .mp4 .mov .mkv .webm or .gif, upper or lower case.
TESSERA_EXPORT bool is_film_name(const std::filesystem::path& file);

/// For use before rendering: throws Error(bad_input) unless the name is that of a film, the program `ffmpeg` is on PATH
/// and the file can be created.
TESSERA_EXPORT void check_film_file(const std::filesystem::path& file);

/// A film that the program `ffmpeg` encodes from a sequence of images: H.264 (.mp4 .mov .mkv), VP9 (.webm), or a .gif
/// of 256 colours. Without a background the images are on black. The encoders require even numbers of pixels: an odd
/// side gets one more line, in the colour of the background. commit() makes the complete file appear. Without commit()
/// no file appears, even if the process is killed.
class TESSERA_EXPORT FilmFile {
 public:
  /// Starts ffmpeg. `size` is the size of every image. Throws the same errors as check_film_file(), and
  /// Error(system_failure) if ffmpeg does not start.
  FilmFile(std::filesystem::path file, ImageSize size, const FilmFileOptions& options);
  ~FilmFile();
  FilmFile(const FilmFile&) = delete;
  FilmFile& operator=(const FilmFile&) = delete;

  /// Appends an image. Throws Error(bad_input) for an image of another size; Error(system_failure), with the last line
  /// of ffmpeg's output, if ffmpeg has ended; and the errors of write_image() for values that are not finite.
  void add(const Image& image);
  /// Completes the film and makes the file appear. Throws Error(system_failure) if ffmpeg has failed.
  void commit();
  /// Completes the film and returns its contents; no file appears. Used instead of commit(). Throws
  /// Error(system_failure) if ffmpeg has failed.
  std::string take();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace v0_1
}  // namespace tessera
