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
  std::size_t batch_fragments = 1 << 20;  ///< preferred number of fragments in one job
  std::size_t batch_cells = 1 << 16;      ///< largest number of cells that are on the device at once
  // For tests:
  int texture_limit = 0;  ///< fragment: largest size of a texture; 0: the largest that the device supports
  GlFault fault = GlFault::none;
  int fault_after = 0;  ///< number of batches before the simulated fault
};

/// A device that composites tiles. Its own thread owns the context. Many tiles may be in flight: their jobs are
/// combined into batches, and while the device works on one batch the next batch is uploaded.
class GlCompositor {
 public:
  /// Opens the context and compiles the shaders. Throws Error(system_failure) with a message of one line. `trace` gets
  /// the stages `sort`, `integrate` and `composite`, measured by the device's clock, in a row of their own; may be
  /// null.
  GlCompositor(gl::Platform platform, const GlSettings& settings, scene::Trace* trace);
  /// Unfinished jobs fail.
  ~GlCompositor();
  GlCompositor(const GlCompositor&) = delete;
  GlCompositor& operator=(const GlCompositor&) = delete;

  [[nodiscard]] GlMethod method() const { return method_; }
  /// Method and device, for example "gl-compute (OSMesa, llvmpipe ...)".
  [[nodiscard]] const std::string& name() const { return name_; }

  /// Composites `fragments`; the future returns one light per list. May be called by any thread. If the device fails,
  /// this future and all later ones throw Error(system_failure).
  std::future<std::vector<GlLight>> composite(GlFragments fragments, const GlRules& rules);

  /// Counts the segments that `cells` have in every pixel of `rect`, row by row. The counts determine the lists to pass
  /// to composite(). `frame` is the number for the trace. May be called by any thread; fails like composite(). Requires
  /// GlMethod::compute.
  std::future<std::vector<std::uint32_t>> count(std::shared_ptr<const GlCells> cells, const scene::PixelRect& rect,
                                                std::uint32_t frame);

  /// The number of fragments that one job should not exceed. Without cells, a single row of pixels may exceed it; a
  /// single pixel always may.
  [[nodiscard]] std::size_t comfortable_fragments() const { return comfortable_fragments_; }

 private:
  class Worker;
  GlMethod method_;
  std::size_t comfortable_fragments_;
  std::string name_;
  std::unique_ptr<Worker> worker_;
};

}  // namespace tessera::compositor
