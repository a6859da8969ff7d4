// SPDX-License-Identifier: BSD-3-Clause
#include "exchange/outbox.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "scene/start_thread.hpp"

namespace tessera::exchange {
namespace {

constexpr std::size_t message_bytes = 256 << 10;

}  // namespace

Outbox::Outbox(Transport& transport, Settings settings) : transport_(transport), settings_(std::move(settings)) {
  for (const int rank : settings_.compositor_ranks) {
    lanes_.emplace_back();
    lanes_.back().rank = rank;
  }
  credit_thread_ = scene::start_thread([this] { take_credit(); });
}

Outbox::~Outbox() {
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
  }
  // A message to this rank wakes the thread at once.
  transport_.send(transport_.rank(), Channel::credit, message_of(MessageKind::credit, std::uint64_t{0}));
  credit_thread_.join();
}

void Outbox::take_credit() {
  try {
    for (;;) {
      const auto message = transport_.receive(Channel::credit, std::chrono::seconds(1));
      const std::lock_guard lock(mutex_);
      if (closing_) return;
      if (!message) continue;
      const auto bytes = value_of<std::uint64_t>(message->bytes, message->from, MessageKind::credit);
      for (Lane& lane : lanes_)
        if (lane.rank == message->from) {
          lane.in_flight -= std::min(bytes, lane.in_flight);
          drain(lane);
        }
      changed_.notify_all();
    }
  } catch (const scene::Error&) {
    changed_.notify_all();  // waiting threads get the run's error from check()
  }
}

void Outbox::begin_frame(std::uint32_t frame, const TileMap& map, const std::vector<bool>& has_parts,
                         const FrameBegin& facts) {
  const std::lock_guard lock(mutex_);
  frame_ = frame;
  map_ = &map;
  fragments_ = bytes_ = messages_ = 0;
  unfinished_.clear();
  for (std::uint32_t tile = 0; tile < has_parts.size(); ++tile)
    if (has_parts[tile]) unfinished_.push_back(tile);
  finished_.assign(has_parts.size(), false);
  for (std::size_t c = 0; c < lanes_.size(); ++c) {
    Lane& lane = lanes_[c];
    const auto& tiles = map.tiles(static_cast<int>(c));
    lane.order.clear();
    Bytes message = frame_message(MessageKind::begin);
    FrameBegin begin = facts;
    begin.tiles = tiles.size();
    append(message, begin);
    Bytes bits((tiles.size() + 7) / 8, std::byte{0});
    for (std::size_t i = 0; i < tiles.size(); ++i)
      if (has_parts[tiles[i]]) {
        bits[i / 8] |= std::byte{1} << (i % 8);
        lane.order.push_back(tiles[i]);
      }
    append_values(message, bits);
    lane.waiting += message.size();
    lane.ready.push_back(std::move(message));
    drain(lane);
  }
}

Bytes Outbox::frame_message(MessageKind kind, std::size_t room) const {
  Bytes message = begin_message(kind, sizeof(std::uint64_t) + room);
  append(message, std::uint64_t{frame_});
  return message;
}

void Outbox::write(Lane& lane, const TilePart& part) {
  const std::size_t before = lane.batch.size();
  if (lane.batch.empty()) {
    lane.batch = frame_message(MessageKind::parts, message_bytes + part.records.size() + sizeof(PartHeader));
  }
  append(lane.batch, PartHeader{part.tile, part.kind,
                                static_cast<std::uint8_t>(part.stopped ? 2
                                                          : part.last  ? 1
                                                                       : 0),
                                part.ascending, part.segments, part.records.size(), part.final_depth, part.fragments});
  append_values(lane.batch, part.records.bytes());
  lane.waiting += lane.batch.size() - before;
  fragments_ += part.fragments;
  if (lane.batch.size() >= message_bytes) seal(lane);
}

void Outbox::seal(Lane& lane) {
  if (lane.batch.empty()) return;
  lane.ready.push_back(std::exchange(lane.batch, {}));
  drain(lane);
}

void Outbox::drain(Lane& lane) {
  while (!lane.ready.empty() && lane.in_flight < settings_.window_bytes) {
    Bytes message = std::move(lane.ready.front());
    lane.ready.pop_front();
    lane.waiting -= message.size();
    lane.in_flight += message.size();
    bytes_ += message.size();
    ++messages_;
    transport_.send(lane.rank, Channel::fragments, std::move(message), static_cast<std::int32_t>(frame_));
  }
}

