#include "compositor/image_assembly.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <numeric>
#include <utility>

namespace tessera::compositor {
namespace {

constexpr std::size_t message_bytes = 512 << 10;

/// A tile's deep samples, if it has any.
void take_deep(exchange::RecordReader& reader, const scene::PixelRect& rect, DeepCollector* to) {
  const auto count = reader.take<std::uint64_t>();
  if (count == 0) return;
  std::vector<std::uint32_t> counts;
  std::vector<scene::DeepImageSample> samples;
  reader.take_onto(counts, static_cast<std::uint64_t>(rect.area()));
  reader.take_onto(samples, count);
  if (std::accumulate(counts.begin(), counts.end(), std::uint64_t{0}) != count)
    reader.refuse("has other deep samples than it counts");
  if (to != nullptr) to->add(rect, std::move(counts), std::move(samples));
}

}  // namespace

TileSender::TileSender(exchange::Transport& transport, int assembler, std::uint32_t frame)
    : transport_(transport), assembler_(assembler), frame_(frame) {}

void TileSender::send(std::uint32_t tile, const MergedTile& merged) {
  const std::lock_guard lock(mutex_);
  if (message_.empty()) {
    message_ = exchange::begin_message(exchange::MessageKind::tiles, message_bytes + (64 << 10));
    exchange::append(message_, std::uint64_t{frame_});
  }
  exchange::append(message_, std::uint64_t{tile});
  exchange::append_values(message_, merged.image.rgba);
  exchange::append_values(message_, merged.image.depth);
  exchange::append(message_, std::uint64_t{merged.deep_samples.size()});
  if (!merged.deep_samples.empty()) {
    exchange::append_values(message_, merged.deep_counts);
    exchange::append_values(message_, merged.deep_samples);
  }
  if (message_.size() >= message_bytes) flush();
}

void TileSender::flush() {
  if (message_.empty()) return;
  transport_.send(assembler_, exchange::Channel::tiles, std::exchange(message_, {}), static_cast<std::int32_t>(frame_));
}

void TileSender::end(const exchange::FrameEnd& sums) {
  const std::lock_guard lock(mutex_);
  flush();
  exchange::Bytes message = exchange::begin_message(exchange::MessageKind::end);
  exchange::append(message, std::uint64_t{frame_});
  exchange::append(message, sums);
  transport_.send(assembler_, exchange::Channel::tiles, std::move(message), static_cast<std::int32_t>(frame_));
}

ImageAssembly::ImageAssembly(int compositors, std::function<projection::TileGrid(std::uint32_t)> grid_of,
                             std::uint64_t deep_bytes, Finished finished)
    : compositors_(compositors),
      grid_of_(std::move(grid_of)),
      deep_bytes_(deep_bytes),
      finished_(std::move(finished)) {}

std::optional<AssembledFrame> ImageAssembly::accept(const exchange::Message& message) {
  exchange::MessageReader reader(message.bytes, message.from);
  const bool ends = reader.kind() == exchange::MessageKind::end;
  if (!ends && reader.kind() != exchange::MessageKind::tiles) reader.refuse_kind();
  const auto number = static_cast<std::uint32_t>(reader.take<std::uint64_t>());
  auto [at, is_new] = frames_.try_emplace(number);
  Frame& frame = at->second;
  if (is_new) {
    frame.grid = grid_of_(number);
    frame.image = scene::Image(frame.grid.image);
    if (finished_) frame.has_come.resize(frame.grid.count());
    if (deep_bytes_ > 0) frame.deep = std::make_unique<DeepCollector>(frame.grid.image, deep_bytes_);
  }
  while (!ends && !reader.empty()) {
    const auto tile = reader.take<std::uint64_t>();
    if (tile >= frame.grid.count()) reader.refuse(fmt::format("brings tile {} of {}", tile, frame.grid.count()));
    const scene::PixelRect rect = frame.grid.rect(tile);
    const auto width = static_cast<std::size_t>(rect.x1 - rect.x0);
    const auto area = static_cast<std::size_t>(rect.area());
    const auto rgba = reader.take_bytes(area * 4 * sizeof(float)), depth = reader.take_bytes(area * sizeof(float));
    for (int y = rect.y0; y < rect.y1; ++y) {
      const std::size_t to = frame.image.index(rect.x0, y), from = static_cast<std::size_t>(y - rect.y0) * width;
      std::memcpy(&frame.image.rgba[4 * to], rgba.data() + from * 4 * sizeof(float), width * 4 * sizeof(float));
      std::memcpy(&frame.image.depth[to], depth.data() + from * sizeof(float), width * sizeof(float));
    }
    take_deep(reader, rect, frame.deep.get());
    if (!finished_) continue;
    frame.has_come[tile] = true;
    finished_(number, rect, frame.image);
  }
  if (!ends) return std::nullopt;
  frame.sums = sum(frame.sums, reader.take<exchange::FrameEnd>());
  reader.finish();
  if (++frame.ended < compositors_) return std::nullopt;
  for (std::size_t tile = 0; tile < frame.has_come.size() && frame.sums.stopped == 0; ++tile)
    if (!frame.has_come[tile]) finished_(number, frame.grid.rect(tile), frame.image);
  AssembledFrame assembled{number, std::move(frame.image), frame.sums, {}};
  if (frame.deep != nullptr) assembled.deep = frame.deep->image();
  frames_.erase(at);
  return assembled;
}

}  // namespace tessera::compositor
