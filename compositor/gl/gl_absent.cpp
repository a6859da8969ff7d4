// SPDX-License-Identifier: BSD-3-Clause
// Built with TESSERA_GL=OFF, instead of the sources that use a device.
#include "compositor/gl/gl_compositor.hpp"
#include "scene/error.hpp"

namespace tessera::compositor {

class GlCompositor::Worker {};

GlCompositor::GlCompositor(gl::Platform, const GlSettings&, scene::Trace*) : comfortable_fragments_(0) {
  throw scene::Error(scene::ErrorCode::system_failure,
                     "OpenGL: this build leaves it out; use `backend` cpu, or build with TESSERA_GL=ON");
}
GlCompositor::~GlCompositor() = default;

// NOLINTNEXTLINE(performance-unnecessary-value-param): the OpenGL build stores them
std::future<std::vector<GlLight>> GlCompositor::composite(GlFragments, const GlRules&) { return {}; }
// NOLINTNEXTLINE(performance-unnecessary-value-param): likewise
std::future<std::vector<std::uint32_t>> GlCompositor::count(std::shared_ptr<const GlCells>, const scene::PixelRect&,
                                                            std::uint32_t) {
  return {};
}

}  // namespace tessera::compositor
