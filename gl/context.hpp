// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "gl/functions.hpp"
#include "gl/platform.hpp"

namespace tessera::gl {

/// An OpenGL 4.5 core context without a window. It is current on the thread that opened it until that thread destroys
/// it. Only that thread may use the context and the objects created in it.
///
/// The context is robust where the platform supports that: after a device reset, check() throws, instead of commands
/// having no effect without an error.
class Context {
 public:
  virtual ~Context() = default;
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  [[nodiscard]] const Functions& gl() const { return gl_; }
  /// Name of platform and device: "OSMesa, llvmpipe (LLVM 15.0.6, 256 bits)".
  [[nodiscard]] const std::string& name() const { return name_; }
  /// Whether the context renders on the CPU.
  [[nodiscard]] bool software() const { return software_; }
  [[nodiscard]] int limit(GLenum which) const;

  /// Throws Error(system_failure) with a message of one line if the context was lost, the device is out of memory, or a
  /// command was refused since the last check. `doing` names the current activity: "sorting".
  void check(const char* doing) const;

  /// For tests: makes check() report this fault from now on (GL_CONTEXT_LOST, GL_OUT_OF_MEMORY).
  void pretend(GLenum fault) { pretended_ = fault; }

 protected:
  Context() = default;
  /// Loads the functions of the current context and queries its properties. Throws Error(system_failure) if it is too
  /// old.
  void load(const char* platform, const std::function<void*(const char*)>& address_of);

 private:
  Functions gl_;
  std::string name_;
  bool software_ = true, robust_ = false;
  GLenum pretended_ = GL_NO_ERROR;
};

/// Opens a context on the calling thread. Throws Error(system_failure) with a message of one line that names what is
/// missing: the library, a device, OpenGL 4.5.
std::unique_ptr<Context> open_context(Platform platform, const EglDevice& device = {});

/// The implementations of open_context(), which alone may call them.
std::unique_ptr<Context> open_osmesa();
std::unique_ptr<Context> open_egl(const EglDevice& device);

}  // namespace tessera::gl
