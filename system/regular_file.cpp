// SPDX-License-Identifier: BSD-3-Clause
#include "system/regular_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "scene/error.hpp"
#include "system/missing_file.hpp"
#include "tessera/program/text.hpp"

namespace tessera::system {
namespace {

scene::Error not_regular(const std::string& name) {
  return scene::bad_input(fmt::format("{}: it is not a regular file; give one that can be read twice", name));
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

/// Whether the error means that there is no such file. A name that is too long and a circular link are treated as
/// missing files.
bool leads_nowhere(int error_number) {
  return error_number == ENOENT || error_number == ENOTDIR || error_number == ENAMETOOLONG || error_number == ELOOP;
}

}  // namespace

Descriptor open_regular(const std::filesystem::path& file, const std::string& name) {
  struct stat facts {};
  // The type is checked before opening, since opening a device may trigger an action, and again afterwards, because the
  // file may have been replaced. Opening does not wait for a pipe without a writer.
  if (::stat(file.c_str(), &facts) == 0 && !S_ISREG(facts.st_mode)) throw not_regular(name);
  Descriptor opened(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
  if (!opened.is_open()) throw leads_nowhere(errno) ? missing_file(file) : cannot_open(name, errno);
  if (::fstat(opened.get(), &facts) != 0) throw cannot_open(name, errno);
  if (!S_ISREG(facts.st_mode)) throw not_regular(name);
  return opened;
}

std::uint64_t file_size(const Descriptor& opened, const std::string& name) {
  struct stat facts {};
  if (::fstat(opened.get(), &facts) != 0) throw cannot_open(name, errno);
  return static_cast<std::uint64_t>(facts.st_size);
}

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

std::string lower_extension(const std::filesystem::path& file) { return lower_case(file.extension().string()); }

}  // namespace tessera::system
