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

/// What a message is about. Each channel is a queue of its own, so that the readers of one never see another's.
enum class Channel : std::uint8_t {
  agreement,  ///< facts that all ranks share: small, collective
  mesh,       ///< parts of a mesh between readers and projectors; ranges of a volume's cells between all ranks
  fragments,  ///< projector to compositor: ray segments or runs of tiles
  credit,     ///< compositor to projector: room for more
  tiles,      ///< compositor to the first compositor: finished tiles
  frames,     ///< first compositor to projectors: a frame has left
  timing,     ///< spans to the rank that writes the trace
  stop,       ///< any rank to all: the run is to end early
};
inline constexpr std::size_t channel_count = 8;

using Bytes = std::vector<std::byte>;

struct Message {
  int from;
  Bytes bytes;
};

/// How ranks talk. Everything between processes goes through here; MPI is one implementation, ranks that are threads of
/// one process another.
///
/// Messages between two ranks on one channel arrive in the order they were sent; a rank may send to itself. All member
/// functions may be called from any thread. A message is at most 2^30 bytes.
///
/// Faults: the first rank that calls fail(), or is found lost, ends the run for all. From then on send() does nothing
/// and receive() throws that one error, with the same code and words on every rank.
class Transport {
 public:
  virtual ~Transport() = default;

  [[nodiscard]] virtual int rank() const = 0;
  [[nodiscard]] virtual int size() const = 0;

  /// Hands the message over and returns at once; who must not run ahead of its receiver asks for credit (outbox.hpp).
  /// `frame` is for the trace: -1 for none.
  virtual void send(int to, Channel channel, Bytes bytes, std::int32_t frame) = 0;
  void send(int to, Channel channel, Bytes bytes) { send(to, channel, std::move(bytes), -1); }

  /// The channel's next message, from any rank. Waits for it, without spinning; nothing if `timeout` passes first.
  /// Throws the run's error once there is one.
  virtual std::optional<Message> receive(Channel channel, std::chrono::milliseconds timeout) = 0;
  Message receive(Channel channel) {
    for (;;)
      if (auto message = receive(channel, std::chrono::milliseconds(1000))) return std::move(*message);
  }

  /// Ends the run for all ranks with this error, unless another came first.
  virtual void fail(const scene::Error& error) = 0;

  /// Throws the run's error if there is one: for long loops that neither send nor receive.
  virtual void check() const = 0;

  /// Whether this rank's cores have other work than messages now: then they are looked for less often. Not at first.
  virtual void set_working(bool /*working*/) {}

  /// Ranks of this machine wake each other by these from now on; null: they do not. Collective.
  virtual void use_bells(const std::shared_ptr<Bells>& /*bells*/) {}

  /// Where spans of `send` go from now on: fragments and meshes to the projector's face, tiles to the compositor's.
  /// Null: nowhere. The faces must outlive the transport or be taken back.
  virtual void trace_to(scene::Trace* projecting, scene::Trace* compositing) = 0;

  /// Numbers so many more frames, alike on all ranks: the first one's number, in messages and traces. Sessions that
  /// share a transport, one after the other, never meet each other's numbers. Not while a frame is under way.
  std::uint32_t number_frames(std::size_t count) {
    return std::exchange(frames_, frames_ + static_cast<std::uint32_t>(count));
  }

  /// Bytes and messages sent so far on a channel, not counting those to itself.
  struct Traffic {
    std::uint64_t bytes = 0, messages = 0;
  };
  [[nodiscard]] virtual Traffic sent(Channel channel) const = 0;

 private:
  std::uint32_t frames_ = 0;
};

}  // namespace tessera::exchange
