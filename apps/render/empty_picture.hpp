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

/// Correct images that show nothing: the reason, and options that show something.
namespace tessera::apps {

/// The largest alpha and light of an image's pixels.
struct MostOfPixels {
  float alpha = 0, light = 0;
  /// Whether no pixel differs from the background, with 8 bits per channel.
  [[nodiscard]] bool shows_nothing() const { return alpha < 0.5f / 255 && light < 0.5f / 255 / 12.92f; }
};
/// The maximum over an image; if it shows something, over the pixels up to the first that does.
MostOfPixels most_of(const Image& image);

/// The reason why an image is empty.
enum class EmptyReason : std::uint8_t {
  none,     ///< it is not empty
  clear,    ///< the transfer function is transparent over all values
  blank,    ///< no voxel has values at all of its corners
  outside,  ///< the view contains no data
  between,  ///< the data in the view are between the centres of pixels
  missed,   ///< rays meet no value that the transfer function shows
  faint,    ///< the data that rays meet are almost transparent
};

/// The reason why an image is empty, from its frame's counters; none if it is not.
EmptyReason reason_of_empty(const RenderedFrame& frame, const Dataset& data, const TransferFunction& function,
                            const RenderOptions& options);

/// A run at its end, on any rank.
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

/// The images of a run that show nothing.
class EmptyPictures {
 public:
  /// Call for each image, on the rank that has the images.
  void examine(std::size_t frame, const RenderedFrame& rendered, const Dataset& data, const TransferFunction& function,
               const RenderOptions& options);
  /// Reports which images are empty, the reason, and options that show something, tried on the named views. Empty if
  /// all images show something, or the transfer function's own warning already reports it. Collective.
  [[nodiscard]] std::string warning(const FinishedRun& run) const;

 private:
  /// The first empty image.
  struct First {
    EmptyReason reason = EmptyReason::none;
    bool is_clear = false;  ///< already determined by the field's range
    std::size_t frame = 0;  ///< index in the run's list
    std::size_t count = 0;  ///< of all empty images
    MostOfPixels most{};
    std::array<double, 2> range{};  ///< of the field in this image
  };
  [[nodiscard]] static std::string advice(const First& first, const FinishedRun& run);
  First first_;
};

}  // namespace tessera::apps
