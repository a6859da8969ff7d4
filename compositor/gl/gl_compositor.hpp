// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <future>
#include <memory>
#include <string>
#include <vector>

#include "compositor/gl/gl_fragments.hpp"
#include "gl/platform.hpp"
#include "scene/trace.hpp"
#include "tessera/settings.hpp"

namespace tessera::compositor {

using tessera::GlMethod;

/// Faults that tests ask for.
enum class GlFault { none, lost, memory };

struct GlSettings {
  GlMethod method = GlMethod::compute;
  bool half = true;  ///< fragment: 16-bit framebuffer, as the paper's; false: 32-bit
  gl::EglDevice egl_device;
  std::size_t batch_fragments = 1 << 20;  ///< that should come in one job
  std::size_t batch_cells = 1 << 16;      ///< that are on the device at once
  // Tests:
  int texture_limit = 0;  ///< fragment: largest texture, if the device's is not to be used up; 0: the device's
  GlFault fault = GlFault::none;
  int fault_after = 0;  ///< batches
};

/// A device that composites tiles: a thread of its own, which has the context. Many tiles may be in flight: their jobs
/// are put together in batches, and while the device works on one batch the next is uploaded.
class GlCompositor {
 public:
  /// Opens the context and compiles. Throws Error(system_failure) in one line. `trace`: stages `sort`, `integrate`,
  /// `composite` by the device's clock, on a row of their own; may be null.
  GlCompositor(gl::Platform platform, const GlSettings& settings, scene::Trace* trace);
  /// Fails jobs that are not done.
  ~GlCompositor();
  GlCompositor(const GlCompositor&) = delete;
  GlCompositor& operator=(const GlCompositor&) = delete;

  [[nodiscard]] GlMethod method() const { return method_; }
  /// "gl-compute (OSMesa, llvmpipe ...)".
  [[nodiscard]] const std::string& name() const { return name_; }

  /// One light a list. From any thread. The future throws Error(system_failure) if the device fails; so do all later
  /// ones.
  std::future<std::vector<GlLight>> composite(GlFragments fragments, const GlRules& rules);

  /// How many segments the cells have in every pixel of `rect`, row by row: the lists to give to composite() are then
  /// known. `frame`: for the trace. From any thread, and fails as composite(). GlMethod::compute.
  std::future<std::vector<std::uint32_t>> count(std::shared_ptr<const GlCells> cells, const scene::PixelRect& rect,
                                                std::uint32_t frame);

  /// Most fragments that should come in one job; without cells a row of pixels may have more,
  /// and a pixel in any case.
  [[nodiscard]] std::size_t comfortable_fragments() const { return comfortable_fragments_; }

 private:
  class Worker;
  GlMethod method_;
  std::size_t comfortable_fragments_;
  std::string name_;
  std::unique_ptr<Worker> worker_;
};

}  // namespace tessera::compositor
