// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <string>

#include "scene/sample_source.hpp"
#include "system/positional_file.hpp"

namespace tessera::io {

/// Reads samples from a file, stored in file order (k slowest, i fastest, components interleaved).
///
/// Uses positional reads, not a mapping: pages of mapped files count as this process's memory while they are mapped,
/// and where the system caches a file in pages of 2 MiB, a row of 33 bytes in each of 33 slices maps 66 MiB.
class FileSource final : public scene::SampleSource {
 public:
  /// `first_byte` is the position of the samples in the file, `source` the file's name in messages. Throws
  /// Error(bad_input) unless the file has as many bytes as the grid needs, Error(system_failure) if the file cannot be
  /// opened.
  FileSource(scene::Grid grid, const std::filesystem::path& file, std::uint64_t first_byte, const std::string& source,
             const scene::ComponentChoice& choice, bool swapped);

  [[nodiscard]] std::uint64_t bytes_read() const override { return bytes_read_.load(std::memory_order_relaxed); }

 private:
  void read_samples(const scene::SampleBox& box, const scene::SampleLayout& layout,
                    std::byte* destination) const override;

  system::PositionalFile file_;
  std::uint64_t first_byte_;
  scene::ComponentChoice choice_;
  bool swapped_;
  mutable std::atomic<std::uint64_t> bytes_read_ = 0;
};

}  // namespace tessera::io
