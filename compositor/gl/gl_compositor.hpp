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

/// Faults that tests simulate.
enum class GlFault { none, lost, memory };

struct GlSettings {
  GlMethod method = GlMethod::compute;
  bool half = true;  ///< fragment: 16-bit framebuffer, as in the paper; false: 32-bit
  gl::EglDevice egl_device;
  std::size_t batch_fragments = 1 << 20;  ///< the fragments that should come in one job
  std::size_t batch_cells = 1 << 16;      ///< the cells that are on the device at once
  // Tests:
  int texture_limit = 0;  ///< fragment: largest texture; 0: the largest that the device supports
  GlFault fault = GlFault::none;
  int fault_after = 0;  ///< the number of batches before the fault
};

/// A device that composites tiles, with a thread of its own that owns the context. Many tiles may be in flight: their
/// jobs are combined into batches, and while the device works on one batch the next is uploaded.
class GlCompositor {
 public:
  /// Opens the context and compiles. Throws Error(system_failure) with one line. `trace`: stages `sort`, `integrate`
  /// and `composite` by the device's clock, on a row of their own; may be null.
  GlCompositor(gl::Platform platform, const GlSettings& settings, scene::Trace* trace);
  /// Fails unfinished jobs.
  ~GlCompositor();
  GlCompositor(const GlCompositor&) = delete;
  GlCompositor& operator=(const GlCompositor&) = delete;

  [[nodiscard]] GlMethod method() const { return method_; }
  /// "gl-compute (OSMesa, llvmpipe ...)".
  [[nodiscard]] const std::string& name() const { return name_; }

  /// One light per list. Any thread. The future throws Error(system_failure) if the device fails, and so do all later
  /// ones.
  std::future<std::vector<GlLight>> composite(GlFragments fragments, const GlRules& rules);

  /// The number of the cells' segments in every pixel of `rect`, row by row, which determines the lists to pass to
  /// composite(). `frame`: for the trace. Any thread; fails like composite(). Only GlMethod::compute.
  std::future<std::vector<std::uint32_t>> count(std::shared_ptr<const GlCells> cells, const scene::PixelRect& rect,
                                                std::uint32_t frame);

  /// The number of fragments that one job should not exceed. Without cells, a row of pixels may have more; a single
  /// pixel may always.
  [[nodiscard]] std::size_t comfortable_fragments() const { return comfortable_fragments_; }

 private:
  class Worker;
  GlMethod method_;
  std::size_t comfortable_fragments_;
  std::string name_;
  std::unique_ptr<Worker> worker_;
};

}  // namespace tessera::compositor
