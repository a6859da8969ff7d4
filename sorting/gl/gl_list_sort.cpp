// SPDX-License-Identifier: BSD-3-Clause
#include "sorting/gl/gl_list_sort.hpp"

#include <algorithm>
#include <array>
#include <bit>

#include "sorting/shader_files.hpp"

namespace tessera::sorting {
namespace {

constexpr std::uint32_t slots = GlListSort::piece_size, merge_threads = 256;
constexpr int sizes = std::countr_zero(slots) + 1;

}  // namespace

GlListSort::GlListSort(const gl::Context& context)
    : context_(&context),
      sort_(context, {{GL_COMPUTE_SHADER, {shader_files::before_glsl, shader_files::sort_lists_comp}}}),
      merge_(context, {{GL_COMPUTE_SHADER, {shader_files::before_glsl, shader_files::merge_lists_comp}}}) {}

std::uint32_t GlListSort::buffer_of(std::uint32_t count) {
  std::uint32_t passes = 0;
  for (std::uint64_t sorted = slots; sorted < count; sorted *= 2) ++passes;
  return passes % 2;
}

void GlListSort::plan(std::span<const GlList> lists) {
  tables_.clear();
  pieces_.clear();
  merges_.clear();
  std::array<std::vector<GlList>, sizes> by_size;
  std::uint32_t longest = 0;
  for (const GlList& list : lists) {
    longest = std::max(longest, list.count);
    for (std::uint32_t at = 0; at < list.count; at += slots) {
      const std::uint32_t count = std::min(slots, list.count - at);
      by_size[static_cast<std::size_t>(std::bit_width(count - 1))].push_back({list.begin + at, count});
    }
  }
  std::uint32_t first = 0;
  for (const auto& pieces : by_size) {
    pieces_.push_back({first, static_cast<std::uint32_t>(pieces.size())});
    first += static_cast<std::uint32_t>(pieces.size());
    for (const GlList& piece : pieces) tables_.insert(tables_.end(), {piece.begin, piece.count});
  }
  for (std::uint64_t sorted = slots; sorted < longest; sorted *= 2) {
    tables_.resize((tables_.size() + 3) / 4 * 4);
    Merges pass{static_cast<std::uint32_t>(tables_.size() / 4), 0};
    for (const GlList& list : lists) {
      if (list.count <= sorted) continue;
      for (std::uint64_t at = 0; at < list.count; at += 2 * sorted) {
        const auto left = static_cast<std::uint32_t>(std::min<std::uint64_t>(sorted, list.count - at));
        const auto right = static_cast<std::uint32_t>(std::min<std::uint64_t>(sorted, list.count - at - left));
        for (std::uint32_t offset = 0; offset < left + right; offset += merge_threads, ++pass.count)
          tables_.insert(tables_.end(), {list.begin + static_cast<std::uint32_t>(at), left, right, offset});
      }
    }
    merges_.push_back(pass);
  }
}

std::uint32_t GlListSort::sort(const gl::Buffer& keys, const gl::Buffer* const (&buffers)[2],
                               const gl::Buffer& tables) const {
  const gl::Functions& gl = context_->gl();
  keys.bind(0);
  buffers[0]->bind(1);
  tables.bind(2);
  std::uint32_t passes = 1;
  for (std::size_t size = 0; size < pieces_.size(); ++size) {
    const Pieces& pieces = pieces_[size];
    if (pieces.count == 0) continue;
    sort_.use();
    sort_.set(0, pieces.first);
    sort_.set(1, pieces.count);
    sort_.set(2, static_cast<GLuint>(size));
    const std::uint32_t per_group = slots >> size;
    gl.DispatchCompute((pieces.count + per_group - 1) / per_group, 1, 1);
  }
  for (std::size_t pass = 0; pass < merges_.size(); ++pass) {
    gl.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    buffers[pass % 2]->bind(0);
    buffers[1 - pass % 2]->bind(1);
    merge_.use();
    merge_.set(0, merges_[pass].first);
    gl.DispatchCompute(merges_[pass].count, 1, 1);
    ++passes;
  }
  gl.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  return passes;
}

}  // namespace tessera::sorting