void Outbox::advance(Lane& lane) {
  while (!lane.order.empty()) {
    const std::uint32_t tile = lane.order.front();
    if (const auto early = early_.find(tile); early != early_.end()) {
      for (const TilePart& part : early->second.parts) {
        early_bytes_ -= part.records.size();
        write(lane, part);
      }
      early_.erase(early);
    }
    if (!finished_[tile]) return;
    lane.order.pop_front();
  }
  seal(lane);  // all tiles for this compositor are complete
}

bool Outbox::must_wait(std::uint32_t tile) const {
  std::uint64_t backlog = early_bytes_;
  for (const Lane& lane : lanes_) backlog += lane.waiting;
  if (backlog <= settings_.backlog_bytes) return false;
  if (unfinished_.empty() || unfinished_.front() < tile) return true;
  // The tile is the first unfinished one, or has just ended: only the compositor of this tile can make put() wait.
  const Lane& lane = lanes_[static_cast<std::size_t>(map_->owner(tile))];
  return lane.waiting > std::max<std::uint64_t>(settings_.window_bytes, message_bytes);
}

void Outbox::accept(TilePart part) {
  const std::uint32_t tile = part.tile;
  Lane& lane = lanes_[static_cast<std::size_t>(map_->owner(tile))];
  if (part.last) {
    finished_[tile] = true;
    while (!unfinished_.empty() && finished_[unfinished_.front()]) unfinished_.pop_front();
  }
  if (lane.order.front() == tile) {
    write(lane, part);
    if (part.last) advance(lane);
  } else {
    early_bytes_ += part.records.size();
    early_[tile].parts.push_back(std::move(part));
  }
}

void Outbox::put(TilePart part) {
  std::unique_lock lock(mutex_);
  const std::uint32_t tile = part.tile;
  accept(std::move(part));
  changed_.notify_all();
  if (!must_wait(tile)) return;
  for (Lane& each : lanes_) seal(each);  // a thread that waits must not keep back what other ranks may wait for
  const scene::TraceScope timing(settings_.trace, "wait", static_cast<std::int32_t>(frame_));
  if (threads_waiting_++ == 0) transport_.set_working(false);
  while (must_wait(tile)) {
    changed_.wait_for(lock, std::chrono::milliseconds(50));
    transport_.check();
  }
  if (--threads_waiting_ == 0) transport_.set_working(true);
}

void Outbox::pass(std::uint32_t tile) {
  TilePart nothing;
  nothing.tile = tile;
  nothing.last = true;
  nothing.final_depth = std::numeric_limits<double>::infinity();
  const std::lock_guard lock(mutex_);
  accept(std::move(nothing));
  changed_.notify_all();
}

void Outbox::flush() {
  const std::lock_guard lock(mutex_);
  for (Lane& each : lanes_) seal(each);
}

void Outbox::end_tiles() {
  for (;;) {
    TilePart last;
    last.last = last.stopped = true;
    last.final_depth = std::numeric_limits<double>::infinity();
    {
      const std::lock_guard lock(mutex_);
      if (unfinished_.empty()) return;
      last.tile = unfinished_.front();
    }
    put(std::move(last));
  }
}

void Outbox::end_frame(FrameEnd sums) {
  std::unique_lock lock(mutex_);
  if (lanes_.empty()) return;
  for (Lane& lane : lanes_) seal(lane);
  FrameEnd traffic{};
  traffic.counters.fragments = fragments_;
  traffic.counters.exchange_bytes = bytes_ + sizeof(MessageHeader) + sizeof(std::uint64_t) + sizeof(FrameEnd);
  traffic.counters.exchange_messages = messages_ + 1;
  for (const Lane& lane : lanes_)
    traffic.counters.exchange_bytes += lane.waiting, traffic.counters.exchange_messages += lane.ready.size();
  Lane& told = lanes_[static_cast<std::size_t>(end_goes_to(settings_.projector, static_cast<int>(lanes_.size())))];
  Bytes message = frame_message(MessageKind::end, sizeof(FrameEnd));
  append(message, sum(sums, traffic));
  told.waiting += message.size();
  told.ready.push_back(std::move(message));
  drain(told);
  // The next frame's tiles must not overtake this frame's. Otherwise put() for the first tile of the next frame would
  // wait for a lane that still has tiles of this frame.
  const scene::TraceScope timing(settings_.trace, "wait", static_cast<std::int32_t>(frame_));
  const auto is_sent = [&] {
    return std::all_of(lanes_.begin(), lanes_.end(), [](const Lane& lane) { return lane.ready.empty(); });
  };
  while (!is_sent()) {
    changed_.wait_for(lock, std::chrono::milliseconds(50));
    transport_.check();
  }
}

}  // namespace tessera::exchange
