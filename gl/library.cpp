// SPDX-License-Identifier: BSD-3-Clause
#include "gl/library.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include "scene/error.hpp"

namespace tessera::gl {

Library::Library(const char* file, const char* what, const char* package)
    : what_(what), handle_(dlopen(file, RTLD_NOW | RTLD_LOCAL)) {
  if (handle_ == nullptr)
    throw scene::Error(scene::ErrorCode::system_failure,
                       fmt::format("{}: {} cannot be opened; install {} or use `backend` cpu", what, file, package));
}

void* Library::symbol(const char* name) const {
  void* const address = dlsym(handle_, name);
  if (address == nullptr)
    throw scene::Error(scene::ErrorCode::system_failure,
                       fmt::format("{}: the library lacks {}; install a newer one or use `backend` cpu", what_, name));
  return address;
}

}  // namespace tessera::gl
