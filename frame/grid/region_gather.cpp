// SPDX-License-Identifier: BSD-3-Clause
#include "frame/grid/region_gather.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "exchange/message.hpp"
#include "exchange/packed_pixels.hpp"

namespace tessera::frame {
namespace {

using exchange::MessageReader;
using scene::PixelRect;

/// Divides a rectangle into strips of a few rows, which limits how many pixels are packed at once.
std::vector<PixelRect> strips_of(const PixelRect& rect) {
  constexpr int rows = 64;
  std::vector<PixelRect> strips;
  for (int y = rect.y0; y < rect.y1 && rect.x0 < rect.x1; y += rows)
    strips.push_back({rect.x0, y, rect.x1, std::min(y + rows, rect.y1)});
  return strips;
}

void note(const RegionHeader& header, int rank, FinishedVolumeFrame& finished) {
  const auto r = static_cast<std::size_t>(rank);
  finished.regions[r] = header.region;
  finished.ranks[r] = header.counters;
  finished.cpu_seconds[r] = header.cpu_seconds;
  finished.split_cpu_seconds[r] = header.split_cpu_seconds;
}

}  // namespace

void report_region(scene::FrameWatch& watch, const PixelRect& rect, FinishedVolumeFrame& finished) {
  if (finished.stopped || watch.stopped() || rect.empty()) return;
  try {
    watch.finished(rect, finished.image);
  } catch (const scene::FrameStopped&) {
    finished.stopped = true;
  }
}

void send_region(exchange::Transport& transport, const VolumePart& part) {
  const RegionHeader& header = part.header;
  const scene::Image& image = part.finished.image;
  exchange::Bytes bytes = exchange::message_of(exchange::MessageKind::region, header);
  exchange::append_list(bytes, part.rectangles);
  for (const PixelRect& r : part.rectangles) {
    if (header.stopped != 0) break;
    for (const PixelRect& strip : strips_of(r)) exchange::append_pixels(bytes, image, strip, true);
    const std::span bounds(part.finished.error_bounds);
    for (int y = r.y0; y < r.y1 && !bounds.empty(); ++y)
      exchange::append_values(bytes, bounds.subspan(image.index(r.x0, y), static_cast<std::size_t>(r.width())));
  }
  transport.send(0, exchange::Channel::tiles, std::move(bytes), static_cast<std::int32_t>(header.frame));
}

FinishedVolumeFrame RegionGather::gather(VolumePart own, scene::FrameWatch& watch) {
  FinishedVolumeFrame finished = std::move(own.finished);
  const auto ranks = static_cast<std::size_t>(transport_.size());
  finished.regions.resize(ranks), finished.ranks.resize(ranks);
  finished.cpu_seconds.resize(ranks), finished.split_cpu_seconds.resize(ranks);
  finished.stopped = own.header.stopped != 0;
  note(own.header, transport_.rank(), finished);
  for (int others = transport_.size() - 1; others > 0; --others) {
    const exchange::Message message = next(own.header.frame);
    const scene::TraceScope timing(trace_, "assemble", static_cast<std::int32_t>(own.header.frame),
                                   message.bytes.size(), 1);
    place(message, own.header.frame, finished, watch);
  }
  return finished;
}

exchange::Message RegionGather::next(std::uint64_t frame) {
  const scene::TraceScope timing(trace_, "wait", static_cast<std::int32_t>(frame));
  for (;;) {
    if (const auto early = early_.find(frame); early != early_.end()) {
      exchange::Message message = std::move(early->second.back());
      early->second.pop_back();
      if (early->second.empty()) early_.erase(early);
      return message;
    }
    exchange::Message message = transport_.receive(exchange::Channel::tiles);
    const auto of = MessageReader(message, exchange::MessageKind::region).take<RegionHeader>().frame;
    if (of == frame) return message;
    early_[of].push_back(std::move(message));
  }
}

void RegionGather::place(const exchange::Message& message, std::uint64_t frame, FinishedVolumeFrame& finished,
                         scene::FrameWatch& watch) const {
  MessageReader reader(message, exchange::MessageKind::region);
  const auto header = reader.take<RegionHeader>();
  const auto rectangles = reader.take_list<PixelRect>();
  const scene::ImageSize size = finished.image.size;
  for (const PixelRect& r : rectangles)
    if (header.frame != frame || r.x0 < 0 || r.y0 < 0 || r.x1 > size.width || r.y1 > size.height || r.x0 > r.x1 ||
        r.y0 > r.y1)
      reader.refuse("is a rectangle of another image");
  finished.stopped = finished.stopped || header.stopped != 0;
  for (const PixelRect& r : rectangles) {
    if (header.stopped != 0) break;
    for (const PixelRect& strip : strips_of(r)) exchange::take_pixels(reader, finished.image, strip);
    for (int y = r.y0; y < r.y1 && !finished.error_bounds.empty(); ++y)
      reader.take_values(
          std::span(finished.error_bounds).subspan(finished.image.index(r.x0, y), static_cast<std::size_t>(r.width())));
  }
  reader.finish();
  for (const PixelRect& r : rectangles)
    if (header.stopped == 0) report_region(watch, r, finished);
  finished.statistics += header.counters;
  note(header, message.from, finished);
}

}  // namespace tessera::frame
