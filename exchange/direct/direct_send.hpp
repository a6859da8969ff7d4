// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exchange/transport.hpp"
#include "scene/image.hpp"
#include "scene/pixel_rect.hpp"
#include "tessera/settings.hpp"

/// Direct-send compositing (Moloney, "Ray Coherence in Parallel Volume Rendering", SFU 2008, 5.2.2 and A.5). Every rank
/// has an image of its part of a volume. Each rank receives the pixels of one band of rows from all other ranks, and
/// composites them in the depth order of the parts. Works for any number of ranks.
namespace tessera::exchange {

/// Number of rows in a packet: large enough that packed_pixels.hpp predicts most rows, small enough for several packets
/// per rank.
inline constexpr int packet_rows = 64;

/// Returns band `number` of `area`, counted from the top. Every rank composites one band; the numbers of rows of the
/// bands differ by at most one.
PixelRect band_of(const PixelRect& area, int number, int ranks);

/// Returns the number of each rank's band. `own` contains the pixels that each rank may have. A rank whose pixels are
/// higher up in the image gets a higher band, so that many of its pixels stay on the rank (docs/RESULTS.md, Exchanges).
std::vector<int> band_numbers(std::span<const PixelRect> own);

/// Returns the ranks to which a rank sends, in the order of sending. `order` contains all ranks, front to back; the
/// sender is at position `place`. It sends first to the ranks behind it, then to those in front of it, in both cases
/// beginning with the nearest.
std::vector<int> send_order(std::span<const int> order, std::size_t place);

/// A rank whose pixels are composited, and whether they go in front of or behind the pixels composited so far.
struct Layer {
  int rank;
  bool in_front;
};
/// Returns the ranks whose pixels the rank at position `place` composites with its own pixels, in the order of
/// compositing: first the ranks in front of it, then those behind it, in both cases beginning with the nearest. So each
/// rank is adjacent in depth to the pixels composited so far, and the bits of the image do not depend on the order of
/// arrival. (Algorithm 1 of the thesis begins with the ranks in front and puts the rank's own pixels behind them; here,
/// the rank's own pixels come first because they are available at once.)
std::vector<Layer> receive_order(std::span<const int> order, std::size_t place);

struct DirectSendTask {
  std::span<const int> order;  ///< all ranks, front to back
  std::span<const int> bands;  ///< the band number of each rank; the same on all ranks
  PixelRect area{};            ///< pixels that any rank may have; the same on all ranks
  PixelRect own{};             ///< pixels that this rank may have, within `area`; all others are empty
  std::uint64_t frame = 0;
  bool stopped = false;  ///< this rank's image is incomplete: its packets report this and contain no pixels
  scene::Trace* trace = nullptr;
};

struct DirectSendResult {
  bool stopped = false;                   ///< some pixels of the band are missing
  std::uint64_t bytes = 0, messages = 0;  ///< what this rank has sent to other ranks
};

/// One rank's part in the exchanges of many frames.
///
///   asynchronous  packets of `packet_rows` rows are sent one by one, and packets that have arrived meanwhile are
///                 composited: a band is complete soon after its last packet has arrived
///   synchronous   in step k = 1, 2, ..., rank p sends to rank p + k all pixels of that rank's band, and waits for the
///                 pixels for its band from rank p - k; after the last step, it composites all of them
class DirectSender {
 public:
  /// `transport` must outlive this object.
  explicit DirectSender(Transport& transport) : transport_(transport) {}

  /// Replaces this rank's band of its image by the composited pixels of all ranks; the rest of the image is unchanged.
  /// `error_bounds`, if not empty, are summed in the same way (one value per pixel, as returned by
  /// volume::Renderer::render()); either all ranks or no ranks pass them. Collective, once per frame, with ascending
  /// frame numbers; ranks may be several frames ahead of others. Uses channel `fragments`. Throws the errors of the
  /// transport, and Error(system_failure) for messages that do not belong to these exchanges.
  DirectSendResult run(DirectSend how, const DirectSendTask& task, scene::Image& image, std::span<float> error_bounds);

 private:
  Transport& transport_;
  std::vector<Message> early_;  ///< messages of later frames, in the order of arrival
};

}  // namespace tessera::exchange
