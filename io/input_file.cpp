#include "io/input_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <system_error>

#include "io/amrex_header.hpp"
#include "io/files_read.hpp"
#include "io/missing_file.hpp"
#include "scene/error.hpp"

namespace tessera::io {
namespace {

/// Up to `count` bytes from the beginning; fewer if it ends before.
std::string beginning_of(const Descriptor& file, std::uint64_t count) {
  std::string text(static_cast<std::size_t>(count), '\0');
  std::size_t at = 0;
  while (at < text.size()) {
    const ssize_t got = ::pread(file.get(), text.data() + at, text.size() - at, static_cast<off_t>(at));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    at += static_cast<std::size_t>(got);
  }
  text.resize(at);
  return text;
}

/// Whether a file of `size` bytes is the text that Git LFS keeps in the place of a large file.
bool is_git_lfs_pointer(const Descriptor& file, std::uint64_t size) {
  constexpr std::string_view first_line = "version https://git-lfs.github.com/spec/v1";
  constexpr std::uint64_t longest = 1024;  // by the specification of Git LFS
  return size >= first_line.size() && size <= longest && beginning_of(file, first_line.size()) == first_line;
}

scene::Error not_regular(const std::string& name) {
  return scene::bad_input(fmt::format("{}: it is no regular file; give one that can be read twice", name));
}

scene::Error cannot_open(const std::string& name, int error_number) {
  if (error_number == EACCES || error_number == EPERM)
    return scene::bad_input(fmt::format("{}: it cannot be opened; check its permissions", name));
  if (error_number == ENXIO || error_number == ENODEV) return not_regular(name);
  const char* const remedy = error_number == EMFILE || error_number == ENFILE
                                 ? "raise the limit of open files (ulimit -n), or close other programs"
                                 : "check the disk";
  return {scene::ErrorCode::system_failure, name,
          "it cannot be opened: " + std::generic_category().message(error_number), remedy};
}

/// Whether no file can be of such a name: one that is too long, or leads through links in a circle, is not there
/// either.
bool leads_nowhere(int error_number) {
  return error_number == ENOENT || error_number == ENOTDIR || error_number == ENAMETOOLONG || error_number == ELOOP;
}

struct OpenedInput {
  Descriptor file;
  std::uint64_t size = 0;
};

/// Of a folder that stands for a file nothing is opened.
OpenedInput open_input(const std::filesystem::path& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status) && error != std::errc::permission_denied) throw missing_file(file);
  if (is_input_folder(file)) return {};
  if (std::filesystem::is_directory(status))
    throw scene::bad_input(fmt::format(
        "{}: it is a directory; name a file in it, or the folder of an OpenFOAM case, an AMReX plot file or of DICOM "
        "files",
        file.string()));
  OpenedInput opened{open_regular(file, file.string())};
  struct stat facts {};
  if (::fstat(opened.file.get(), &facts) != 0) throw cannot_open(file.string(), errno);
  opened.size = static_cast<std::uint64_t>(facts.st_size);
  // OpenFOAM's is a mark on the folder that it lies in.
  if (opened.size == 0 && lower_extension(file) != ".foam" && lower_extension(file) != ".openfoam")
    throw scene::bad_input(fmt::format("{}: it is empty; write it anew", file.string()));
  if (is_git_lfs_pointer(opened.file, opened.size))
    throw scene::bad_input(fmt::format("{}: a Git LFS pointer; `git lfs pull` brings the file itself", file.string()));
  note_read(file);
  return opened;
}

}  // namespace

Descriptor open_regular(const std::filesystem::path& file, const std::string& name) {
  struct stat facts {};
  // Before the opening, which a device may take for an order, and after it, where another file may be by then. A pipe
  // that nobody writes into is not waited for.
  if (::stat(file.c_str(), &facts) == 0 && !S_ISREG(facts.st_mode)) throw not_regular(name);
  Descriptor opened(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
  if (!opened.is_open()) throw leads_nowhere(errno) ? missing_file(file) : cannot_open(name, errno);
  if (::fstat(opened.get(), &facts) != 0) throw cannot_open(name, errno);
  if (!S_ISREG(facts.st_mode)) throw not_regular(name);
  return opened;
}

std::uint64_t require_file(const std::filesystem::path& file) { return open_input(file).size; }

std::string read_beginning(const std::filesystem::path& file, std::size_t limit) {
  const OpenedInput opened = open_input(file);
  return beginning_of(opened.file, std::min<std::uint64_t>(opened.size, limit));
}

namespace {

/// The first bytes of a file; none of one that cannot be read.
std::string beginning_if_any(const std::filesystem::path& file, std::uint64_t count) {
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(file, unknown)) return {};
  try {
    return beginning_of(open_regular(file, file.string()), count);
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
    if (entry.depth() >= deepest) entry.disable_recursion_pending();
    if (looks_like_dicom(beginning_if_any(entry->path(), 132))) return true;
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
