#include "io/input_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <system_error>

#include "io/amrex_header.hpp"
#include "io/files_read.hpp"
#include "io/missing_file.hpp"
#include "scene/error.hpp"

namespace tessera::io {
namespace {

/// Whether `file`, of `size` bytes, is the text that Git LFS keeps in the place of a large file.
bool is_git_lfs_pointer(const std::filesystem::path& file, std::uintmax_t size) {
  constexpr std::string_view first_line = "version https://git-lfs.github.com/spec/v1";
  constexpr std::uintmax_t longest = 1024;  // by the specification of Git LFS
  if (size < first_line.size() || size > longest) return false;
  std::string text(first_line.size(), '\0');
  std::ifstream in(file, std::ios::binary);
  return in.read(text.data(), static_cast<std::streamsize>(text.size())) && text == first_line;
}

}  // namespace

std::uint64_t require_file(const std::filesystem::path& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) throw missing_file(file);
  if (is_input_folder(file)) return 0;
  if (std::filesystem::is_directory(status))
    throw scene::bad_input(fmt::format(
        "{}: it is a directory; name a file in it, or the folder of an OpenFOAM case, an AMReX plot file or of DICOM "
        "files",
        file.string()));
  if (!std::ifstream(file, std::ios::binary))
    throw scene::bad_input(fmt::format("{}: it cannot be opened; check its permissions", file.string()));
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error)
    throw scene::bad_input(fmt::format("{}: it is no regular file; give one that can be read twice", file.string()));
  // OpenFOAM's is a mark on the folder that it lies in.
  if (size == 0 && lower_extension(file) != ".foam" && lower_extension(file) != ".openfoam")
    throw scene::bad_input(fmt::format("{}: it is empty; write it anew", file.string()));
  if (is_git_lfs_pointer(file, size))
    throw scene::bad_input(fmt::format("{}: a Git LFS pointer; `git lfs pull` brings the file itself", file.string()));
  note_read(file);
  return size;
}

std::string read_beginning(const std::filesystem::path& file, std::size_t limit) {
  const std::uint64_t size = require_file(file);
  std::string text(static_cast<std::size_t>(std::min<std::uint64_t>(size, limit)), '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  return text;
}

bool is_case_folder(const std::filesystem::path& folder) {
  std::error_code unknown;
  return std::filesystem::is_directory(folder, unknown) &&
         (std::filesystem::is_regular_file(folder / "system" / "controlDict", unknown) ||
          std::filesystem::is_directory(folder / "constant" / "polyMesh", unknown) ||
          std::filesystem::is_directory(folder / "processor0" / "constant" / "polyMesh", unknown));
}

bool is_amrex_folder(const std::filesystem::path& folder) {
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(folder / "Header", unknown)) return false;
  std::string text(4096, '\0');
  std::ifstream in(folder / "Header", std::ios::binary);
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  return looks_like_amrex(text);
}

bool looks_like_dicom(std::string_view beginning) {
  return beginning.size() >= 132 && beginning.substr(128, 4) == "DICM";
}

bool is_input_folder(const std::filesystem::path& folder) {
  if (is_case_folder(folder) || is_amrex_folder(folder)) return true;
  // In many folders the slices lie one or two levels below, and other files beside them.
  constexpr int most = 1000;
  constexpr int deepest = 4;
  std::error_code error;
  if (!std::filesystem::is_directory(folder, error)) return false;
  std::filesystem::recursive_directory_iterator entry(folder, error);
  for (int files = 0; !error && files < most && entry != std::filesystem::recursive_directory_iterator(); ++files) {
    std::error_code unknown;
    if (entry.depth() >= deepest) entry.disable_recursion_pending();
    if (entry->is_regular_file(unknown)) {
      std::string text(132, '\0');
      std::ifstream in(entry->path(), std::ios::binary);
      if (in.read(text.data(), 132) && looks_like_dicom(text)) return true;
    }
    entry.increment(error);
  }
  return false;
}

std::string lower_extension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

}  // namespace tessera::io
