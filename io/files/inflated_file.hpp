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

/// The content of a gzip file, inflated once into an unnamed file in memory, which is released with this object. Throws
/// Error(bad_input, "FILE: ...") for a damaged stream, an empty one, and one that is far larger than its compressed
/// size explains, Error(system_failure) if it needs more memory than the machine has free.
class InflatedFile {
 public:
  /// Largest allowed ratio of content to gzip file, in addition to 64 MiB. Meshes and surfaces reach 3 to 30; grids
  /// with few distinct values, such as masks, reach hundreds.
  enum class Holds : std::uint16_t { mesh = 128, grid = 512 };
  InflatedFile(const InputFile& file, Holds holds);
  /// Inflates only the first `first` bytes.
  InflatedFile(const InputFile& file, std::uint64_t first);

  /// Calls `work` with the content, under a path that this process and its helper can open during the lifetime of this
  /// object, and returns its result. In error messages that path is replaced by the gzip file's. It has no extension.
  template <class Work>
  auto read(const Work& work) const {
    try {
      return work(content_);
    } catch (const scene::Error& error) {
      throw renamed(error);
    }
  }

  /// The line with the path of the content replaced by the gzip file's name, for notes.
  [[nodiscard]] std::string renamed(std::string line) const;

 private:
  InflatedFile(const InputFile& file, const system::InflateLimit& limit);

  [[nodiscard]] scene::Error renamed(const scene::Error& error) const;

  InputFile content_;
  system::Descriptor descriptor_;
};

/// Whether InflatedFile created this name. Such a file has no neighbours in a directory.
bool is_inflated(const std::filesystem::path& file);

/// Size in bytes of the gzip file behind such a name.
std::uint64_t packed_size(const std::filesystem::path& inflated);

/// For HDF5, whose library opens files only by their real names: throws Error(bad_input) for a file that was in a gzip
/// file.
void require_real_name(const std::filesystem::path& file);

/// For files that refer to other files in their directory: throws Error(bad_input) for one that was in a gzip file.
void require_uncompressed(const std::filesystem::path& file);

}  // namespace tessera::io
