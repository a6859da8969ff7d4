#pragma once

#include <vector>

#include "compositor/transport.hpp"

namespace tessera::compositor {

/// Some ranks of a job as a job of their own: rank k of the group is ranks[k] of the whole. For collectives of a few,
/// such as the projectors' reading of the next mesh while compositors are at work.
///
/// Channels are the whole's: while the group talks on one, no rank outside of it may send there to a member. sent()
/// counts for the whole.
class GroupTransport final : public Transport {
 public:
  /// The rank itself has to be one of `ranks`; `whole` must outlive the group.
  GroupTransport(Transport& whole, std::vector<int> ranks);

  [[nodiscard]] int rank() const override { return rank_; }
  [[nodiscard]] int size() const override { return static_cast<int>(ranks_.size()); }
  using Transport::send;
  void send(int to, Channel channel, Bytes bytes, std::int32_t frame) override;
  using Transport::receive;
  std::optional<Message> receive(Channel channel, std::chrono::milliseconds timeout) override;
  void fail(const scene::Error& error) override { whole_.fail(error); }
  void check() const override { whole_.check(); }
  void trace_to(scene::Trace* projecting, scene::Trace* compositing) override {
    whole_.trace_to(projecting, compositing);
  }
  [[nodiscard]] Traffic sent(Channel channel) const override { return whole_.sent(channel); }

 private:
  [[nodiscard]] int member(int rank_of_whole) const;

  Transport& whole_;
  std::vector<int> ranks_;
  int rank_;
};

}  // namespace tessera::compositor
