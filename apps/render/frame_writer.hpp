// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "apps/render/film_traces.hpp"
#include "apps/render/frame_annotation.hpp"
#include "apps/render/picture_queue.hpp"
#include "apps/render/picture_writer.hpp"
#include "apps/render/spare_images.hpp"
#include "tessera/session.hpp"
#include "tessera/sink.hpp"

namespace tessera::apps {

/// A rendered frame that is to be written.
struct FinishedFrame {
  std::shared_ptr<const RenderedFrame> rendered;
  AnnotatedFrame annotated;                  ///< a copy of what its annotation shows: the run may be at another step
  std::int32_t number = 0;                   ///< of the frame, for the trace
  std::optional<BalancePictures> balance{};  ///< with --show balance
  std::optional<double> began_us{};          ///< when the frame's span in the trace begins; it ends with the writing
};

/// Writes frames to their files, annotated, on its own threads while the next ones are rendered. Used by the one rank
/// that writes; on other ranks it has no threads.
class FrameWriter {
 public:
  /// For the planned `frames`. `options` and `traces` must outlive it.
  FrameWriter(const RenderOptions& options, const std::vector<FilmFrame>& frames, const FilmTraces& traces,
              bool writes);

  /// Throws the exception of writing an earlier frame.
  void add(FinishedFrame frame);
  /// Takes ownership of a frame; once it is written, a later one reuses its image's memory.
  std::shared_ptr<const RenderedFrame> reusing(RenderedFrame&& rendered);
  /// Images of earlier frames, whose memory later ones reuse.
  SpareImages& spare_images() { return spare_images_; }
  /// Call after the last frame: waits until all are written, then the films appear. Throws as add().
  void finish();

 private:
  void write(const FinishedFrame& frame);
  void write_balance(const BalancePictures& shown, const DeepImage& deep, const FilmFrame& frame);
  void write_layers(const RenderedFrame& rendered, const FilmFrame& frame);

  const RenderOptions& options_;
  const FilmTraces& traces_;
  const bool writes_;
  PictureWriter files_;
  SpareImages spare_images_;
  PictureQueue queue_;  ///< last: what it writes refers to the members above
};

}  // namespace tessera::apps
