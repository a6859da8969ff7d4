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
/// Error(bad_input, "FILE: ...") for a stream that is damaged, empty, or far larger than the compressed size explains,
/// and Error(system_failure) if the content needs more memory than the machine has free.
class InflatedFile {
 public:
  /// Largest allowed ratio of content to gzip file, in addition to 64 MiB. Meshes and surfaces reach 3 to 30; grids
  /// with few distinct values, such as masks, reach hundreds.
  enum class Holds : std::uint16_t { mesh = 128, grid = 512 };
  InflatedFile(const InputFile& file, Holds holds);
  /// Inflates only the first `first` bytes of the content.
  InflatedFile(const InputFile& file, std::uint64_t first);

  /// Calls `work` with the content and returns the result of `work`. The content has a path without an extension, which
  /// this process and its helper can open during the lifetime of this object. In error messages, the path of the gzip
  /// file replaces that path.
  template <class Work>
  auto read(const Work& work) const {
    try {
      return work(content_);
    } catch (const scene::Error& error) {
      throw renamed(error);
    }
  }

  /// Returns `line`, for example a note, with the path of the content replaced by the gzip file's name.
  [[nodiscard]] std::string renamed(std::string line) const;

 private:
  InflatedFile(const InputFile& file, const system::InflateLimit& limit);

  [[nodiscard]] scene::Error renamed(const scene::Error& error) const;

  InputFile content_;
  system::Descriptor descriptor_;
};

/// Whether `file` is a name that InflatedFile created. A file with this kind of name has no neighbours in a directory.
bool is_inflated(const std::filesystem::path& file);

/// Returns the size in bytes of the gzip file whose content has the name `inflated`.
std::uint64_t packed_size(const std::filesystem::path& inflated);

/// Throws Error(bad_input) if `file` is the content of a gzip file. Called for HDF5 files, because the HDF5 library
/// opens files only by their real names.
void require_real_name(const std::filesystem::path& file);

/// Throws Error(bad_input) if `file` is the content of a gzip file. Called for files that refer to other files in their
/// directory.
void require_uncompressed(const std::filesystem::path& file);

}  // namespace tessera::io
