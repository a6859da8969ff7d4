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
/// has an image of its part of a volume. From all other ranks, it receives the pixels of one band of rows, which it
/// composites by the depth order of the parts. Any number of ranks.
namespace tessera::exchange {

/// Rows of a packet: enough that packed_pixels.hpp predicts most of them, few enough for several packets per rank.
inline constexpr int packet_rows = 64;

/// The bands of `area` that ranks composite, one each, counted from the top: their numbers of rows differ by at most
/// one.
PixelRect band_of(const PixelRect& area, int number, int ranks);

/// The number of each rank's band, by where ranks may have pixels: a rank whose pixels are higher up gets a higher
/// band, so that many of its pixels stay with it (docs/RESULTS.md, Exchanges).
std::vector<int> band_numbers(std::span<const PixelRect> own);

/// The ranks to which the rank at `place` of a depth order (ranks, front to back) sends, in this order: those behind it
/// from the nearest on, then those in front from the nearest on.
std::vector<int> send_order(std::span<const int> order, std::size_t place);

/// A rank whose pixels are composited, and whether they go in front of or behind the pixels composited so far.
struct Layer {
  int rank;
  bool in_front;
};
/// The ranks whose pixels the rank at `place` composites onto its own, in this order: those in front of it from the
/// nearest on, then those behind from the nearest on. So each is adjacent in depth to the pixels composited so far, and
/// bits do not depend on the order of arrival. (Algorithm 1 begins with the front ones and puts the rank's own behind
/// them; here, the rank's own are composited first because they are available at once.)
std::vector<Layer> receive_order(std::span<const int> order, std::size_t place);

struct DirectSendTask {
  std::span<const int> order;  ///< all ranks, front to back
  std::span<const int> bands;  ///< the band number of each rank; the same on all ranks
  PixelRect area{};            ///< pixels that any rank may have; the same on all ranks
  PixelRect own{};             ///< pixels that this rank may have, within `area`; all others are empty
  std::uint64_t frame = 0;
  bool stopped = false;  ///< this rank's image is incomplete: its packets state this and contain no pixels
  scene::Trace* trace = nullptr;
};

struct DirectSendResult {
  bool stopped = false;                   ///< some pixels of the band are missing
  std::uint64_t bytes = 0, messages = 0;  ///< sent by this rank to others
};

/// A rank's part in the exchanges of many frames.
///
///   asynchronous  packets of `packet_rows` rows are sent one by one, and packets that have arrived meanwhile are
///                 composited: a band is complete soon after its last packet has come
///   synchronous   rank p sends rank p + 1 all of its band and waits for its own from rank p - 1, then p + 2 and p - 2,
///                 and so on, and composites when it has all of them
class DirectSender {
 public:
  /// `transport` must outlive it.
  explicit DirectSender(Transport& transport) : transport_(transport) {}

  /// Replaces this rank's band of its image by all ranks' pixels there, composited; the rest of the image is unchanged.
  /// `error_bounds`, if not empty, are summed in the same way (by pixel, as returned by volume::Renderer::render());
  /// either all ranks have them or none. Collective, once per frame, with ascending frame numbers; ranks may be several
  /// frames ahead. Channel `fragments`. Throws the errors of the transport, and Error(system_failure) for messages that
  /// do not belong to these exchanges.
  DirectSendResult run(DirectSend how, const DirectSendTask& task, scene::Image& image, std::span<float> error_bounds);

 private:
  Transport& transport_;
  std::vector<Message> early_;  ///< of later frames, in the order of arrival
};

}  // namespace tessera::exchange
