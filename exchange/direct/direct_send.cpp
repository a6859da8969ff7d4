// SPDX-License-Identifier: BSD-3-Clause
#include "exchange/direct/direct_send.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <utility>

#include "exchange/message.hpp"
#include "exchange/packed_pixels.hpp"

namespace tessera::exchange {

PixelRect band_of(const PixelRect& area, int number, int ranks) {
  const auto row = [&](int n) {
    return area.y0 + static_cast<int>(static_cast<std::int64_t>(std::max(0, area.height())) * n / ranks);
  };
  return {area.x0, row(number), area.x1, row(number + 1)};
}

std::vector<int> band_numbers(std::span<const PixelRect> own) {
  std::vector<int> ranks(own.size()), numbers(own.size());
  std::iota(ranks.begin(), ranks.end(), 0);
  std::ranges::stable_sort(ranks, {}, [&](int rank) {
    const PixelRect& r = own[static_cast<std::size_t>(rank)];
    return std::int64_t{r.y0} + r.y1;
  });
  for (std::size_t n = 0; n < ranks.size(); ++n) numbers[static_cast<std::size_t>(ranks[n])] = static_cast<int>(n);
  return numbers;
}

std::vector<int> send_order(std::span<const int> order, std::size_t place) {
  std::vector<int> ranks(order.begin() + static_cast<std::ptrdiff_t>(place) + 1, order.end());
  for (std::size_t p = place; p > 0; --p) ranks.push_back(order[p - 1]);
  return ranks;
}

std::vector<Layer> receive_order(std::span<const int> order, std::size_t place) {
  std::vector<Layer> layers;
  for (std::size_t p = place; p > 0; --p) layers.push_back({order[p - 1], true});
  for (std::size_t p = place + 1; p < order.size(); ++p) layers.push_back({order[p], false});
  return layers;
}

namespace {

/// Header of a packet, which precedes its pixels.
struct PacketHeader {
  std::uint64_t frame;
  PixelRect rows;         ///< the rows of the receiver's band that the packet covers
  PixelRect rect;         ///< the part of these rows where the sender may have pixels
  std::uint64_t stopped;  ///< 1: no pixels follow
};
static_assert(sizeof(PacketHeader) == 8 + 2 * 16 + 8);

bool same(const PixelRect& a, const PixelRect& b) {
  return a.x0 == b.x0 && a.y0 == b.y0 && a.x1 == b.x1 && a.y1 == b.y1;
}

std::vector<PixelRect> packets_of(const PixelRect& band) {
  std::vector<PixelRect> packets;
  for (int y = band.y0; y < band.y1 && band.x0 < band.x1; y += packet_rows)
    packets.push_back({band.x0, y, band.x1, std::min(y + packet_rows, band.y1)});
  return packets;
}

/// Composites `front` over `back` and stores the result in `back`.
void put_in_front(const float* front, float front_depth, float* back, float& back_depth) {
  const float through = 1 - front[3];
  for (int c = 0; c < 4; ++c) back[c] = front[c] + through * back[c];
  if (std::isfinite(front_depth)) back_depth = front_depth;
}

/// Composites `front` over `back` and stores the result in `front`.
void put_behind(const float* back, float back_depth, float* front, float& front_depth) {
  const float through = 1 - front[3];
  for (int c = 0; c < 4; ++c) front[c] += through * back[c];
  if (!std::isfinite(front_depth)) front_depth = back_depth;
}

/// One frame's exchange on one rank.
class Exchange {
 public:
  Exchange(Transport& transport, std::vector<Message>& early, const DirectSendTask& task, scene::Image& image,
           std::span<float> error_bounds)
      : transport_(transport),
        early_(early),
        task_(task),
        image_(image),
        error_bounds_(error_bounds),
        place_(static_cast<std::size_t>(std::find(task.order.begin(), task.order.end(), transport.rank()) -
                                        task.order.begin())),
        layers_(receive_order(task.order, place_)),
        packets_(packets_of(band(transport.rank()))) {
    result_.stopped = task.stopped;
    came_.resize(static_cast<std::size_t>(transport.size()));
    for (Message& message : std::exchange(early_, {})) take(std::move(message));
  }

  DirectSendResult asynchronous() {
    for (const int to : send_order(task_.order, place_))
      for (const PixelRect& rows : packets_of(band(to))) {
        send(to, rows);
        while (auto message = transport_.receive(Channel::fragments, std::chrono::milliseconds(0)))
          take(std::move(*message));
        composite();
      }
    while (next_layer_ < layers_.size() && !packets_.empty()) {
      await();
      composite();
    }
    return result_;
  }

  DirectSendResult synchronous() {
    const int ranks = transport_.size(), rank = transport_.rank();
    for (int step = 1; step < ranks; ++step) {
      const int to = (rank + step) % ranks, from = (rank + ranks - step) % ranks;
      for (const PixelRect& rows : packets_of(band(to))) send(to, rows);
      // Waits only for this rank's messages; other messages that arrive early are kept.
      while (came_[static_cast<std::size_t>(from)].size() < packets_.size()) await();
    }
    composite();
    return result_;
  }

