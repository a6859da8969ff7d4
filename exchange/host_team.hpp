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

/// Ranks of one machine that render frames together. Members wait for each other in shared memory. They get the run's
/// error, for example the death of another rank, from the transport. Ranks of other machines are not members.
///
/// An epoch is a frame or another joint task; all members begin the same epochs in the same order. A member that leaves
/// an epoch early calls leave(); members that wait for this member during the epoch then throw FrameStopped.
class HostTeam final : public scene::Team {
 public:
  /// Returns the team of this rank and the other ranks of its machine for which `joins` is true. Null if there are no
  /// others, if they cannot share memory, or if `joins` is false. Collective over all ranks. `transport` must outlive
  /// the team.
  static std::unique_ptr<HostTeam> form(Transport& transport, bool joins);
  ~HostTeam() override;
  HostTeam(const HostTeam&) = delete;
  HostTeam& operator=(const HostTeam&) = delete;

  [[nodiscard]] int rank() const override { return rank_; }
  [[nodiscard]] int size() const override { return static_cast<int>(ranks_.size()); }
  /// The members' ranks in the transport.
  [[nodiscard]] const std::vector<int>& ranks() const { return ranks_; }

  /// Begins the next epoch once all members have finished the last one. Throws the run's error.
  void begin();
  /// Declares that this member does not continue the epoch.
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
