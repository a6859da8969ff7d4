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

/// The part of the compute kernel for jobs with cells: the device rasterizes them into the jobs' lists, together with
/// the given fragments. Used on the context's thread.
class GlCellLists {
 public:
  GlCellLists(const gl::Context& context, std::size_t most_cells, scene::Trace* trace);

  /// GlKernel::count().
  std::vector<std::uint32_t> count(const GlCount& job);

  /// For every pixel of jobs with cells, job by job: the first element of its list that the device makes. `first`: the
  /// first element of each job's lists in their batch.
  static std::vector<std::uint32_t> next_elements(std::span<const GlJob> jobs, std::span<const std::uint32_t> first);

  /// A batch in mapped memory: the keys of `given` fragments, then their values, and next_elements() from byte
  /// `next_at` on.
  struct Batch {
    std::span<const GlJob> jobs;
    const gl::Buffer* upload;
    std::size_t given, fragments;  ///< `fragments`: includes those that the device makes
    std::size_t next_at, pixels;
  };
  /// Queues commands that fill `keys` and `values`, which have room for all fragments.
  void fill(const Batch& batch, const gl::Buffer& keys, const gl::Buffer& values);

  /// Lists of a batch: entries of `tables` from `first` on, in the format of composite.comp.
  struct Lists {
    const gl::Buffer& tables;
    GLuint first, count;
  };
  /// Queues commands that complete the lights (GlLight::rasterized_one) of the batch that was filled last.
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
