// SPDX-License-Identifier: BSD-3-Clause
#include "system/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "system/unfinished.hpp"

namespace tessera {
inline namespace v0_1 {
namespace {

namespace fs = std::filesystem;

fs::path folder_of(const fs::path& target) { return target.has_parent_path() ? target.parent_path() : fs::path("."); }

/// Returns a name in the target's directory. It does not depend on the target's name, which may already have the
/// maximum length.
fs::path part_name(const fs::path& target, unsigned number) {
  return folder_of(target) / fmt::format(".tessera-{}-{}.part", ::getpid(), number);
}

bool user_can_fix(int error_number) {
  switch (error_number) {
    case EACCES:
    case EPERM:
    case ENOENT:
    case ENOTDIR:
    case EISDIR:
    case EROFS:
    case ENAMETOOLONG:
    case ELOOP:
    case EINVAL:
      return true;
    default:
      return false;
  }
}

}  // namespace

OutputFault::OutputFault(ErrorCode code, const fs::path& target, const std::string& fault, const char* remedy)
    : Error(code, target.string(), fault, remedy) {}
OutputFault::~OutputFault() = default;

Error OutputFault::since_changed() const {
  if (code() == ErrorCode::system_failure) return *this;
  return {ErrorCode::system_failure, subject(), problem(),
          "it could be written when the run began; check whether the directory was removed or its permissions were "
          "changed since"};
}

void check_writable(const fs::path& target) {
  try {
    const AtomicFile probe(target);  // is never committed, so no file remains
  } catch (const OutputFault& fault) {
    throw Error(fault);
  }
}

AtomicFile::AtomicFile(fs::path target) : target_(std::move(target)) {
  if (target_.filename().empty()) fail(EISDIR, "cannot be written");
  struct stat present {};
  if (::stat(target_.c_str(), &present) == 0) {
    if (S_ISDIR(present.st_mode)) fail(EISDIR, "cannot be written");
    if (!S_ISREG(present.st_mode))
      throw OutputFault(ErrorCode::bad_input, target_, "is not a regular file",
                        "outputs are replaced as whole files; name a file");
    check_not_read(target_);
  } else if (errno != ENOENT) {
    fail(errno, "cannot be written");
  }
  descriptor_ = ::open(folder_of(target_).c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
  // Kernels and file systems without O_TMPFILE return EISDIR or EOPNOTSUPP; any other failure will occur again in
  // open_named(), which reports it.
  if (descriptor_ < 0) open_named();
  begun_ = true;
}

void AtomicFile::open_named() {
  const auto lock = system::naming_outputs();
  for (unsigned number = 0;; ++number) {
    const fs::path candidate = part_name(target_, number);
    const int opened = ::open(candidate.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
    if (opened >= 0) {
      if (descriptor_ >= 0) ::close(descriptor_);
      descriptor_ = opened;
      part_ = candidate;
      system::add_unfinished(part_);
      return;
    }
    if (errno != EEXIST) fail(errno, "cannot be written");
  }
}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (part_.empty()) return;
  const auto lock = system::naming_outputs();
  ::unlink(part_.c_str());
  system::remove_unfinished(part_);
}

void AtomicFile::write(const void* bytes, std::size_t count) {
  const char* next = static_cast<const char*>(bytes);
  while (count > 0) {
    const ssize_t written = ::write(descriptor_, next, std::min(count, std::size_t{1} << 30));
    if (written < 0) {
      if (errno == EINTR) continue;
      fail(errno, "cannot be written");
    }
    next += written;
    position_ += static_cast<std::uint64_t>(written);
    count -= static_cast<std::size_t>(written);
  }
}

void AtomicFile::seek(std::uint64_t position) {
  if (::lseek(descriptor_, static_cast<off_t>(position), SEEK_SET) < 0) fail(errno, "cannot be written");
  position_ = position;
}

fs::path AtomicFile::named_part() {
  if (part_.empty()) open_named();
  return part_;
}

void AtomicFile::commit() {
  // The permissions of a replaced file are kept, so that a private file remains private. Errors are ignored, since some
  // file systems have no permissions.
  struct stat present {};
  if (::stat(target_.c_str(), &present) == 0 && S_ISREG(present.st_mode))
    static_cast<void>(::fchmod(descriptor_, present.st_mode & 0777));
  // Without fsync, the file may have its name but lack its bytes if the machine crashes after the rename. EINVAL means
  // that the file system does not support fsync.
  if (::fsync(descriptor_) != 0 && errno != EINVAL) fail(errno, "cannot be written");
  const auto lock = system::naming_outputs();
  if (part_.empty()) {
    const std::string self = fmt::format("/proc/self/fd/{}", descriptor_);
    // A new file gets its final name in one step, so that no other file remains if the process is killed here.
    if (::linkat(AT_FDCWD, self.c_str(), AT_FDCWD, target_.c_str(), AT_SYMLINK_FOLLOW) == 0) {
      ::close(descriptor_);
      descriptor_ = -1;
      return;
    }
    if (errno != EEXIST) fail(errno, "cannot be given its name");
    fs::path candidate;
    for (unsigned number = 0;; ++number) {
      candidate = part_name(target_, number);
      if (::linkat(AT_FDCWD, self.c_str(), AT_FDCWD, candidate.c_str(), AT_SYMLINK_FOLLOW) == 0) break;
      if (errno != EEXIST) fail(errno, "cannot be given its name");
    }
    part_ = candidate;
    system::add_unfinished(part_);
  }
  const int closed = ::close(descriptor_);
  descriptor_ = -1;
  if (closed != 0)
    fail(errno, "cannot be written");  // some network file systems report a full disk only when the file
                                       // is closed
  if (::rename(part_.c_str(), target_.c_str()) != 0) fail(errno, "cannot be renamed to");
  system::remove_unfinished(part_);
  part_.clear();
}

void AtomicFile::fail(int error_number, const char* doing) const {
  const char* remedy = "check the disk and the file system";
  switch (error_number) {
    case ENOENT:
    case ENOTDIR:
      remedy = "make the directory first, or name another";
      break;
    case EACCES:
    case EPERM:
    case EROFS:
      remedy = "name a directory you may write in";
      break;
    case EISDIR:
      remedy = "name a file, not a directory";
      break;
    case ENAMETOOLONG:
      remedy = "give a shorter name";
      break;
    case ENOSPC:
    case EDQUOT:
    case EFBIG:
      remedy = "free some space or name another disk";
      break;
    default:
      break;
  }
  const OutputFault fault(user_can_fix(error_number) ? ErrorCode::bad_input : ErrorCode::system_failure, target_,
                          fmt::format("{}: {}", doing, std::generic_category().message(error_number)), remedy);
  if (begun_ && user_can_fix(error_number)) throw fault.since_changed();
  throw fault;
}

void write_text(const fs::path& target, std::string_view text) {
  AtomicFile file(target);
  file.write(text);
  file.commit();
}

void check_not_input(const fs::path& target, const fs::path& input) {
  std::error_code absent;  // if a file is missing, they are not the same file
  if (!input.empty() && fs::equivalent(target, input, absent))
    throw bad_input(
        fmt::format("{}: is an input of this run and would be overwritten; choose another name", target.string()));
}

void check_output(const fs::path& target, const fs::path& input) {
  check_not_input(target, input);
  check_writable(target);
}

}  // namespace v0_1
}  // namespace tessera
