// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include "io/files/format.hpp"
#include "system/positional_file.hpp"
#include "system/regular_file.hpp"

namespace tessera::io {

/// A file or folder that was opened once and identified (io/formats/identify.hpp). Readers take this, and open the file
/// again only for its data.
struct InputFile {
  static constexpr std::size_t longest_beginning = 1 << 16;

  std::filesystem::path path{};
  std::string name{};       ///< for messages: the path that the user gave, also for content of a gzip file
  std::string beginning{};  ///< its first bytes, unpacked if gzip, at most longest_beginning; empty for a folder
  std::uint64_t size = 0;   ///< as it is stored; of a folder 0
  bool is_folder = false;
  bool is_gzip = false;
  const Format* format = nullptr;  ///< null: unknown
  bool is_recognized = false;      ///< the format, by what it begins with; else by its name alone

  [[nodiscard]] FileBeginning start() const {
    constexpr std::size_t longest = 4096;
    return {std::string_view(beginning).substr(0, longest), is_gzip ? 0 : size};
  }
};

/// Whether a folder is an OpenFOAM case: system/controlDict or constant/polyMesh in it, or the latter in processor0.
bool is_case_folder(const std::filesystem::path& folder);

/// Whether a folder is an AMReX plot file: it has a Header that begins as theirs do.
bool is_amrex_folder(const std::filesystem::path& folder);

/// Whether a folder stands for a file: an OpenFOAM case, an AMReX plot file, or one with a DICOM file among its first
/// thousand, at most four levels below.
bool is_input_folder(const std::filesystem::path& folder);

/// Throws Error(bad_input) unless `file` is a readable regular file that is neither empty nor a pointer of Git LFS.
system::PositionalFile open_input(const std::filesystem::path& file);

/// As open_input, or a folder that stands for a file; returns its bytes' number, of a folder 0.
std::uint64_t require_file(const std::filesystem::path& file);

/// The first bytes of a file, at most `limit`. Throws as require_file.
std::string read_beginning(const std::filesystem::path& file, std::size_t limit);

}  // namespace tessera::io
