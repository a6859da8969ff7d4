// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <future>
#include <memory>
#include <span>
#include <vector>

#include "compositor/gl/gl_compositor.hpp"
#include "compositor/gl/gl_fragments.hpp"
#include "gl/buffer.hpp"
#include "gl/shader.hpp"

/// The interface of a device's compositing methods, used only by GlCompositor.
namespace tessera::compositor {

struct GlJob {
  GlFragments fragments;
  GlRules rules;
  std::promise<std::vector<GlLight>> done;
};

/// Cells whose segments are to be counted.
struct GlCount {
  std::shared_ptr<const GlCells> cells;
  scene::PixelRect rect;
  std::uint32_t frame;
  std::promise<std::vector<std::uint32_t>> done;
};

/// A compositing method. May only be used on the context's thread. Batches begin and finish in the same order, with at
/// most `in_flight()` batches at once.
class GlKernel {
 public:
  virtual ~GlKernel() = default;
  /// Queues the commands of a batch. All jobs of a batch belong to one frame, and must exist until finish().
  virtual void begin(std::span<GlJob> jobs) = 0;
  /// Waits for the oldest batch and returns its lights, job by job, list by list.
  virtual std::vector<std::vector<GlLight>> finish() = 0;
  [[nodiscard]] virtual int in_flight() const = 0;
  /// Returns the number of segments in every pixel, row by row. Waits for the device, including the batches that have
  /// begun. Only `compute` supports cells.
  virtual std::vector<std::uint32_t> count(const GlCount& /*job*/) { return {}; }
};

std::unique_ptr<GlKernel> make_compute_kernel(const gl::Context& context, const GlSettings& settings,
                                              scene::Trace* trace);
std::unique_ptr<GlKernel> make_fragment_kernel(const gl::Context& context, const GlSettings& settings,
                                               scene::Trace* trace);

/// Sets the uniforms of shaders/integrals.glsl, and uploads the table if the frame has changed.
class GlIntegrals {
 public:
  explicit GlIntegrals(const gl::Context& context)
      : upload_(context, gl::Buffer::Use::upload), table_(context, gl::Buffer::Use::device), fence_(context) {}
  void prepare(const gl::Program& program, const GlRules& rules);

 private:
  gl::Buffer upload_, table_;
  gl::Fence fence_;
  std::int64_t frame_ = -1;
};

}  // namespace tessera::compositor
