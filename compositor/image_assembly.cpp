// SPDX-License-Identifier: BSD-3-Clause
#include "compositor/image_assembly.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <numeric>
#include <utility>

#include "exchange/packed_pixels.hpp"

namespace tessera::compositor {
namespace {

constexpr std::size_t message_bytes = 128 << 10;

exchange::MessageReader tiles_of(const exchange::Message& message) {
  exchange::MessageReader reader(message.bytes, message.from);
  static_cast<void>(reader.take<std::uint64_t>());  // the frame
  return reader;
}

/// Reads a tile's deep samples, if it has any, and adds them to `to` unless `to` is null.
void take_deep(exchange::RecordReader& reader, const scene::PixelRect& rect, DeepCollector* to) {
  const auto count = reader.take<std::uint64_t>();
  if (count == 0) return;
  std::vector<std::uint32_t> counts;
  std::vector<scene::DeepImageSample> samples;
  reader.take_onto(counts, static_cast<std::uint64_t>(rect.area()));
  reader.take_onto(samples, count);
  if (std::accumulate(counts.begin(), counts.end(), std::uint64_t{0}) != count)
    reader.refuse("has a count of deep samples that does not match its data");
  if (to != nullptr) to->add(rect, std::move(counts), std::move(samples));
}

void clear(scene::Image& image, const scene::PixelRect& rect) {
  const auto width = static_cast<std::size_t>(rect.width());
  for (int y = rect.y0; y < rect.y1; ++y) {
    const std::size_t at = image.index(rect.x0, y);
    std::fill_n(&image.rgba[4 * at], 4 * width, 0.0f);
    std::fill_n(&image.depth[at], width, std::numeric_limits<float>::infinity());
  }
}

}  // namespace

TileSender::TileSender(exchange::Transport& transport, int assembler, std::uint32_t frame)
    : transport_(transport), assembler_(assembler), frame_(frame) {}

void TileSender::send(std::uint32_t tile, const MergedTile& merged) {
  const scene::ImageSize size = merged.image.size;
  const std::uint64_t number = tile;
  exchange::Bytes record(sizeof number + merged.pixels.size());
  std::memcpy(record.data(), &number, sizeof number);
  std::copy(merged.pixels.begin(), merged.pixels.end(), record.begin() + sizeof number);
  if (merged.pixels.empty())
    exchange::append_pixels(record, merged.image, {0, 0, size.width, size.height}, assembler_ != transport_.rank());
  exchange::append(record, std::uint64_t{merged.deep_samples.size()});
  if (!merged.deep_samples.empty()) {
    exchange::append_values(record, merged.deep_counts);
    exchange::append_values(record, merged.deep_samples);
  }
  const std::lock_guard lock(mutex_);
  if (message_.empty()) {
    message_ = exchange::begin_message(exchange::MessageKind::tiles, message_bytes + (32 << 10));
    exchange::append(message_, std::uint64_t{frame_});
  }
  exchange::append_values(message_, record);
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

ImageAssembly::ImageAssembly(int compositors, AssemblySettings settings)
    : compositors_(compositors), settings_(std::move(settings)) {}

ImageAssembly::~ImageAssembly() {
  std::unique_lock lock(mutex_);
  for (const auto& [number, frame] : frames_) changed_.wait(lock, [&of = frame] { return of.working == 0; });
}

std::optional<AssembledFrame> ImageAssembly::accept(exchange::Message message) {
  exchange::MessageReader reader(message.bytes, message.from);
  const exchange::MessageKind kind = reader.kind();
  if (kind != exchange::MessageKind::end && kind != exchange::MessageKind::tiles) reader.refuse_kind();
  const auto number = static_cast<std::uint32_t>(reader.take<std::uint64_t>());
  Frame& frame = frame_of(number);
  if (kind == exchange::MessageKind::tiles) {
    start(frame, [this, &frame, number, tiles = std::make_shared<const exchange::Message>(std::move(message))] {
      place(frame, number, *tiles);
    });
    return std::nullopt;
  }
  frame.sums = sum(frame.sums, reader.take<exchange::FrameEnd>());
  reader.finish();
  if (++frame.ended < compositors_) return std::nullopt;
  wait_for(frame);
  fill_what_lacks(frame, number);
  AssembledFrame assembled{number, std::move(frame.image), frame.sums, {}};
  if (frame.deep != nullptr) assembled.deep = frame.deep->image();
  frames_.erase(number);
  return assembled;
}

ImageAssembly::Frame& ImageAssembly::frame_of(std::uint32_t number) {
  const auto found = frames_.find(number);
  if (found != frames_.end()) return found->second;
  Frame& frame = frames_.try_emplace(number, settings_.grid_of(number)).first->second;
  const scene::ImageSize size = frame.grid.image;
  if (settings_.memory) frame.image = settings_.memory(size);
  if (frame.image.size.width != size.width || frame.image.size.height != size.height) frame.image = scene::Image(size);
  if (settings_.deep_bytes > 0) frame.deep = std::make_unique<DeepCollector>(size, settings_.deep_bytes);
  return frame;
}

void ImageAssembly::start(Frame& frame, std::function<void()> work) {
  {
    const std::lock_guard lock(mutex_);
    ++frame.working;
  }
  std::function<void()> whole = [this, &frame, work = std::move(work)] {
    std::exception_ptr fault;
    try {
      work();
    } catch (...) {
      fault = std::current_exception();
    }
    {
      const std::lock_guard lock(mutex_);
      if (fault && !fault_) fault_ = fault;
      --frame.working;
      changed_.notify_all();  // under the lock: once the lock is released, this object may be destroyed
    }
    if (fault) std::rethrow_exception(fault);
  };
  settings_.run ? settings_.run(std::move(whole)) : whole();
}

void ImageAssembly::place(Frame& frame, std::uint32_t number, const exchange::Message& message) {
  const scene::TraceScope timing(settings_.trace, "assemble", static_cast<std::int32_t>(number), message.bytes.size(),
                                 1, message.from);
  exchange::MessageReader reader = tiles_of(message);
  while (!reader.empty()) {
    const auto tile = reader.take<std::uint64_t>();
    if (tile >= frame.grid.count()) reader.refuse(fmt::format("brings tile {} of {}", tile, frame.grid.count()));
    if (frame.has_come[tile].exchange(true)) reader.refuse(fmt::format("sends tile {} again", tile));
    const scene::PixelRect rect = frame.grid.rect(tile);
    exchange::take_pixels(reader, frame.image, rect);
    take_deep(reader, rect, frame.deep.get());
    if (settings_.finished) settings_.finished(number, rect, frame.image);
  }
}

void ImageAssembly::wait_for(const Frame& frame) {
  std::unique_lock lock(mutex_);
  if (frame.working > 0) {
    const scene::TraceScope timing(settings_.trace, "wait");
    changed_.wait(lock, [&] { return frame.working == 0; });
  }
  if (fault_) std::rethrow_exception(fault_);
}

void ImageAssembly::fill_what_lacks(Frame& frame, std::uint32_t number) {
  constexpr std::size_t tiles_at_once = 64;
  for (std::size_t tile = 0; tile < frame.has_come.size(); ++tile)
    if (!frame.has_come[tile]) frame.lacking.push_back(frame.grid.rect(tile));
  for (std::size_t first = 0; first < frame.lacking.size(); first += tiles_at_once)
    start(frame, [this, &frame, first, number] {
      const scene::TraceScope timing(settings_.trace, "assemble", static_cast<std::int32_t>(number));
      const std::size_t end = std::min(first + tiles_at_once, frame.lacking.size());
      for (std::size_t k = first; k < end; ++k) clear(frame.image, frame.lacking[k]);
    });
  wait_for(frame);
  if (!settings_.finished || frame.sums.stopped > 0) return;
  for (const scene::PixelRect& rect : frame.lacking) settings_.finished(number, rect, frame.image);
}

}  // namespace tessera::compositor
