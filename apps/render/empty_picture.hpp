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

/// Pictures that are right and show nothing: why, and what shows something.
namespace tessera::apps {

/// The most that a pixel of an image has: of alpha, and of light.
struct MostOfPixels {
  float alpha = 0, light = 0;
  /// Whether no pixel is other than the background, in 8 bits a channel.
  [[nodiscard]] bool shows_nothing() const { return alpha < 0.5f / 255 && light < 0.5f / 255 / 12.92f; }
};
/// All of an image; of one that shows something, up to the first pixel that does.
MostOfPixels most_of(const Image& image);

/// Why.
enum class EmptyReason : std::uint8_t {
  none,     ///< it is not empty
  clear,    ///< the transfer function is clear over all values
  blank,    ///< no voxel has values at all of its corners
  outside,  ///< nothing is in the view
  between,  ///< what is in the view is between the centres of pixels
  missed,   ///< rays meet no value that the transfer function shows
  faint,    ///< what is met is nearly clear
};

/// Why a picture is empty, by what its frame counted; none if it is not.
EmptyReason reason_of_empty(const RenderedFrame& frame, const Dataset& data, const TransferFunction& function,
                            const RenderOptions& options);

/// A run at its end, on any rank.
struct FinishedRun {
  Job& job;
  int writer;  ///< rank that has the pictures
  const std::vector<FilmFrame>& frames;
  std::size_t step;  ///< of the frames, that `data` is
  const RenderOptions& options;
  const Dataset& data;
  const TransferFunction& function;
  Box box;        ///< that views are framed on
  BodyAxes axes;  ///< likewise
};

/// The pictures of a run that show nothing.
class EmptyPictures {
 public:
  /// On the rank that has the pictures: each of them.
  void look_at(std::size_t frame, const RenderedFrame& rendered, const Dataset& data, const TransferFunction& function,
               const RenderOptions& options);
  /// Which pictures are empty, why, and what shows something, tried on the views that it names; nothing if all show
  /// something, or the transfer function's own warning says it. Collective.
  [[nodiscard]] std::string warning(const FinishedRun& run) const;

 private:
  /// The first of them.
  struct First {
    EmptyReason reason = EmptyReason::none;
    bool is_clear = false;  ///< by the field's range alone
    std::size_t frame = 0;  ///< of the run's list
    std::size_t count = 0;  ///< of all that are empty
    MostOfPixels most{};
    std::array<double, 2> range{};  ///< of the field in it
  };
  [[nodiscard]] static std::string advice(const First& first, const FinishedRun& run);
  First first_;
};

}  // namespace tessera::apps
