// SPDX-License-Identifier: BSD-3-Clause
#include "system/scratch_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <system_error>
#include <utility>

#include "scene/error.hpp"

namespace tessera::system {
namespace {

/// Opens a file without a name. Returns -1 and sets errno on failure.
int nameless_file(const std::filesystem::path& folder) {
  const int file = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  // Kernels and file systems without O_TMPFILE return EISDIR or EOPNOTSUPP; any other failure would occur again below.
  if (file >= 0) return file;
  std::string name = (folder / "tessera-XXXXXX").string();
  const int named = ::mkostemp(name.data(), O_CLOEXEC);
  if (named >= 0) ::unlink(name.c_str());
  return named;
}

/// Returns 0, or an errno value if there is no space for `bytes` bytes, as far as this can be determined before
/// writing.
int room_for(int file, std::uint64_t bytes) {
  // A signal would kill the process if the file exceeded this limit.
  rlimit most{};
  if (::getrlimit(RLIMIT_FSIZE, &most) == 0 && most.rlim_cur != RLIM_INFINITY && bytes > most.rlim_cur) return EFBIG;
  if (::fallocate(file, 0, 0, static_cast<off_t>(bytes)) == 0) return 0;
  return errno == ENOSPC || errno == EDQUOT || errno == EFBIG ? errno : 0;
}

}  // namespace

ScratchFile::ScratchFile(std::string subject, std::uint64_t bytes) : subject_(std::move(subject)), bytes_(bytes) {
  const char* const named = std::getenv("TMPDIR");
  folder_ = named != nullptr && *named != '\0' ? named : "/tmp";
  descriptor_ = nameless_file(folder_);
  if (descriptor_ < 0) fail(errno);
  if (const int error_number = room_for(descriptor_, bytes_); error_number != 0) {
    ::close(descriptor_);
    fail(error_number);
  }
}

ScratchFile::~ScratchFile() { ::close(descriptor_); }

bool ScratchFile::has_room(std::uint64_t bytes) {
  try {
    const ScratchFile tried("", bytes + bytes / 100);
    return true;
  } catch (const scene::Error&) {
    return false;
  }
}

void ScratchFile::write(const void* bytes, std::size_t count) {
  write_at(position_, bytes, count);
  position_ += count;
}

void ScratchFile::write_at(std::uint64_t position, const void* bytes, std::size_t count) const {
  const char* next = static_cast<const char*>(bytes);
  while (count > 0) {
    const ssize_t written =
        ::pwrite(descriptor_, next, std::min(count, std::size_t{1} << 30), static_cast<off_t>(position));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(errno);
    next += written;
    position += static_cast<std::uint64_t>(written);
    count -= static_cast<std::size_t>(written);
  }
}

std::filesystem::path ScratchFile::path() const { return fmt::format("/proc/{}/fd/{}", ::getpid(), descriptor_); }

void ScratchFile::fail(int error_number) const {
  throw scene::Error(
      scene::ErrorCode::bad_input, subject_,
      fmt::format("its samples, {} when unpacked, cannot be stored in {}: {}", size_in_words(bytes_), folder_.string(),
                  std::generic_category().message(error_number)),
      "free some space there, set TMPDIR to another directory, or convert it to .bricks once and render that");
}

std::string size_in_words(std::uint64_t bytes) {
  const auto b = static_cast<double>(bytes);
  if (bytes >= 1'000'000'000) return fmt::format("{:.3g} GB", b * 1e-9);
  if (bytes >= 1'000'000) return fmt::format("{:.3g} MB", b * 1e-6);
  return fmt::format("{:.3g} kB", std::max(1.0, b * 1e-3));
}

}  // namespace tessera::system
