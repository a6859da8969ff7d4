// SPDX-License-Identifier: BSD-3-Clause
#include "apps/render/picture_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <string_view>

#include "apps/standard_streams.hpp"
#include "tessera/error.hpp"
#include "tessera/image_file.hpp"
#include "tessera/program/output_file.hpp"

namespace tessera::apps {

void PictureWriter::check(const RenderOptions& options, std::span<const FilmFrame> frames) {
  for (const auto& film : options.films) {
    check_film_file(film);
    for (const FilmFrame& frame : frames)
      if (frame.size != frames.front().size)
        throw bad_input(fmt::format(
            "{}: all frames of a film must have one size, but the views have the sizes {}x{} and {}x{}; use --size",
            film.string(), frames.front().size.width, frames.front().size.height, frame.size.width, frame.size.height));
  }
}

void PictureWriter::write(const Image& image, const DeepImage& deep, const FilmFrame& frame) {
  try {
    const std::size_t planned = std::min(frame.outputs.size(), options_.plan.outputs.size());
    for (const auto& output : std::span(frame.outputs).first(planned)) {
      if (is_deep_name(output))
        write_deep_image(deep, output);
      else
        write_image(image, output, options_.image);
    }
    if (films_.empty())
      for (const auto& film : options_.films)
        films_.push_back(
            std::make_unique<FilmFile>(film, image.size, FilmFileOptions{options_.image, options_.frame_rate}));
    for (const auto& film : films_) film->add(image);
  } catch (const OutputFault& fault) {
    throw fault.since_changed();
  }
  if (options_.to_standard_output) {
    const std::vector<std::byte> bytes = png_bytes(image, options_.image);
    write_standard_output({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  }
}

void PictureWriter::write_file(const Image& image, const std::filesystem::path& file, const ImageFileOptions& options) {
  try {
    write_image(image, file, options);
  } catch (const OutputFault& fault) {
    throw fault.since_changed();
  }
}

void PictureWriter::finish() {
  for (const auto& film : films_) film->commit();
  films_.clear();
}

}  // namespace tessera::apps
