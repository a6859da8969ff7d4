#include "frame/region_gather.hpp"

#include <algorithm>
#include <ctime>
#include <span>
#include <utility>

#include "exchange/message.hpp"
#include "exchange/packed_pixels.hpp"

namespace tessera::frame {
namespace {

using exchange::MessageReader;
using scene::PixelRect;

/// A rectangle's rows, few at a time: what is packed at once is no larger.
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

void place(const exchange::Message& message, FinishedVolumeFrame& finished, scene::FrameWatch& watch) {
  MessageReader reader(message, exchange::MessageKind::region);
  const auto header = reader.take<RegionHeader>();
  const PixelRect& r = header.region;
  const scene::ImageSize size = finished.image.size;
  if (header.frame != finished.frame || r.x0 < 0 || r.y0 < 0 || r.x1 > size.width || r.y1 > size.height ||
      r.x0 > r.x1 || r.y0 > r.y1)
    reader.refuse("is a rectangle of another picture");
  finished.stopped = finished.stopped || header.stopped != 0;
  if (header.stopped == 0) {
    for (const PixelRect& strip : strips_of(r)) exchange::take_pixels(reader, finished.image, strip);
    for (int y = r.y0; y < r.y1 && !finished.error_bounds.empty(); ++y)
      reader.take_values(
          std::span(finished.error_bounds).subspan(finished.image.index(r.x0, y), static_cast<std::size_t>(r.width())));
  }
  reader.finish();
  if (header.stopped == 0) tell(watch, r, finished);
  finished.statistics += header.counters;
  note(header, message.from, finished);
}

}  // namespace

void tell(scene::FrameWatch& watch, const PixelRect& rect, FinishedVolumeFrame& finished) {
  if (finished.stopped || watch.stopped() || rect.empty()) return;
  try {
    watch.finished(rect, finished.image);
  } catch (const scene::FrameStopped&) {
    finished.stopped = true;
  }
}

double process_cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

void send_region(exchange::Transport& transport, const RegionHeader& header, const scene::Image& image,
                 const std::vector<float>& error_bounds) {
  exchange::Bytes bytes = exchange::message_of(exchange::MessageKind::region, header);
  if (header.stopped == 0) {
    const PixelRect& r = header.region;
    for (const PixelRect& strip : strips_of(r)) exchange::append_pixels(bytes, image, strip, true);
    for (int y = r.y0; y < r.y1 && !error_bounds.empty(); ++y)
      exchange::append_values(
          bytes, std::span(error_bounds).subspan(image.index(r.x0, y), static_cast<std::size_t>(r.width())));
  }
  transport.send(0, exchange::Channel::tiles, std::move(bytes), static_cast<std::int32_t>(header.frame));
}

void gather_regions(exchange::Transport& transport, const RegionHeader& own, FinishedVolumeFrame& finished,
                    scene::FrameWatch& watch, scene::Trace* trace) {
  const auto ranks = static_cast<std::size_t>(transport.size());
  finished.regions.resize(ranks), finished.ranks.resize(ranks);
  finished.cpu_seconds.resize(ranks), finished.split_cpu_seconds.resize(ranks);
  note(own, transport.rank(), finished);
  const auto number = static_cast<std::int32_t>(own.frame);
  for (int others = transport.size() - 1; others > 0; --others) {
    const exchange::Message message = [&] {
      const scene::TraceScope timing(trace, "wait", number);
      return transport.receive(exchange::Channel::tiles);
    }();
    const scene::TraceScope timing(trace, "assemble", number, message.bytes.size(), 1);
    place(message, finished, watch);
  }
}

}  // namespace tessera::frame
