// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tessera::scene {

/// Processes that render one frame together in shared memory. Each process does its share of every pass. All processes
/// call the same functions in the same order, with the same sizes.
class Team {
 public:
  virtual ~Team() = default;

  /// The index of this member, 0 to size() - 1.
  [[nodiscard]] virtual int rank() const = 0;
  [[nodiscard]] virtual int size() const = 0;

  /// Returns when all members have called this function. Everything that they wrote to shared memory before the call is
  /// then visible to all. Throws FrameStopped if a member has left the frame, and the run's error if there is one.
  virtual void barrier() = 0;
  /// Returns, on every member, the numbers of all members in the order of members. Also a barrier.
  virtual std::vector<std::uint64_t> gather(std::uint64_t word) = 0;

  /// Returns the next of the numbers 0 to `count` - 1, or `count` if none remains. All members draw from the same
  /// numbers during an epoch (exchange/host_team.hpp). A later call with a larger `count` may return more numbers. May
  /// be called from any thread.
  virtual std::uint32_t draw(std::uint32_t count) = 0;

  /// The purposes of shared memory. There is one block for each purpose.
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

  /// Returns at least `bytes` bytes that are visible to all members. The contents are kept until a call requests more
  /// bytes, or less than half; that call is a barrier. Throws Error(system_failure) on all members if the machine does
  /// not provide the memory.
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

/// Returns this member's share of `count` items; all items without a team.
inline Share share_of(std::size_t count, const Team* team) {
  if (team == nullptr) return {0, count};
  const auto rank = static_cast<std::size_t>(team->rank()), size = static_cast<std::size_t>(team->size());
  return {count * rank / size, count * (rank + 1) / size};
}

/// Returns the smallest of all members' numbers; without a team, `number`.
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
