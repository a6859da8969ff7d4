// SPDX-License-Identifier: BSD-3-Clause
#include "apps/render/frame_writer.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "tessera/image_file.hpp"
#include "tessera/statistics.hpp"

namespace tessera::apps {
namespace {

/// Number of threads that write the frames of a film. It is zero if images are so large that memory should not contain
/// two of them. One thread compresses a PNG in about the time in which ten threads render it. Films and annotations are
/// written in order, by one thread.
int writers(const RenderOptions& options, const std::vector<FilmFrame>& frames) {
  constexpr std::int64_t most_pixels = 4096 * 4096;
  constexpr int renderers_a_writer = 8;
  std::size_t left = 0;
  std::int64_t pixels = 1;
  for (const FilmFrame& frame : frames)
    if (!frame.finished) {
      ++left;
      pixels = std::max(pixels, std::int64_t{frame.size.width} * frame.size.height);
    }
  if (left < 2 || pixels > most_pixels) return 0;
  if (options.annotation.annotation || !options.films.empty() || options.to_standard_output) return 1;
  const auto wanted =
      std::min<std::int64_t>(threads_for(options.settings.threads) / renderers_a_writer, most_pixels / pixels);
  return static_cast<int>(std::max<std::int64_t>(wanted, 1));
}

}  // namespace

FrameWriter::FrameWriter(const RenderOptions& options, const std::vector<FilmFrame>& frames, const FilmTraces& traces,
                         bool writes)
    : options_(options),
      traces_(traces),
      writes_(writes),
      files_(options),
      queue_(writes ? writers(options, frames) : 0) {}

void FrameWriter::add(FinishedFrame frame) {
  queue_.add([this, frame = std::move(frame)] { write(frame); });
}

std::shared_ptr<const RenderedFrame> FrameWriter::reusing(RenderedFrame&& rendered) {
  return {new RenderedFrame(std::move(rendered)), [this](RenderedFrame* written) {
            spare_images_.keep(std::move(written->image));
            delete written;
          }};
}

void FrameWriter::finish() {
  if (writes_) queue_.add([this] { files_.finish(); });
  queue_.finish();
}

void FrameWriter::write(const FinishedFrame& frame) {
  const RenderedFrame& rendered = *frame.rendered;
  {
    const TraceScope scope(traces_.writing(), "write", frame.number);
    if (frame.balance)
      write_balance(*frame.balance, rendered.deep, frame.annotated.frame);
    else
      write_annotated(rendered.image, rendered.deep, frame.annotated, files_);
    write_layers(rendered, frame.annotated.frame);
  }
  if (frame.began_us) traces_.writing()->add_frame(frame.number, *frame.began_us);
}

/// The first half of the frame's outputs receives the image of the bricks, the second half that of their cost. Films
/// and standard output receive the bricks.
void FrameWriter::write_balance(const BalancePictures& shown, const DeepImage& deep, const FilmFrame& frame) {
  FilmFrame of_bricks = frame;
  of_bricks.outputs.resize(frame.outputs.size() / 2);
  files_.write(shown.bricks, deep, of_bricks);
  for (std::size_t i = of_bricks.outputs.size(); i < frame.outputs.size(); ++i)
    PictureWriter::write_file(shown.cost, frame.outputs[i], options_.image);
}

/// Layers are written without a background.
void FrameWriter::write_layers(const RenderedFrame& rendered, const FilmFrame& frame) {
  if (!options_.frame.peel) return;
  ImageFileOptions transparent = options_.image;
  transparent.background.reset();
  const std::size_t named = options_.plan.outputs.size();
  std::size_t next = named;
  for (std::size_t i = 0; i < named; ++i) {
    if (is_deep_name(frame.outputs[i])) continue;
    for (const Image& layer : rendered.layers) PictureWriter::write_file(layer, frame.outputs[next++], transparent);
  }
}

}  // namespace tessera::apps
