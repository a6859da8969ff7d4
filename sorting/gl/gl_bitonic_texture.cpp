// SPDX-License-Identifier: BSD-3-Clause
#include "sorting/gl/gl_bitonic_texture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "scene/error.hpp"
#include "sorting/shader_files.hpp"

namespace tessera::sorting {

GlBitonicTexture::GlBitonicTexture(const gl::Context& context, int limit)
    : context_(&context),
      limit_(context.limit(GL_MAX_TEXTURE_SIZE)),
      pass_(context, {{GL_VERTEX_SHADER, {shader_files::whole_target_vert}},
                      {GL_FRAGMENT_SHADER, {shader_files::bitonic_pass_frag}}}),
      targets_{Target(context), Target(context)} {
  if (limit > 0) limit_ = std::min(limit_, limit);
  limit_ = static_cast<int>(std::bit_floor(static_cast<unsigned>(limit_)));
}

gl::ShaderSource GlBitonicTexture::whole_target() { return shader_files::whole_target_vert; }

GlBitonicTexture::Layout GlBitonicTexture::layout(std::uint32_t longest) const {
  const auto log2_size = static_cast<std::uint32_t>(std::bit_width(std::max(longest, 1u) - 1));
  const auto log2_limit = static_cast<std::uint32_t>(std::countr_zero(static_cast<unsigned>(limit_)));
  Layout layout{log2_size, std::min(log2_size, log2_limit), 1, limit_};
  if (log2_size > 2 * log2_limit)
    throw scene::Error(scene::ErrorCode::system_failure,
                       fmt::format("{}: {} ray segments of a pixel do not fit one texture; use `compositor` gl-compute",
                                   context_->name(), longest));
  layout.rows_a_list = 1 << (log2_size - layout.log2_width);
  layout.lists = limit_ / layout.rows_a_list;
  return layout;
}

std::uint32_t GlBitonicTexture::sort(const Layout& layout, int lists, std::span<const TextureSegment> segments,
                                     std::span<const TextureTie> ties) {
  const gl::Functions& gl = context_->gl();
  const int width = 1 << layout.log2_width, height = lists * layout.rows_a_list;
  for (Target& target : targets_) {
    const bool fresh = target.segments.reserve(width, height);
    if (target.ties.reserve(width, height) || fresh) target.framebuffer.attach({&target.segments, &target.ties});
  }
  gl.TextureSubImage2D(targets_[0].segments.name(), 0, 0, 0, width, height, GL_RGBA, GL_FLOAT, segments.data());
  gl.TextureSubImage2D(targets_[0].ties.name(), 0, 0, 0, width, height, GL_RG_INTEGER, GL_UNSIGNED_INT, ties.data());

  gl.Disable(GL_BLEND);
  gl.Viewport(0, 0, width, height);
  pass_.use();
  pass_.set(0, static_cast<GLuint>(layout.log2_width));
  pass_.set(1, static_cast<GLuint>(layout.log2_size));
  std::uint32_t passes = 0;
  for (std::uint32_t phase = 0; phase < layout.log2_size; ++phase)
    for (std::uint32_t step = phase + 1; step-- > 0; ++passes) {
      const Target &from = targets_[passes % 2], &to = targets_[1 - passes % 2];
      from.segments.bind(0);
      from.ties.bind(1);
      to.framebuffer.bind();
      pass_.set(2, static_cast<GLuint>(phase));
      pass_.set(3, static_cast<GLuint>(step));
      gl.DrawArraysInstanced(GL_TRIANGLES, 0, 3, 1);
    }
  sorted_ = passes % 2;
  targets_[sorted_].segments.bind(0);
  targets_[sorted_].ties.bind(1);
  return passes;
}

}  // namespace tessera::sorting
