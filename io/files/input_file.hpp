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

/// A file or directory that was opened once and identified (io/formats/identify.hpp). Readers take an InputFile, and
/// open the file again only to read its data.
struct InputFile {
  static constexpr std::size_t longest_beginning = 1 << 16;

  std::filesystem::path path{};
  std::string name{};       ///< name in messages: the path given by the user, even for the content of a gzip file
  std::string beginning{};  ///< first bytes, at most longest_beginning, inflated if gzip; empty for a directory
  std::uint64_t size = 0;   ///< size in bytes as stored; 0 for a directory
  bool is_folder = false;
  bool is_gzip = false;
  const Format* format = nullptr;  ///< null: unknown
  bool is_recognized = false;      ///< true: the first bytes identified the format; false: only the name did

  [[nodiscard]] FileBeginning start() const {
    constexpr std::size_t longest = 4096;
    return {std::string_view(beginning).substr(0, longest), is_gzip ? 0 : size};
  }
};

/// Whether a directory is an OpenFOAM case: it contains system/controlDict or constant/polyMesh, or its subdirectory
/// processor0 contains constant/polyMesh.
bool is_case_folder(const std::filesystem::path& folder);

/// Whether a directory is an AMReX plot file: it contains a file Header that begins like those of AMReX.
bool is_amrex_folder(const std::filesystem::path& folder);

/// Whether a directory can be given as an input file: it is an OpenFOAM case or an AMReX plot file, or there is a DICOM
/// file among its first thousand files, at most four levels below it.
bool is_input_folder(const std::filesystem::path& folder);

/// Throws Error(bad_input) unless `file` is a readable regular file that is neither empty nor a Git LFS pointer.
system::PositionalFile open_input(const std::filesystem::path& file);

/// Like open_input, but also accepts a directory that can be given as an input file. Returns the size in bytes, which
/// is 0 for a directory.
std::uint64_t require_file(const std::filesystem::path& file);

/// Returns the first bytes of a file, at most `limit`. Throws like require_file.
std::string read_beginning(const std::filesystem::path& file, std::size_t limit);

}  // namespace tessera::io
