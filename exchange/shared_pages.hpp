// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "exchange/transport.hpp"

/// Memory that ranks of one machine share. Linux alone has it; elsewhere nobody shares any.
namespace tessera::exchange {

/// The same text for processes that can open each other's files by their numbers: of one start of one machine, one
/// space of process numbers, one user and one network (who gives processes networks of their own wants machines).
/// Empty: unknown.
std::string machine();

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

/// Bytes of memory that the machine can still give; the largest number if it does not say. More than that is never
/// asked for: the system would not refuse it, but end processes until it has it.
std::uint64_t available_memory();

/// That the system has no such pages.
scene::Error no_shared_memory(std::size_t bytes);

/// Pages that ranks of one machine have together, mapped.
struct PagesOfMachine {
  std::vector<int> ranks;  ///< who has them, ascending
  SharedPages pages;
};

/// Pages for those ranks of this one's machine that join; none if there are no others, they may not see each other's
/// memory, or this rank does not join. The first of them makes as many bytes as `bytes_for` says for so many ranks, and
/// calls `fill` with them before anybody else sees them. Collective over all ranks.
std::optional<PagesOfMachine> share_pages(Transport& transport, bool joins,
                                          const std::function<std::size_t(std::size_t ranks)>& bytes_for,
                                          const std::function<void(std::byte* pages, std::size_t ranks)>& fill);
/// Where what `fill` made lies: behind what tells these pages from others.
inline constexpr std::size_t shared_data_offset = 64;
inline std::byte* shared_data(const SharedPages& pages) { return pages.data() + shared_data_offset; }

/// Sleeps until the word, in shared memory, is no longer `seen`, or for `most`; may return before.
void wait_for_change(std::atomic<std::uint32_t>& word, std::uint32_t seen, std::chrono::microseconds most);
/// Changes the word and wakes all who wait for that, in any process.
void change(std::atomic<std::uint32_t>& word);

}  // namespace tessera::exchange