 private:
  [[nodiscard]] PixelRect band(int rank) const {
    return band_of(task_.area, task_.bands[static_cast<std::size_t>(rank)], transport_.size());
  }

  void send(int to, const PixelRect& rows) {
    const scene::TraceScope timing(task_.trace, "pack", static_cast<std::int32_t>(task_.frame));
    const PacketHeader header{task_.frame, rows, scene::common(rows, task_.own), task_.stopped ? 1u : 0u};
    Bytes bytes = message_of(MessageKind::packet, header);
    if (!task_.stopped && !header.rect.empty()) {
      append_pixels(bytes, image_, header.rect, true);
      const PixelRect& r = header.rect;
      for (int y = r.y0; y < r.y1 && !error_bounds_.empty(); ++y)
        append_values(bytes, error_bounds_.subspan(image_.index(r.x0, y), static_cast<std::size_t>(r.width())));
    }
    result_.bytes += bytes.size(), ++result_.messages;
    transport_.send(to, Channel::fragments, std::move(bytes), static_cast<std::int32_t>(task_.frame));
  }

  void await() {
    const scene::TraceScope timing(task_.trace, "wait", static_cast<std::int32_t>(task_.frame));
    take(transport_.receive(Channel::fragments));
  }

  void take(Message message) {
    const auto frame = MessageReader(message, MessageKind::packet).take<PacketHeader>().frame;
    if (frame > task_.frame)
      early_.push_back(std::move(message));
    else
      came_.at(static_cast<std::size_t>(message.from)).push_back(std::move(message));
  }

  /// Composites all packets that have arrived and are next in order.
  void composite() {
    for (; next_layer_ < layers_.size(); ++next_layer_, next_packet_ = 0) {
      auto& came = came_[static_cast<std::size_t>(layers_[next_layer_].rank)];
      for (; next_packet_ < packets_.size() && next_packet_ < came.size(); ++next_packet_) {
        const scene::TraceScope timing(task_.trace, "composite", static_cast<std::int32_t>(task_.frame));
        composite(std::exchange(came[next_packet_], {}), packets_[next_packet_], layers_[next_layer_].in_front);
      }
      if (next_packet_ < packets_.size()) return;
    }
  }

  void composite(const Message& message, const PixelRect& rows, bool in_front) {
    MessageReader reader(message, MessageKind::packet);
    const auto header = reader.take<PacketHeader>();
    const PixelRect& r = header.rect;
    if (header.frame != task_.frame || !same(header.rows, rows) || r.x0 < rows.x0 || r.y0 < rows.y0 || r.x1 > rows.x1 ||
        r.y1 > rows.y1 || r.x0 > r.x1 || r.y0 > r.y1)
      reader.refuse("is a packet of another image");
    if (header.stopped != 0) result_.stopped = true;
    if (header.stopped != 0 || r.empty()) return reader.finish();
    if (scratch_.size.width != r.width() || scratch_.size.height != r.height())
      scratch_ = scene::Image({r.width(), r.height()});
    take_pixels(reader, scratch_, {0, 0, r.width(), r.height()});
    for (int y = r.y0; y < r.y1; ++y) {
      const std::size_t to = image_.index(r.x0, y), from = scratch_.index(0, y - r.y0);
      for (std::size_t x = 0; x < static_cast<std::size_t>(r.width()); ++x)
        (in_front ? put_in_front : put_behind)(&scratch_.rgba[4 * (from + x)], scratch_.depth[from + x],
                                               &image_.rgba[4 * (to + x)], image_.depth[to + x]);
    }
    for (int y = r.y0; y < r.y1 && !error_bounds_.empty(); ++y) {
      bounds_.resize(static_cast<std::size_t>(r.width()));
      reader.take_values(std::span(bounds_));
      for (std::size_t x = 0; x < bounds_.size(); ++x) error_bounds_[image_.index(r.x0, y) + x] += bounds_[x];
    }
    reader.finish();
  }

  Transport& transport_;
  std::vector<Message>& early_;
  const DirectSendTask& task_;
  scene::Image& image_;
  std::span<float> error_bounds_;
  std::size_t place_;
  std::vector<Layer> layers_;
  std::vector<PixelRect> packets_;  ///< rows of each packet of this rank's band
  /// One list per sender, in the order of sending; a message is empty once it is composited.
  std::vector<std::vector<Message>> came_;
  std::size_t next_layer_ = 0, next_packet_ = 0;
  scene::Image scratch_;
  std::vector<float> bounds_;
  DirectSendResult result_;
};

}  // namespace

DirectSendResult DirectSender::run(DirectSend how, const DirectSendTask& task, scene::Image& image,
                                   std::span<float> error_bounds) {
  Exchange exchange(transport_, early_, task, image, error_bounds);
  return how == DirectSend::synchronous ? exchange.synchronous() : exchange.asynchronous();
}

}  // namespace tessera::exchange
