#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "exchange/transport.hpp"
#include "scene/team.hpp"

namespace tessera::exchange {

/// Pages that several processes see, or one process twice. Linux: a file in memory that has no name.
class SharedPages {
 public:
  /// New ones, all zero, not yet mapped. Throws Error(system_failure) if there are none.
  static SharedPages made(std::size_t bytes);
  /// Those that process `process` made and knows as `descriptor`; none if this one may not have them.
  static std::optional<SharedPages> opened(std::uint64_t process, int descriptor, std::size_t bytes);
  SharedPages(SharedPages&& other) noexcept;
  SharedPages& operator=(SharedPages&& other) noexcept;
  ~SharedPages();

  /// Has the system find memory for the bytes [first, last), which it otherwise does when they are written, and ends
  /// the process if there is none. Returns whether it could.
  bool reserve(std::size_t first, std::size_t last) const;
  /// Maps them; false: there is no room in this process.
  bool map();
  /// What opened() needs; the pages last for as long as somebody maps them.
  [[nodiscard]] int descriptor() const { return descriptor_; }
  void close_descriptor();
  [[nodiscard]] std::byte* data() const { return data_; }
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

 private:
  SharedPages(int descriptor, std::size_t bytes) : descriptor_(descriptor), bytes_(bytes) {}
  void release();

  int descriptor_;
  std::size_t bytes_;
  std::byte* data_ = nullptr;
};

/// Ranks of one machine that make frames together, and others' ranks do not see it: the team's members wait for each
/// other in shared memory, and find the run's error, another's death included, through the transport.
///
/// An epoch is a frame, or whatever else they do together: all members begin the same ones in the same order. Who leaves
/// one early says so; who waits for it in that epoch then throws FrameStopped.
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
