// SPDX-License-Identifier: BSD-3-Clause
#include "compositor/gl/gl_cell_lists.hpp"

#include <algorithm>
#include <cstring>

#include "compositor/shader_files.hpp"
#include "sorting/gl/gl_key.hpp"

namespace tessera::compositor {

using gl::Buffer;

GlCellLists::GlCellLists(const gl::Context& context, std::size_t most_cells, scene::Trace* trace)
    : context_(&context),
      rasterizer_(context, most_cells),
      place_(context, {{GL_COMPUTE_SHADER, {shader_files::place_fragments_comp}}}),
      first_crossings_(context,
                       {{GL_COMPUTE_SHADER, {shader_files::integrals_glsl, shader_files::first_crossings_comp}}}),
      given_keys_(context, Buffer::Use::device),
      given_values_(context, Buffer::Use::device),
      next_(context, Buffer::Use::device),
      scalars_(context, Buffer::Use::device),
      readback_(context, Buffer::Use::readback),
      fence_(context),
      timer_(context, trace) {}

std::vector<std::uint32_t> GlCellLists::count(const GlCount& job) {
  std::vector<std::uint32_t> counts(static_cast<std::size_t>(job.rect.area()));
  const std::size_t bytes = counts.size() * sizeof(std::uint32_t);
  next_.reserve(bytes);
  readback_.reserve(bytes);
  timer_.begin(static_cast<std::int32_t>(job.frame));
  context_->gl().MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  next_.clear(bytes);
  const projection::GlRasterizer::Job cells{job.cells->records, job.cells->units, job.rect, 0};
  rasterizer_.count({&cells, 1}, next_);
  context_->gl().MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  timer_.record("project");
  readback_.copy_from(next_, 0, bytes);
  context_->check("counting ray segments");
  fence_.set();
  fence_.wait();
  timer_.collect();
  std::memcpy(counts.data(), readback_.mapped(), bytes);
  return counts;
}

std::vector<std::uint32_t> GlCellLists::next_elements(std::span<const GlJob> jobs,
                                                      std::span<const std::uint32_t> first) {
  std::vector<std::uint32_t> next;
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    const GlFragments& fragments = jobs[i].fragments;
    if (fragments.cells == nullptr) continue;
    const std::size_t before = next.size();
    next.resize(before + static_cast<std::size_t>(fragments.rect.area()));
    for (const GlFragments::List& list : fragments.lists)
      next[before + list.pixel - fragments.first_pixel] = first[i] + list.begin + list.count - list.rasterized;
  }
  return next;
}

void GlCellLists::fill(const Batch& batch, const Buffer& keys, const Buffer& values) {
  const std::size_t key_bytes = batch.given * sizeof(sorting::GlKey), value_bytes = 16 * batch.given;
  next_.reserve(batch.pixels * sizeof(std::uint32_t));
  scalars_.reserve(8 * batch.fragments);
  next_.copy_from(*batch.upload, batch.next_at, batch.pixels * sizeof(std::uint32_t));
  const gl::Functions& gl = context_->gl();
  if (batch.given > 0) {
    given_keys_.reserve(key_bytes);
    given_values_.reserve(value_bytes);
    given_keys_.copy_from(*batch.upload, 0, key_bytes);
    given_values_.copy_from(*batch.upload, key_bytes, value_bytes);
    place_.use();
    place_.set(0, static_cast<GLuint>(batch.given));
    given_keys_.bind(0);
    given_values_.bind(1);
    keys.bind(2);
    values.bind(4);
    gl.DispatchCompute(static_cast<GLuint>((batch.given + 255) / 256), 1, 1);
  }
  std::vector<projection::GlRasterizer::Job> jobs;
  std::uint32_t first_pixel = 0;
  for (const GlJob& job : batch.jobs) {
    const GlFragments& fragments = job.fragments;
    if (fragments.cells == nullptr) continue;
    jobs.push_back({fragments.cells->records, fragments.cells->units, fragments.rect, first_pixel});
    first_pixel += static_cast<std::uint32_t>(fragments.rect.area());
  }
  rasterizer_.fill(jobs, {&next_, &keys, &values, &scalars_});
}

void GlCellLists::complete(const Lists& lists, const Buffer& keys, const Buffer& lights, GlIntegrals& integrals,
                           const GlRules& rules) {
  const gl::Functions& gl = context_->gl();
  gl.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  first_crossings_.use();
  integrals.prepare(first_crossings_, rules);
  first_crossings_.set(0, lists.first);
  first_crossings_.set(1, lists.count);
  keys.bind(0);
  scalars_.bind(1);
  lists.tables.bind(4);
  lights.bind(5);
  gl.DispatchCompute((lists.count + 63) / 64, 1, 1);
}

}  // namespace tessera::compositor
