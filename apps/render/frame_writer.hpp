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

/// A rendered frame to be written.
struct FinishedFrame {
  std::shared_ptr<const RenderedFrame> rendered;
  AnnotatedFrame annotated;                  ///< a copy, since the run may already be at another step
  std::int32_t number = 0;                   ///< number of the frame, for the trace
  std::optional<BalancePictures> balance{};  ///< with --show balance
  std::optional<double> began_us{};          ///< beginning of the frame's span in the trace, which ends when the frame
                                             ///< is written
};

/// Writes frames with their annotation to files, on its own threads, while the next frames are rendered. Used on the
/// rank that writes; on other ranks it has no threads.
class FrameWriter {
 public:
  /// Makes a writer for the planned `frames`. `options` and `traces` must outlive it.
  FrameWriter(const RenderOptions& options, const std::vector<FilmFrame>& frames, const FilmTraces& traces,
              bool writes);

  /// Adds a frame to be written. If an earlier frame could not be written, throws the exception of that frame.
  void add(FinishedFrame frame);
  /// Takes ownership of a frame. After the frame is written, a later frame reuses the memory of its image.
  std::shared_ptr<const RenderedFrame> reusing(RenderedFrame&& rendered);
  /// Images of earlier frames, whose memory later frames reuse.
  SpareImages& spare_images() { return spare_images_; }
  /// To be called after the last frame: waits until all frames are written, then makes the films appear. Throws the
  /// same errors as add().
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
  PictureQueue queue_;  ///< must be last: its tasks use the members above
};

}  // namespace tessera::apps
