// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compositor/gl/gl_kernel.hpp"
#include "gl/buffer.hpp"
#include "gl/shader.hpp"
#include "gl/timer.hpp"
#include "projection/gl/gl_rasterizer.hpp"

namespace tessera::compositor {

/// The part of the compute kernel for jobs with cells: the device rasterizes the cells into the jobs' lists, which also
/// contain the given fragments. May only be used on the context's thread.
class GlCellLists {
 public:
  GlCellLists(const gl::Context& context, std::size_t most_cells, scene::Trace* trace);

  /// Implements GlKernel::count().
  std::vector<std::uint32_t> count(const GlCount& job);

  /// Returns, for every pixel of jobs with cells, job by job, the position of the first list element that the device
  /// makes. `first`: position of the first element of each job's lists in the batch.
  static std::vector<std::uint32_t> next_elements(std::span<const GlJob> jobs, std::span<const std::uint32_t> first);

  /// A batch in mapped memory. The buffer contains the keys of the `given` fragments, then their values, and the result
  /// of next_elements() from byte `next_at` on.
  struct Batch {
    std::span<const GlJob> jobs;
    const gl::Buffer* upload;
    std::size_t given, fragments;  ///< `fragments` includes those that the device makes
    std::size_t next_at, pixels;
  };
  /// Queues commands that fill `keys` and `values`. Both buffers must have room for all fragments.
  void fill(const Batch& batch, const gl::Buffer& keys, const gl::Buffer& values);

  /// The lists of a batch: `count` entries of `tables` from `first` on, in the format of composite.comp.
  struct Lists {
    const gl::Buffer& tables;
    GLuint first, count;
  };
  /// Queues commands that complete the lights marked GlLight::rasterized_one of the batch that was filled last.
  void complete(const Lists& lists, const gl::Buffer& keys, const gl::Buffer& lights, GlIntegrals& integrals,
                const GlRules& rules);

 private:
  const gl::Context* context_;
  projection::GlRasterizer rasterizer_;
  gl::Program place_, first_crossings_;
  gl::Buffer given_keys_, given_values_, next_, scalars_, readback_;
  gl::Fence fence_;
  gl::StageTimer timer_;
};

}  // namespace tessera::compositor
