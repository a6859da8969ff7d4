// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "gl/functions.hpp"
#include "gl/platform.hpp"

namespace tessera::gl {

/// An OpenGL 4.5 core context that draws to no window, current on the thread that opened it until that thread destroys
/// it. Only that thread may use it, or what is made in it.
///
/// Robust where the platform can: after a reset of the device, check() throws instead of commands doing nothing.
class Context {
 public:
  virtual ~Context() = default;
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  [[nodiscard]] const Functions& gl() const { return gl_; }
  /// "OSMesa, llvmpipe (LLVM 15.0.6, 256 bits)".
  [[nodiscard]] const std::string& name() const { return name_; }
  /// Renders on the CPU.
  [[nodiscard]] bool software() const { return software_; }
  [[nodiscard]] int limit(GLenum which) const;

  /// Throws Error(system_failure) in one line if the context was lost, the device has no more memory, or a command was
  /// refused since the last check. `doing` says what was under way: "sorting".
  void check(const char* doing) const;

  /// For tests: from now on check() finds that (GL_CONTEXT_LOST, GL_OUT_OF_MEMORY).
  void pretend(GLenum fault) { pretended_ = fault; }

 protected:
  Context() = default;
  /// Loads the functions of the context that is current and looks what it is. Throws Error(system_failure) if it is too
  /// old.
  void load(const char* platform, const std::function<void*(const char*)>& address_of);

 private:
  Functions gl_;
  std::string name_;
  bool software_ = true, robust_ = false;
  GLenum pretended_ = GL_NO_ERROR;
};

/// Opens a context on the calling thread. Throws Error(system_failure) in one line that says what is missing: the
/// library, a device, OpenGL 4.5.
std::unique_ptr<Context> open_context(Platform platform, const EglDevice& device = {});

/// The implementations, for open_context() alone.
std::unique_ptr<Context> open_osmesa();
std::unique_ptr<Context> open_egl(const EglDevice& device);

}  // namespace tessera::gl
