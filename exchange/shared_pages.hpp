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

/// Returns a text that identifies the machine. It is the same for processes that can open each other's files by process
/// number and descriptor. These processes have the same boot of the same machine, process namespace, user, and network
/// namespace (processes with separate networks are meant to act as separate machines). Empty: unknown.
std::string machine();

/// Pages shared by several processes, or mapped twice by one process. On Linux, they are a file in memory without a
/// name.
class SharedPages {
 public:
  /// Creates new pages, filled with zeros and not yet mapped. Throws Error(system_failure) if there is not enough
  /// memory.
  static SharedPages made(std::size_t bytes);
  /// Opens the pages that process `process` made and whose descriptor in that process is `descriptor`; empty if this
  /// process has no access to them.
  static std::optional<SharedPages> opened(std::uint64_t process, int descriptor, std::size_t bytes);
  SharedPages(SharedPages&& other) noexcept;
  SharedPages& operator=(SharedPages&& other) noexcept;
  ~SharedPages();

  /// Allocates memory for the bytes [first, last). Without this call, memory is allocated when the bytes are first
  /// written; if memory runs out, the system then ends the process. Returns whether the allocation succeeded.
  bool reserve(std::size_t first, std::size_t last) const;
  /// Maps the pages. Returns false if this process has no address space for them.
  bool map();
  /// The `descriptor` argument for opened(). The pages exist as long as any process maps them.
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

/// Bytes of memory that the machine can still provide; the largest number if unknown. Callers must not allocate more
/// than this: the system would not refuse the allocation, but end processes until the memory is available.
std::uint64_t available_memory();

/// Returns the error which reports that the system cannot provide these pages.
scene::Error no_shared_memory(std::size_t bytes);

/// Pages that ranks of one machine share, mapped.
struct PagesOfMachine {
  std::vector<int> ranks;  ///< the ranks that share them, ascending
  SharedPages pages;
};

/// Makes pages for the ranks of this rank's machine for which `joins` is true. Empty if there are no others, if they
/// cannot share memory, or if `joins` is false. The lowest of these ranks allocates `bytes_for(ranks)` bytes and calls
/// `fill` with them before any other rank opens the pages. Collective over all ranks.
std::optional<PagesOfMachine> share_pages(Transport& transport, bool joins,
                                          const std::function<std::size_t(std::size_t ranks)>& bytes_for,
                                          const std::function<void(std::byte* pages, std::size_t ranks)>& fill);
/// Offset of the memory that is passed to `fill`. The bytes before it contain the key by which ranks recognize these
/// pages.
inline constexpr std::size_t shared_data_offset = 64;
inline std::byte* shared_data(const SharedPages& pages) { return pages.data() + shared_data_offset; }

/// Sleeps until the word, which is in shared memory, differs from `seen`, but at most for `most`; may return earlier.
void wait_for_change(std::atomic<std::uint32_t>& word, std::uint32_t seen, std::chrono::microseconds most);
/// Changes the word and wakes all threads, in any process, that wait for a change of this word.
void change(std::atomic<std::uint32_t>& word);

}  // namespace tessera::exchange
