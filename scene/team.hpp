// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tessera::scene {

/// Processes that render one frame together in shared memory, each its share of every pass. All of them call the same
/// functions in the same order, with the same sizes.
class Team {
 public:
  virtual ~Team() = default;

  /// The index of this member, 0 .. size() - 1.
  [[nodiscard]] virtual int rank() const = 0;
  [[nodiscard]] virtual int size() const = 0;

  /// Returns when all members have called it: everything that they wrote to shared memory before is then visible.
  /// Throws FrameStopped once one of them has left the frame, and the run's error once there is one.
  virtual void barrier() = 0;
  /// Every member's number, in the order of members, on every member. Also a barrier.
  virtual std::vector<std::uint64_t> gather(std::uint64_t word) = 0;

  /// Draws the next of the `count` numbers 0, 1, ... that the members share in this epoch; returns `count` if none
  /// remains. A later call with a larger count may return more. Any thread.
  virtual std::uint32_t draw(std::uint32_t count) = 0;

  /// The purposes of shared memory; each has one block.
  enum class Room : std::uint8_t {
    positions,
    tets,
    scalars,
    numbers,
    early_numbers,
    vertices,
    lattice_vertices,
    cull_vertices,
    cells_at_steps,
    tile_counts,
    entries
  };
  static constexpr std::size_t room_count = 11;

  /// At least `bytes` bytes visible to all members. The contents are kept until a call asks for more, or for less than
  /// half; that call is a barrier. Throws Error(system_failure) on all members if the machine does not provide the
  /// memory.
  virtual std::byte* memory(Room room, std::size_t bytes) = 0;
  template <class T>
  T* memory_of(Room room, std::size_t count) {
    return reinterpret_cast<T*>(memory(room, count * sizeof(T)));
  }
};

/// The items [first, last) of a sequence.
struct Share {
  std::size_t first, last;
  [[nodiscard]] std::size_t size() const { return last - first; }
};

/// A member's share of `count` items; all of them without a team.
inline Share share_of(std::size_t count, const Team* team) {
  if (team == nullptr) return {0, count};
  const auto rank = static_cast<std::size_t>(team->rank()), size = static_cast<std::size_t>(team->size());
  return {count * rank / size, count * (rank + 1) / size};
}

/// The smallest of all members' numbers; `number` itself without a team.
inline std::uint64_t least_of(std::uint64_t number, Team* team) {
  if (team == nullptr) return number;
  const std::vector<std::uint64_t> all = team->gather(number);
  return *std::min_element(all.begin(), all.end());
}
inline std::uint64_t largest_of(std::uint64_t number, Team* team) { return ~least_of(~number, team); }
inline double least_of(double number, Team* team) {
  if (team == nullptr) return number;
  for (const std::uint64_t word : team->gather(std::bit_cast<std::uint64_t>(number)))
    number = std::min(number, std::bit_cast<double>(word));
  return number;
}

}  // namespace tessera::scene
