// SPDX-License-Identifier: BSD-3-Clause
#include "gl/context.hpp"

// Must follow context.hpp: this header includes gl.h, after which glcorearb.h would omit declarations that both headers
// have.
#include <GL/osmesa.h>

#include <array>

#include "gl/library.hpp"
#include "scene/error.hpp"

namespace tessera::gl {
namespace {

/// Mesa's off-screen interface: a software renderer that draws into memory of the caller. Here that memory is a single
/// pixel, because all drawing uses framebuffer objects.
class OsmesaContext final : public Context {
 public:
  OsmesaContext()
      : library_("libOSMesa.so.8", "OSMesa", "libosmesa6"),
        destroy_(library_.function<decltype(OSMesaDestroyContext)>("OSMesaDestroyContext")) {
    const auto create = library_.function<decltype(OSMesaCreateContextAttribs)>("OSMesaCreateContextAttribs");
    const auto make_current = library_.function<decltype(OSMesaMakeCurrent)>("OSMesaMakeCurrent");
    const auto address_of = library_.function<decltype(OSMesaGetProcAddress)>("OSMesaGetProcAddress");
    constexpr int attributes[] = {OSMESA_FORMAT,
                                  OSMESA_RGBA,
                                  OSMESA_DEPTH_BITS,
                                  0,
                                  OSMESA_PROFILE,
                                  OSMESA_CORE_PROFILE,
                                  OSMESA_CONTEXT_MAJOR_VERSION,
                                  4,
                                  OSMESA_CONTEXT_MINOR_VERSION,
                                  5,
                                  0};
    context_ = create(attributes, nullptr);
    if (context_ == nullptr)
      throw scene::Error(scene::ErrorCode::system_failure,
                         "OSMesa: gives no OpenGL 4.5 core context; install Mesa 22 or newer, or use `backend` cpu");
    if (make_current(context_, pixel_.data(), GL_UNSIGNED_BYTE, 1, 1) == GL_FALSE) {
      destroy_(context_);
      throw scene::Error(scene::ErrorCode::system_failure,
                         "OSMesa: its context cannot be made current; use `backend` cpu");
    }
    try {
      load("OSMesa", [&](const char* name) { return reinterpret_cast<void*>(address_of(name)); });
    } catch (...) {
      destroy_(context_);
      throw;
    }
  }
  ~OsmesaContext() override { destroy_(context_); }

 private:
  Library library_;
  decltype(&OSMesaDestroyContext) destroy_;
  OSMesaContext context_ = nullptr;
  std::array<unsigned char, 4> pixel_{};
};

}  // namespace

std::unique_ptr<Context> open_osmesa() { return std::make_unique<OsmesaContext>(); }

}  // namespace tessera::gl
