// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "io/files/input_file.hpp"
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
  InflatedFile(const InputFile& file, Holds holds);
  /// Its first bytes alone: no more are inflated.
  InflatedFile(const InputFile& file, std::uint64_t first);

  /// Calls `work` with the content, under a path that this process and its helper can open while this lives, and
  /// returns what it returns. In the lines of its errors that path is replaced by the gzip file's. It has no extension.
  template <class Work>
  auto read(const Work& work) const {
    try {
      return work(content_);
    } catch (const scene::Error& error) {
      throw renamed(error);
    }
  }

  /// The line with the gzip file's name in place of the content's path, for notes.
  [[nodiscard]] std::string renamed(std::string line) const;

 private:
  InflatedFile(const InputFile& file, const system::InflateLimit& limit);

  [[nodiscard]] scene::Error renamed(const scene::Error& error) const;

  InputFile content_;
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
