// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exchange/transport.hpp"
#include "scene/image.hpp"
#include "scene/pixel_rect.hpp"
#include "tessera/settings.hpp"

/// Direct-send compositing (Moloney, "Ray Coherence in Parallel Volume Rendering", SFU 2008, 5.2.2 and A.5): every rank
/// has a picture of its part of a volume, and gets of all the others the pixels of one band of rows, which it
/// composites by the depth order of the parts. Any number of ranks.
namespace tessera::exchange {

/// Rows of a packet: enough for packed_pixels.hpp to foretell most of them, few enough for several a rank.
inline constexpr int packet_rows = 64;

/// The bands of `area` that ranks composite, one each, counted from the top: the same number of rows, so far as that
/// goes.
PixelRect band_of(const PixelRect& area, int number, int ranks);

/// The number of each rank's band, by where ranks may have pixels: higher up for who has them higher up, so that much
/// of what a rank has stays with it (docs/RESULTS.md, Exchanges).
std::vector<int> band_numbers(std::span<const PixelRect> own);

/// Whom the rank at `place` of a depth order (ranks, front to back) sends to, in this order: those behind it from the
/// nearest on, then those in front from the nearest on.
std::vector<int> send_order(std::span<const int> order, std::size_t place);

/// A rank whose pixels are composited, and on which side of what there is.
struct Layer {
  int rank;
  bool in_front;
};
/// Whose pixels the rank at `place` composites onto its own, in this order: those in front of it from the nearest on,
/// then those behind from the nearest on. So all are neighbours of what there is, and bits do not depend on what comes
/// first. (Algorithm 1 begins with those in front and puts the rank's own behind them; our own are at hand at once.)
std::vector<Layer> receive_order(std::span<const int> order, std::size_t place);

struct DirectSendTask {
  std::span<const int> order;  ///< all ranks, front to back
  std::span<const int> bands;  ///< of each rank, its band's number; the same on all
  PixelRect area{};            ///< pixels that any of them may have; the same on all
  PixelRect own{};             ///< pixels that this one may have, within `area`; the others are empty
  std::uint64_t frame = 0;
  bool stopped = false;  ///< this rank's picture lacks pixels: its packets say so and hold none
  scene::Trace* trace = nullptr;
};

struct DirectSendResult {
  bool stopped = false;                   ///< some pixels of the band are missing
  std::uint64_t bytes = 0, messages = 0;  ///< that this rank sent to others
};

/// A rank's part in the exchanges of many frames.
///
///   asynchronous  packets of `packet_rows` rows go out one by one, and what has come meanwhile is composited: a band
///                 is done soon after its last packet came
///   synchronous   rank p gives rank p + 1 all of its band and waits for its own from rank p - 1, then p + 2 and p - 2,
///                 and so on, and composites when it has them all
class DirectSender {
 public:
  /// `transport` must outlive it.
  explicit DirectSender(Transport& transport) : transport_(transport) {}

  /// Replaces this rank's band of its picture by all ranks' pixels there, composited; of the others' bands nothing
  /// changes. `error_bounds`, if not empty, are added up likewise (by pixel, as volume::Renderer::render() gives them);
  /// all ranks have them or none. Collective, one call a frame, frames in order; ranks may be frames ahead. Channel
  /// `fragments`. Throws what the transport throws, and Error(system_failure) for messages that are not of these
  /// exchanges.
  DirectSendResult run(DirectSend how, const DirectSendTask& task, scene::Image& image, std::span<float> error_bounds);

 private:
  Transport& transport_;
  std::vector<Message> early_;  ///< of later frames, in the order in which they came
};

}  // namespace tessera::exchange
