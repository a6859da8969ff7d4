// SPDX-License-Identifier: BSD-3-Clause
#include "projection/gl/gl_rasterizer.hpp"

#include <algorithm>
#include <cstring>

#include "projection/shader_files.hpp"

namespace tessera::projection {
namespace {

constexpr GLuint threads_a_cell = 8, threads_a_group = 64;  // as in the shader

}  // namespace

/// Uniform data of rasterize_cells.comp.
struct GlRasterizer::Part {
  double half_width, half_height, tangents_per_pixel, key_origin, keys_per_depth, scalar_origin, scalar_unit,
      length_unit;
  std::int32_t x0, y0, x1, y1;
  std::uint32_t first_cell, cell_count, first_pixel, counting;
};

GlRasterizer::GlRasterizer(const gl::Context& context, std::size_t most_cells)
    : context_(&context),
      most_cells_(most_cells),
      program_(context, {{GL_COMPUTE_SHADER, {shader_files::exact_edge_glsl, shader_files::rasterize_cells_comp}}}),
      upload_cells_(context, gl::Buffer::Use::upload),
      upload_parts_(context, gl::Buffer::Use::upload),
      cells_(context, gl::Buffer::Use::device),
      parts_(context, gl::Buffer::Use::device),
      uploaded_(context) {
  static_assert(sizeof(Part) == 96);
}

void GlRasterizer::count(std::span<const Job> jobs, const gl::Buffer& counts) {
  run(jobs, {&counts, &counts, &counts, &counts}, true);
}

void GlRasterizer::fill(std::span<const Job> jobs, const Lists& lists) { run(jobs, lists, false); }

void GlRasterizer::run(std::span<const Job> jobs, const Lists& lists, bool counting) {
  std::vector<Stretch> stretches;
  std::size_t taken = 0;
  for (const Job& job : jobs)
    for (std::size_t at = 0; at < job.cells.size();) {
      const std::size_t count = std::min(job.cells.size() - at, most_cells_ - taken);
      stretches.push_back({&job, job.cells.subspan(at, count)});
      at += count;
      taken += count;
      if (taken < most_cells_) continue;
      dispatch(stretches, lists, counting);
      stretches.clear();
      taken = 0;
    }
  if (!stretches.empty()) dispatch(stretches, lists, counting);
}

void GlRasterizer::dispatch(std::span<const Stretch> stretches, const Lists& lists, bool counting) {
  std::size_t cells = 0;
  std::vector<Part> parts;
  for (const Stretch& s : stretches) {
    const CellUnits& u = s.job->units;
    const scene::PixelRect& rect = s.job->rect;
    parts.push_back({u.half_width, u.half_height, u.pixels_per_tangent > 0 ? 1 / u.pixels_per_tangent : 0, u.key_origin,
                     u.keys_per_depth, u.lattice.scalar_origin, u.lattice.scalar_unit, u.lattice.depth_unit, rect.x0,
                     rect.y0, rect.x1, rect.y1, static_cast<std::uint32_t>(cells),
                     static_cast<std::uint32_t>(s.cells.size()), s.job->first_pixel, counting ? 1u : 0u});
    cells += s.cells.size();
  }
  const std::size_t cell_bytes = cells * sizeof(CellRecord), part_bytes = parts.size() * sizeof(Part);
  uploaded_.wait();  // the last cells have been uploaded
  upload_cells_.reserve(cell_bytes);
  upload_parts_.reserve(part_bytes);
  cells_.reserve(cell_bytes);
  parts_.reserve(part_bytes);
  std::byte* to = upload_cells_.mapped();
  for (const Stretch& s : stretches) {
    std::memcpy(to, s.cells.data(), s.cells.size_bytes());
    to += s.cells.size_bytes();
  }
  std::memcpy(upload_parts_.mapped(), parts.data(), part_bytes);
  const gl::Functions& gl = context_->gl();
  gl.MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  cells_.copy_from(upload_cells_, 0, cell_bytes);
  parts_.copy_from(upload_parts_, 0, part_bytes);
  uploaded_.set();

  program_.use();
  cells_.bind(0);
  lists.next->bind(1);
  lists.keys->bind(2);
  lists.values->bind(4);
  lists.scalars->bind(5);
  parts_.bind(6);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    program_.set(0, static_cast<GLuint>(i));
    constexpr GLuint cells_a_group = threads_a_group / threads_a_cell;
    gl.DispatchCompute((parts[i].cell_count + cells_a_group - 1) / cells_a_group, 1, 1);
  }
  gl.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

}  // namespace tessera::projection
