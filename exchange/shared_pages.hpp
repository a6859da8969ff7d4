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

/// Memory that ranks of one machine share. Only on Linux; elsewhere, no ranks share memory.
namespace tessera::exchange {

/// Identifies the machine: the text is the same for processes that can open each other's files by process number and
/// descriptor. They have one boot of one machine, one process namespace, one user, and one network namespace (processes
/// with separate networks are meant to act as separate machines). Empty: unknown.
std::string machine();

/// Pages shared by several processes, or mapped twice by one. Linux: a file in memory without a name.
class SharedPages {
 public:
  /// New pages, all zero, not yet mapped. Throws Error(system_failure) if there is not enough memory.
  static SharedPages made(std::size_t bytes);
  /// The pages that process `process` made and knows as `descriptor`; empty if this process has no access to them.
  static std::optional<SharedPages> opened(std::uint64_t process, int descriptor, std::size_t bytes);
  SharedPages(SharedPages&& other) noexcept;
  SharedPages& operator=(SharedPages&& other) noexcept;
  ~SharedPages();

  /// Allocates memory for the bytes [first, last), which would otherwise happen when they are first written and end the
  /// process if memory runs out. Returns whether it succeeded.
  bool reserve(std::size_t first, std::size_t last) const;
  /// Maps the pages; false: this process has no address space for them.
  bool map();
  /// The argument of opened(). The pages exist as long as any process maps them.
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

/// Bytes of memory that the machine can still provide; the largest number if unknown. Callers never ask for more: the
/// system would not refuse it, but end processes until it is available.
std::uint64_t available_memory();

/// The error that the system cannot provide these pages.
scene::Error no_shared_memory(std::size_t bytes);

/// Pages that ranks of one machine share, mapped.
struct PagesOfMachine {
  std::vector<int> ranks;  ///< the ranks that share them, ascending
  SharedPages pages;
};

/// Pages for the ranks of this rank's machine that join; empty if there are no others, if they cannot share memory, or
/// if this rank does not join. The first of them allocates `bytes_for(ranks)` bytes and calls `fill` with them before
/// any other rank opens them. Collective over all ranks.
std::optional<PagesOfMachine> share_pages(Transport& transport, bool joins,
                                          const std::function<std::size_t(std::size_t ranks)>& bytes_for,
                                          const std::function<void(std::byte* pages, std::size_t ranks)>& fill);
/// Where the memory passed to `fill` begins: behind the key by which ranks recognize these pages.
inline constexpr std::size_t shared_data_offset = 64;
inline std::byte* shared_data(const SharedPages& pages) { return pages.data() + shared_data_offset; }

/// Sleeps until the word, in shared memory, differs from `seen`, or for `most`; may return earlier.
void wait_for_change(std::atomic<std::uint32_t>& word, std::uint32_t seen, std::chrono::microseconds most);
/// Changes the word and wakes all threads that wait for this, in any process.
void change(std::atomic<std::uint32_t>& word);

}  // namespace tessera::exchange
