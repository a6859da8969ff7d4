// SPDX-License-Identifier: BSD-3-Clause
#include "io/files/input_file.hpp"

#include <fmt/format.h>

#include <system_error>

#include "io/files/file_beginnings.hpp"
#include "scene/error.hpp"
#include "system/missing_file.hpp"
#include "system/regular_file.hpp"

namespace tessera::io {
namespace {

/// Whether a file of `size` bytes is the pointer text that Git LFS stores instead of a large file.
bool is_git_lfs_pointer(const system::PositionalFile& file, std::uint64_t size) {
  constexpr std::string_view first_line = "version https://git-lfs.github.com/spec/v1";
  constexpr std::uint64_t longest = 1024;  // limit in the specification of Git LFS
  return size >= first_line.size() && size <= longest && file.beginning(first_line.size()) == first_line;
}

}  // namespace

system::PositionalFile open_input(const std::filesystem::path& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status) && error != std::errc::permission_denied) throw system::missing_file(file);
  if (std::filesystem::is_directory(status))
    throw scene::bad_input(
        fmt::format("{}: it is a directory; name a file in it, or the directory of an OpenFOAM case, an AMReX plot "
                    "file or of DICOM "
                    "files",
                    file.string()));
  system::PositionalFile opened(file);
  const std::uint64_t size = opened.size();
  // An empty .foam file only marks its directory as an OpenFOAM case.
  if (size == 0 && system::lower_extension(file) != ".foam" && system::lower_extension(file) != ".openfoam")
    throw scene::bad_input(fmt::format("{}: it is empty; write the file again", file.string()));
  if (is_git_lfs_pointer(opened, size))
    throw scene::bad_input(fmt::format(
        "{}: it is a Git LFS pointer, not the file itself; `git lfs pull` downloads the file", file.string()));
  return opened;
}

std::uint64_t require_file(const std::filesystem::path& file) {
  return is_input_folder(file) ? 0 : open_input(file).size();
}

std::string read_beginning(const std::filesystem::path& file, std::size_t limit) {
  return is_input_folder(file) ? std::string() : open_input(file).beginning(limit);
}

namespace {

/// Returns the first bytes of a file; empty if the file cannot be read.
std::string beginning_if_any(const std::filesystem::path& file, std::uint64_t count) {
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(file, unknown)) return {};
  try {
    return system::beginning_of(system::open_regular(file, file.string()), count);
  } catch (const scene::Error&) {
    return {};
  }
}

}  // namespace

bool is_case_folder(const std::filesystem::path& folder) {
  std::error_code unknown;
  return std::filesystem::is_directory(folder, unknown) &&
         (std::filesystem::is_regular_file(folder / "system" / "controlDict", unknown) ||
          std::filesystem::is_directory(folder / "constant" / "polyMesh", unknown) ||
          std::filesystem::is_directory(folder / "processor0" / "constant" / "polyMesh", unknown));
}

bool is_amrex_folder(const std::filesystem::path& folder) {
  return looks_like_amrex(beginning_if_any(folder / "Header", 4096));
}

bool is_input_folder(const std::filesystem::path& folder) {
  std::error_code error;
  if (!std::filesystem::is_directory(folder, error)) return false;
  if (is_case_folder(folder) || is_amrex_folder(folder)) return true;
  // Slices are often one or two levels below the directory, next to other files.
  constexpr int most = 1000;
  constexpr int deepest = 4;
  std::filesystem::recursive_directory_iterator entry(folder, error);
  for (int files = 0; !error && files < most && entry != std::filesystem::recursive_directory_iterator(); ++files) {
    if (entry.depth() >= deepest) entry.disable_recursion_pending();
    if (looks_like_dicom(beginning_if_any(entry->path(), 132))) return true;
    entry.increment(error);
  }
  return false;
}

}  // namespace tessera::io
