// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tessera/job.hpp"
#include "tessera/program/film.hpp"
#include "tessera/program/render_options.hpp"
#include "tessera/sink.hpp"

/// Detection of correct images that show nothing. Reports the reason, and options with which the image shows something.
namespace tessera::apps {

/// The largest alpha and the largest light of an image's pixels.
struct MostOfPixels {
  float alpha = 0, light = 0;
  /// Whether no pixel differs from the background, with 8 bits per channel.
  [[nodiscard]] bool shows_nothing() const { return alpha < 0.5f / 255 && light < 0.5f / 255 / 12.92f; }
};
/// Returns the maximum over the pixels of an image, up to the first pixel that shows something.
MostOfPixels most_of(const Image& image);

/// The reason why an image is empty.
enum class EmptyReason : std::uint8_t {
  none,     ///< it is not empty
  clear,    ///< the transfer function is transparent over all values
  blank,    ///< every voxel has a blank corner
  outside,  ///< the view contains no data
  between,  ///< the data in the view do not cover the centre of any pixel
  missed,   ///< no ray meets a value that the transfer function shows
  faint,    ///< the data that rays meet are almost transparent
};

/// Returns the reason why an image is empty, according to the frame's counters; none if the image is not empty.
EmptyReason reason_of_empty(const RenderedFrame& frame, const Dataset& data, const TransferFunction& function,
                            const RenderOptions& options);

/// Data of a finished run, on any rank.
struct FinishedRun {
  Job& job;
  int writer;  ///< rank that has the images
  const std::vector<FilmFrame>& frames;
  std::size_t step;  ///< the step of `data`
  const RenderOptions& options;
  const Dataset& data;
  const TransferFunction& function;
  Box box;        ///< for framing views
  BodyAxes axes;  ///< for framing views
};

/// Collects the images of a run that show nothing.
class EmptyPictures {
 public:
  /// To be called for each image, on the rank that has the images.
  void examine(std::size_t frame, const RenderedFrame& rendered, const Dataset& data, const TransferFunction& function,
               const RenderOptions& options);
  /// Returns a warning that states which images are empty, the reason, and options that show something. Options for the
  /// view are tried with the named views. The warning is empty if all images show something, or if a warning about the
  /// transfer function already reports the reason. Collective.
  [[nodiscard]] std::string warning(const FinishedRun& run) const;

 private:
  /// The first empty image.
  struct First {
    EmptyReason reason = EmptyReason::none;
    bool is_clear = false;  ///< whether the function is transparent, as determined from the field's range
    std::size_t frame = 0;  ///< index in the run's list
    std::size_t count = 0;  ///< number of all empty images
    MostOfPixels most{};
    std::array<double, 2> range{};  ///< range of the field in this image
  };
  [[nodiscard]] static std::string advice(const First& first, const FinishedRun& run);
  First first_;
};

}  // namespace tessera::apps
