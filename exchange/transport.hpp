// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "scene/error.hpp"
#include "scene/trace.hpp"

namespace tessera::exchange {

class Bells;

/// The subject of a message. Each channel is a separate queue, so that a receiver only gets messages of its own
/// channel.
enum class Channel : std::uint8_t {
  agreement,  ///< collective exchange of small facts that all ranks share
  mesh,       ///< parts of a mesh between readers and projectors; ranges of a volume's cells between all ranks
  fragments,  ///< from projector to compositor: ray segments or runs of tiles
  credit,     ///< from compositor to projector: permission to send more bytes
  tiles,      ///< from compositors to the first compositor: finished tiles
  frames,     ///< from the first compositor to projectors: a frame has been assembled
  timing,     ///< spans, sent to the rank that writes the trace
  stop,       ///< from any rank to all: the run is to end early
};
inline constexpr std::size_t channel_count = 8;

using Bytes = std::vector<std::byte>;

struct Message {
  int from;
  Bytes bytes;
};

/// Communication between ranks. All data between processes pass through this interface. One implementation uses MPI; in
/// another, ranks are threads of one process.
///
/// Messages between two ranks on one channel arrive in the order in which they were sent; a rank may send to itself.
/// All member functions may be called from any thread. A message is at most 2^30 bytes.
///
/// Errors: the first rank that calls fail(), or is found lost, ends the run for all. From then on, send() does nothing
/// and receive() throws this one error, with the same code and message on every rank.
class Transport {
 public:
  virtual ~Transport() = default;

  [[nodiscard]] virtual int rank() const = 0;
  [[nodiscard]] virtual int size() const = 0;

  /// Takes the message and returns at once. A sender that must not run ahead of its receiver uses credit (outbox.hpp).
  /// `frame` is the frame number in the trace; -1: none.
  virtual void send(int to, Channel channel, Bytes bytes, std::int32_t frame) = 0;
  void send(int to, Channel channel, Bytes bytes) { send(to, channel, std::move(bytes), -1); }

  /// Returns the next message of the channel, from any rank. Sleeps until a message arrives; returns nothing if
  /// `timeout` passes first. Throws the run's error if there is one.
  virtual std::optional<Message> receive(Channel channel, std::chrono::milliseconds timeout) = 0;
  Message receive(Channel channel) {
    for (;;)
      if (auto message = receive(channel, std::chrono::milliseconds(1000))) return std::move(*message);
  }

  /// Ends the run for all ranks with this error, unless another came first.
  virtual void fail(const scene::Error& error) = 0;

  /// Throws the run's error if there is one. Meant for long loops that neither send nor receive.
  virtual void check() const = 0;

  /// Sets whether this rank's cores have other work than messages now. If so, the rank checks for messages less often.
  /// Initially false.
  virtual void set_working(bool /*working*/) {}

  /// From now on, ranks of this machine wake each other by these bells; null: without bells. Collective.
  virtual void use_bells(const std::shared_ptr<Bells>& /*bells*/) {}

  /// Sets where spans of `send` are recorded from now on: for fragments and meshes in `projecting`, for tiles in
  /// `compositing`. Null: nowhere. Both must outlive the transport, or be replaced before their lifetimes end.
  virtual void trace_to(scene::Trace* projecting, scene::Trace* compositing) = 0;

  /// Assigns numbers to `count` more frames and returns the first number. Messages and traces use these numbers, which
  /// are the same on all ranks. Sessions that share a transport, one after the other, never reuse numbers. Must not be
  /// called while a frame is in progress.
  std::uint32_t number_frames(std::size_t count) {
    return std::exchange(frames_, frames_ + static_cast<std::uint32_t>(count));
  }

  /// Bytes and messages sent so far on a channel, except those of a rank to itself.
  struct Traffic {
    std::uint64_t bytes = 0, messages = 0;
  };
  [[nodiscard]] virtual Traffic sent(Channel channel) const = 0;

 private:
  std::uint32_t frames_ = 0;
};

}  // namespace tessera::exchange
