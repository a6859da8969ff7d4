#include "compositor/image_assembly.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <utility>

namespace tessera::compositor {
namespace {

constexpr std::size_t message_bytes = 512 << 10;

scene::Error malformed(int from) {
  return {scene::ErrorCode::system_failure,
          fmt::format("assembly: rank {} sent malformed tiles; run one version of the program on all machines", from)};
}

/// A tile's deep samples, if it has any.
void take_deep(exchange::RecordReader& reader, const scene::PixelRect& rect, DeepCollector* to) {
  const auto count = reader.take<std::uint64_t>();
  if (count == 0) return;
  std::vector<std::uint32_t> counts(static_cast<std::size_t>(rect.area()));
  std::vector<scene::DeepImageSample> samples(count);
  const auto fill = [&](auto& values) {
    const auto bytes = std::as_writable_bytes(std::span(values));
    std::ranges::copy(reader.take_bytes(bytes.size()), bytes.begin());
  };
  fill(counts);
  fill(samples);
  if (to != nullptr) to->add(rect, std::move(counts), std::move(samples));
}

}  // namespace

TileSender::TileSender(exchange::Transport& transport, int assembler, std::uint32_t frame)
    : transport_(transport), assembler_(assembler), frame_(frame) {}

void TileSender::send(std::uint32_t tile, const MergedTile& merged) {
  const std::lock_guard lock(mutex_);
  if (message_.empty()) {
    message_.reserve(message_bytes + (64 << 10));  // and the tile that goes beyond
    message_.resize(sizeof(TilesHeader));          // flush() fills it in
  }
  exchange::append(message_, std::uint64_t{tile});
  const auto append_all = [&](const auto& values) {
    const auto bytes = std::as_bytes(std::span(values));
    message_.insert(message_.end(), bytes.begin(), bytes.end());
  };
  append_all(merged.image.rgba);
  append_all(merged.image.depth);
  exchange::append(message_, std::uint64_t{merged.deep_samples.size()});
  if (!merged.deep_samples.empty()) {
    append_all(merged.deep_counts);
    append_all(merged.deep_samples);
  }
  ++tiles_;
  if (message_.size() >= message_bytes) flush();
}

void TileSender::flush() {
  if (tiles_ == 0) return;
  const TilesHeader header{.frame = frame_, .tiles = std::exchange(tiles_, 0)};
  std::memcpy(message_.data(), &header, sizeof header);
  transport_.send(assembler_, exchange::Channel::tiles, std::exchange(message_, {}), static_cast<std::int32_t>(frame_));
}

void TileSender::end(const exchange::FrameEnd& sums) {
  const std::lock_guard lock(mutex_);
  flush();
  exchange::Bytes message;
  exchange::append(message, TilesHeader{.ends = 1, .frame = frame_});
  exchange::append(message, sums);
  transport_.send(assembler_, exchange::Channel::tiles, std::move(message), static_cast<std::int32_t>(frame_));
}

ImageAssembly::ImageAssembly(int compositors, std::function<projection::TileGrid(std::uint32_t)> grid_of,
                             std::uint64_t deep_bytes, Finished finished)
    : compositors_(compositors),
      grid_of_(std::move(grid_of)),
      deep_bytes_(deep_bytes),
      finished_(std::move(finished)) {}

std::optional<AssembledFrame> ImageAssembly::accept(const exchange::Message& message, int self) {
  exchange::RecordReader reader(message.bytes);
  const auto header = reader.take<TilesHeader>();
  if (header.magic != exchange::wire_magic || header.version != exchange::wire_version)
    throw scene::Error(scene::ErrorCode::system_failure,
                       fmt::format("assembly: rank {} speaks another wire version than rank {}, {}; run one version of "
                                   "the program on all machines",
                                   message.from, self, exchange::wire_version));
  auto [at, is_new] = frames_.try_emplace(header.frame);
  Frame& frame = at->second;
  if (is_new) {
    frame.grid = grid_of_(header.frame);
    frame.image = scene::Image(frame.grid.image);
    if (finished_) frame.has_come.resize(frame.grid.count());
    if (deep_bytes_ > 0) frame.deep = std::make_unique<DeepCollector>(frame.grid.image, deep_bytes_);
  }
  for (std::uint32_t i = 0; i < header.tiles; ++i) {
    const auto tile = reader.take<std::uint64_t>();
    if (tile >= frame.grid.count()) throw malformed(message.from);
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
    finished_(header.frame, rect, frame.image);
  }
  if (header.ends == 0) return std::nullopt;
  frame.sums = sum(frame.sums, reader.take<exchange::FrameEnd>());
  if (++frame.ended < compositors_) return std::nullopt;
  for (std::size_t tile = 0; tile < frame.has_come.size() && frame.sums.stopped == 0; ++tile)
    if (!frame.has_come[tile]) finished_(header.frame, frame.grid.rect(tile), frame.image);
  AssembledFrame assembled{header.frame, std::move(frame.image), frame.sums, {}};
  if (frame.deep != nullptr) assembled.deep = frame.deep->image();
  frames_.erase(at);
  return assembled;
}

}  // namespace tessera::compositor
