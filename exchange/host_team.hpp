// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "exchange/shared_pages.hpp"
#include "exchange/transport.hpp"
#include "scene/team.hpp"

namespace tessera::exchange {

/// Ranks of one machine that make frames together. The team's members wait for each other in shared memory, and find
/// the run's error, another's death included, through the transport; ranks of other machines take no part.
///
/// An epoch is a frame, or whatever else they do together: all members begin the same ones in the same order. Who
/// leaves one early says so; who waits for it in that epoch then throws FrameStopped.
class HostTeam final : public scene::Team {
 public:
  /// The team of this rank and the others of its machine that join; null if there are none, they may not see each
  /// other's memory, or this rank does not join. Collective over all ranks. `transport` must outlive the team.
  static std::unique_ptr<HostTeam> form(Transport& transport, bool joins);
  ~HostTeam() override;
  HostTeam(const HostTeam&) = delete;
  HostTeam& operator=(const HostTeam&) = delete;

  [[nodiscard]] int rank() const override { return rank_; }
  [[nodiscard]] int size() const override { return static_cast<int>(ranks_.size()); }
  /// The transport's ranks of the members.
  [[nodiscard]] const std::vector<int>& ranks() const { return ranks_; }

  /// Begins the next epoch, once all members are through with the last. Throws the run's error.
  void begin();
  /// This member will not go on with the epoch.
  void leave();

  void barrier() override;
  std::vector<std::uint64_t> gather(std::uint64_t word) override;
  std::uint32_t draw(std::uint32_t count) override;
  std::byte* memory(Room room, std::size_t bytes) override;

 private:
  struct Control;
  HostTeam(Transport& transport, std::vector<int> ranks, SharedPages control);
  [[nodiscard]] Control& control() const;
  void arrive(bool may_stop);

  Transport& transport_;
  std::vector<int> ranks_;
  int rank_;
  SharedPages control_;
  std::uint64_t epoch_ = 0, step_ = 0;
  std::array<std::optional<SharedPages>, room_count> rooms_;
};

}  // namespace tessera::exchange
