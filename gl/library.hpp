// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace tessera::gl {

/// A shared library opened at run time. It is never closed, because drivers keep threads and thread-local memory whose
/// code must stay loaded.
class Library {
 public:
  /// Throws Error(system_failure) naming the library and the package to install.
  Library(const char* file, const char* what, const char* package);

  /// Returns a function of the library. Throws Error(system_failure) if it is missing.
  template <class Function>
  Function* function(const char* name) const {
    return reinterpret_cast<Function*>(symbol(name));
  }

 private:
  [[nodiscard]] void* symbol(const char* name) const;

  const char* what_;
  void* handle_;
};

}  // namespace tessera::gl
