// SPDX-License-Identifier: BSD-3-Clause
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <fmt/format.h>

#include <string_view>
#include <vector>

#include "gl/context.hpp"
#include "gl/library.hpp"
#include "scene/error.hpp"

namespace tessera::gl {
namespace {

scene::Error no_egl(const std::string& what) {
  return {scene::ErrorCode::system_failure, fmt::format("EGL: {}; use `backend` osmesa or cpu", what)};
}

bool has(const char* extensions, std::string_view name) {
  for (std::string_view rest = extensions != nullptr ? extensions : ""; !rest.empty();) {
    const auto word = rest.substr(0, rest.find(' '));
    if (word == name) return true;
    rest.remove_prefix(std::min(rest.size(), word.size() + 1));
  }
  return false;
}

/// A context on a device without a surface (EGL_EXT_platform_device, EGL_KHR_surfaceless_context), which does not need
/// a display server.
class EglContext final : public Context {
 public:
  explicit EglContext(const EglDevice& wanted)
      : library_("libEGL.so.1", "EGL", "libegl1"),
        address_of_(library_.function<decltype(eglGetProcAddress)>("eglGetProcAddress")) {
    const EGLDeviceEXT device = choose(wanted);
    const auto get_display = function<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
    display_ = get_display(EGL_PLATFORM_DEVICE_EXT, device, nullptr);
    // There is one display per device in a process, and it stays open: terminating it would terminate the display of
    // other contexts on the same device.
    if (display_ == EGL_NO_DISPLAY || function<PFNEGLINITIALIZEPROC>("eglInitialize")(display_, nullptr, nullptr) == 0)
      throw no_egl(fmt::format("device {} cannot be opened", number_));
    const char* const extensions = function<PFNEGLQUERYSTRINGPROC>("eglQueryString")(display_, EGL_EXTENSIONS);
    if (!has(extensions, "EGL_KHR_surfaceless_context") || !has(extensions, "EGL_KHR_no_config_context") ||
        function<PFNEGLBINDAPIPROC>("eglBindAPI")(EGL_OPENGL_API) == 0)
      throw no_egl(fmt::format("device {} offers no OpenGL without a surface", number_));
    std::vector<EGLint> attributes = {EGL_CONTEXT_MAJOR_VERSION,       4,
                                      EGL_CONTEXT_MINOR_VERSION,       5,
                                      EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT};
    if (has(extensions, "EGL_EXT_create_context_robustness"))
      attributes.insert(attributes.end(), {EGL_CONTEXT_OPENGL_ROBUST_ACCESS, EGL_TRUE,
                                           EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY, EGL_LOSE_CONTEXT_ON_RESET});
    attributes.push_back(EGL_NONE);
    const auto create = function<PFNEGLCREATECONTEXTPROC>("eglCreateContext");
    context_ = create(display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
    if (context_ == EGL_NO_CONTEXT && attributes.size() > 7) {  // some drivers support robustness only for OpenGL ES
      attributes.resize(6);
      attributes.push_back(EGL_NONE);
      context_ = create(display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
    }
    if (context_ == EGL_NO_CONTEXT) throw no_egl(fmt::format("device {} gives no OpenGL 4.5 core context", number_));
    try {
      if (make_current(context_) == 0) throw no_egl(fmt::format("device {}'s context cannot be made current", number_));
      load("EGL", [&](const char* name) { return reinterpret_cast<void*>(address_of_(name)); });
      if (wanted.hardware_only && software()) throw no_egl("no hardware device answers");
    } catch (...) {
      close();
      throw;
    }
  }
  ~EglContext() override { close(); }

 private:
  template <class Function>
  Function function(const char* name) const {
    const auto found = reinterpret_cast<Function>(address_of_(name));
    if (found == nullptr) throw no_egl(fmt::format("the library lacks {}", name));
    return found;
  }

  EGLBoolean make_current(EGLContext context) const {
    return function<PFNEGLMAKECURRENTPROC>("eglMakeCurrent")(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context);
  }

  void close() {
    make_current(EGL_NO_CONTEXT);
    function<PFNEGLDESTROYCONTEXTPROC>("eglDestroyContext")(display_, context_);
  }

  EGLDeviceEXT choose(const EglDevice& wanted) {
    const char* const client = function<PFNEGLQUERYSTRINGPROC>("eglQueryString")(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    if (!has(client, "EGL_EXT_platform_device") ||
        !(has(client, "EGL_EXT_device_base") || has(client, "EGL_EXT_device_enumeration")))
      throw no_egl("the library cannot name devices");
    const auto query = function<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
    EGLint count = 0;
    if (query(0, nullptr, &count) == 0 || count < 1) throw no_egl("there is no device");
    std::vector<EGLDeviceEXT> devices(static_cast<std::size_t>(count));
    query(count, devices.data(), &count);
    std::vector<int> hardware, all;
    const auto describe = function<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
    for (int i = 0; i < count; ++i) {
      all.push_back(i);
      if (!has(describe(devices[static_cast<std::size_t>(i)], EGL_EXTENSIONS), "EGL_MESA_device_software"))
        hardware.push_back(i);
    }
    if (wanted.number && (*wanted.number < 0 || *wanted.number >= count))
      throw scene::bad_input(
          fmt::format("`egl_device` {}: there are {} devices, counted from 0", *wanted.number, count));
    if (wanted.hardware_only && hardware.empty()) throw no_egl("no hardware device answers");
    const std::vector<int>& among = hardware.empty() ? all : hardware;
    const auto turn = static_cast<std::size_t>(wanted.local_rank.value_or(0)) % among.size();
    number_ = wanted.number.value_or(among[turn]);
    return devices[static_cast<std::size_t>(number_)];
  }

  Library library_;
  decltype(&eglGetProcAddress) address_of_;
  int number_ = 0;
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
};

}  // namespace

std::unique_ptr<Context> open_egl(const EglDevice& device) { return std::make_unique<EglContext>(device); }

}  // namespace tessera::gl
