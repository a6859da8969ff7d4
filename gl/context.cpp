// SPDX-License-Identifier: BSD-3-Clause
#include "gl/context.hpp"

#include <fmt/format.h>

#include "scene/error.hpp"

namespace tessera::gl {
namespace {

scene::Error failure(const std::string& message) { return {scene::ErrorCode::system_failure, message}; }

}  // namespace

std::unique_ptr<Context> open_context(Platform platform, const EglDevice& device) {
  return platform == Platform::osmesa ? open_osmesa() : open_egl(device);
}

void Context::load(const char* platform, const std::function<void*(const char*)>& address_of) {
#define TESSERA_GL_LOAD(type, member)                            \
  gl_.member = reinterpret_cast<type>(address_of("gl" #member)); \
  if (gl_.member == nullptr)                                     \
    throw failure(fmt::format("{}: OpenGL 4.5 is needed, gl{} is missing; use `backend` cpu", platform, #member));
  TESSERA_GL_FUNCTIONS(TESSERA_GL_LOAD)
#undef TESSERA_GL_LOAD
  const auto text = [&](GLenum which) {
    const auto* bytes = reinterpret_cast<const char*>(gl_.GetString(which));
    return std::string(bytes != nullptr ? bytes : "unknown");
  };
  const std::string renderer = text(GL_RENDERER);
  name_ = fmt::format("{}, {}", platform, renderer);
  software_ = renderer.find("llvmpipe") != std::string::npos || renderer.find("softpipe") != std::string::npos ||
              renderer.find("SWR") != std::string::npos;
  const int version = 10 * limit(GL_MAJOR_VERSION) + limit(GL_MINOR_VERSION);
  if (version < 45)
    throw failure(fmt::format("{}: OpenGL 4.5 is needed, there is {}; use `backend` cpu", name_, text(GL_VERSION)));
  robust_ = limit(GL_RESET_NOTIFICATION_STRATEGY) == GL_LOSE_CONTEXT_ON_RESET;
}

int Context::limit(GLenum which) const {
  GLint value = 0;
  gl_.GetIntegerv(which, &value);
  return value;
}

void Context::check(const char* doing) const {
  const auto lost = [&] {
    return failure(fmt::format("{}: the context was lost while {}; start again, or use `backend` cpu", name_, doing));
  };
  if (pretended_ == GL_CONTEXT_LOST || (robust_ && gl_.GetGraphicsResetStatus() != GL_NO_ERROR)) throw lost();
  const GLenum error = pretended_ != GL_NO_ERROR ? pretended_ : gl_.GetError();
  if (error == GL_NO_ERROR) return;
  if (error == GL_CONTEXT_LOST) throw lost();
  if (error == GL_OUT_OF_MEMORY)
    throw failure(
        fmt::format("{}: out of device memory while {}; lower `memory`, make `tile_size` smaller, or use "
                    "`backend` cpu",
                    name_, doing));
  throw failure(
      fmt::format("{}: OpenGL error 0x{:04x} while {}; please report, and use `backend` cpu", name_, error, doing));
}

}  // namespace tessera::gl
