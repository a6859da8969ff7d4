// SPDX-License-Identifier: BSD-3-Clause
#include "system/positional_file.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include "scene/error.hpp"
#include "system/files_read.hpp"
#include "system/regular_file.hpp"

namespace tessera::system {

PositionalFile::PositionalFile(const std::filesystem::path& file, std::string name)
    : name_(name.empty() ? file.string() : std::move(name)), descriptor_(open_regular(file, name_)) {
  note_read(file);
}

void PositionalFile::read(std::uint64_t at, std::byte* to, std::uint64_t count) const {
  while (count > 0) {
    const ssize_t got = ::pread(descriptor_.get(), to, std::min(count, std::uint64_t{1} << 30), static_cast<off_t>(at));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail(fmt::format("cannot be read at byte {}", at), errno);
    if (got == 0) fail(fmt::format("has been shortened to {} bytes while it was read", at), 0);
    at += static_cast<std::uint64_t>(got), to += got, count -= static_cast<std::uint64_t>(got);
  }
}

std::string PositionalFile::beginning(std::uint64_t count) const {
  return beginning_of(descriptor_, std::min(count, size()));
}

std::uint64_t PositionalFile::size() const {
  struct stat facts {};
  if (::fstat(descriptor_.get(), &facts) != 0) fail("cannot be asked for its size", errno);
  return static_cast<std::uint64_t>(facts.st_size);
}

void PositionalFile::fail(const std::string& what, int error_number) const {
  const std::string why = error_number == 0 ? "" : ": " + std::generic_category().message(error_number);
  throw scene::Error(scene::ErrorCode::system_failure, fmt::format("{}: it {}{}; check the disk", name_, what, why));
}

}  // namespace tessera::system
