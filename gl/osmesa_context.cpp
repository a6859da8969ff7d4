#include <array>

#include "gl/context.hpp"
#include "gl/library.hpp"
#include "scene/error.hpp"

namespace tessera::gl {
namespace {

// Of Mesa's off-screen interface (OSMesa 22), by its names and values: no header is needed.
using OsmesaHandle = struct osmesa_context*;
constexpr int OSMESA_FORMAT = 0x22, OSMESA_DEPTH_BITS = 0x30, OSMESA_PROFILE = 0x33, OSMESA_CORE_PROFILE = 0x34,
              OSMESA_CONTEXT_MAJOR_VERSION = 0x36, OSMESA_CONTEXT_MINOR_VERSION = 0x37, OSMESA_RGBA = GL_RGBA;
using AnyFunction = void (*)();
using CreateContextAttribs = OsmesaHandle(const int* attributes, OsmesaHandle shared);
using DestroyContext = void(OsmesaHandle);
using MakeCurrent = GLboolean(OsmesaHandle, void* buffer, GLenum type, GLsizei width, GLsizei height);
using GetProcAddress = AnyFunction(const char* name);

/// Mesa's off-screen interface: software, drawing into memory of ours. That is one pixel, as all drawing here goes into
/// framebuffer objects.
class OsmesaContext final : public Context {
 public:
  OsmesaContext()
      : library_("libOSMesa.so.8", "OSMesa", "libosmesa6"),
        destroy_(library_.function<DestroyContext>("OSMesaDestroyContext")) {
    const auto create = library_.function<CreateContextAttribs>("OSMesaCreateContextAttribs");
    const auto make_current = library_.function<MakeCurrent>("OSMesaMakeCurrent");
    const auto address_of = library_.function<GetProcAddress>("OSMesaGetProcAddress");
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
  DestroyContext* destroy_;
  OsmesaHandle context_ = nullptr;
  std::array<unsigned char, 4> pixel_{};
};

}  // namespace

std::unique_ptr<Context> open_osmesa() { return std::make_unique<OsmesaContext>(); }

}  // namespace tessera::gl
