// SPDX-License-Identifier: BSD-3-Clause
#include "readers/common/opened_files.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <mutex>
#include <set>
#include <utility>

namespace tessera::readers {
namespace {

struct Opened {
  std::mutex mutex;
  std::set<std::string> names, named;
};
Opened& opened() {
  static Opened names;
  return names;
}

void note(int descriptor, const char* name) {
  struct stat facts {};
  const int error = errno;
  if (descriptor >= 0 && ::fstat(descriptor, &facts) == 0 && S_ISREG(facts.st_mode)) {
    const std::lock_guard lock(opened().mutex);
    opened().names.insert(name);
  }
  errno = error;
}

/// Returns the C library's function of this name.
template <class Function>
Function* c_library(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

int open_noted(const char* name, int flags, mode_t mode) {
  static auto* const open = c_library<int(const char*, int, ...)>("open64");
  const int descriptor = open(name, flags, mode);
  note(descriptor, name);
  return descriptor;
}

int open_at_noted(int folder, const char* name, int flags, mode_t mode) {
  static auto* const open = c_library<int(int, const char*, int, ...)>("openat64");
  const int descriptor = open(folder, name, flags, mode);
  if (folder == AT_FDCWD || *name == '/') note(descriptor, name);  // other calls come from directory listings
  return descriptor;
}

std::FILE* open_stream_noted(const char* name, const char* mode) {
  static auto* const open = c_library<std::FILE*(const char*, const char*)>("fopen64");
  std::FILE* const stream = open(name, mode);
  if (stream != nullptr) note(::fileno(stream), name);
  return stream;
}

mode_t mode_in(std::va_list& rest, int flags) {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(rest, mode_t) : 0;
}

}  // namespace

std::vector<std::string> take_opened_files() {
  const std::lock_guard lock(opened().mutex);
  const std::set<std::string> names = std::exchange(opened().names, {});
  return {names.begin(), names.end()};
}

void note_named_file(const std::filesystem::path& file) {
  const std::lock_guard lock(opened().mutex);
  opened().named.insert(file.string());
}

std::vector<std::string> take_named_files() {
  const std::lock_guard lock(opened().mutex);
  const std::set<std::string> named = std::exchange(opened().named, {});
  return {named.begin(), named.end()};
}

}  // namespace tessera::readers

// The libraries that this program links call these definitions instead of the C library's.
#pragma GCC visibility push(default)
extern "C" {

int open(const char* name, int flags, ...) {
  std::va_list rest;
  va_start(rest, flags);
  const mode_t mode = tessera::readers::mode_in(rest, flags);
  va_end(rest);
  return tessera::readers::open_noted(name, flags, mode);
}
int openat(int folder, const char* name, int flags, ...) {
  std::va_list rest;
  va_start(rest, flags);
  const mode_t mode = tessera::readers::mode_in(rest, flags);
  va_end(rest);
  return tessera::readers::open_at_noted(folder, name, flags, mode);
}
std::FILE* fopen(const char* name, const char* mode) { return tessera::readers::open_stream_noted(name, mode); }
int open64(const char* name, int flags, ...) __attribute__((alias("open")));
int openat64(int folder, const char* name, int flags, ...) __attribute__((alias("openat")));
std::FILE* fopen64(const char* name, const char* mode) __attribute__((alias("fopen")));
}
#pragma GCC visibility pop
