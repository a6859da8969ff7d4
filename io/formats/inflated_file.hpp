// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "scene/error.hpp"
#include "system/descriptor.hpp"
#include "system/gzip.hpp"

namespace tessera::io {

/// What a gzip file holds, inflated once into a file without a name, in memory, which goes with this object. Throws
/// Error(bad_input, "FILE: ...") for a damaged stream, one that holds nothing and one that holds out of proportion to
/// its size, Error(system_failure) for more than the machine has free.
class InflatedFile {
 public:
  /// How many times the gzip file's size it may hold, beside 64 MiB. Meshes and surfaces take 3 to 30; grids of a few
  /// values, such as masks, hundreds.
  enum class Holds : std::uint16_t { mesh = 128, grid = 512 };
  InflatedFile(const std::filesystem::path& file, Holds holds);
  /// Its first bytes alone: no more are inflated.
  InflatedFile(const std::filesystem::path& file, std::uint64_t first);

  /// Calls `work` with a name that this process and its helper can open while this lives, and returns what it returns.
  /// In the lines of its errors that name is replaced by the gzip file's. The name has no extension: what the content
  /// is has to be told from it, or from inner_name().
  template <class Work>
  auto read(const Work& work) const {
    try {
      return work(path_);
    } catch (const scene::Error& error) {
      throw renamed(error);
    }
  }

  /// The gzip file's name without its .gz, if it has that.
  [[nodiscard]] std::filesystem::path inner_name() const;

  /// The line with the gzip file's name in place of path(), for notes.
  [[nodiscard]] std::string renamed(std::string line) const;

 private:
  InflatedFile(const std::filesystem::path& file, const system::PositionalFile& packed,
               const system::InflateLimit& limit);

  [[nodiscard]] scene::Error renamed(const scene::Error& error) const;

  std::filesystem::path file_, path_;
  system::Descriptor descriptor_;
};

/// Whether a name is one that InflatedFile gave, beside which nothing lies.
bool is_inflated(const std::filesystem::path& file);

/// Bytes of the gzip file that such a name is for.
std::uint64_t packed_size(const std::filesystem::path& inflated);

/// For HDF5, whose library opens files by real names only: throws Error(bad_input) for one that was in a gzip file.
void require_real_name(const std::filesystem::path& file);

/// For files that others lie beside: throws Error(bad_input) for one that was in a gzip file.
void require_beside_others(const std::filesystem::path& file);

}  // namespace tessera::io
