// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <bit>
#include <utility>

#include "compositor/gl/gl_kernel.hpp"
#include "compositor/shader_files.hpp"
#include "gl/shader.hpp"
#include "gl/texture.hpp"
#include "gl/timer.hpp"
#include "sorting/gl/gl_bitonic_texture.hpp"

namespace tessera::compositor {
namespace {

using sorting::GlBitonicTexture;

/// The method of Juliachs et al. 2007, 4.3: a tile is composited scanline by scanline. The lists of a scanline's pixels
/// are sorted in a texture, one list per row; then the texture's columns are blended over one another from back to
/// front in the tile's framebuffer.
///
/// In addition to the paper's framebuffer, a second one stores where each ray first meets optical depth.
class FragmentKernel final : public GlKernel {
 public:
  FragmentKernel(const gl::Context& context, const GlSettings& settings, scene::Trace* trace)
      : context_(&context),
        sort_(context, settings.texture_limit),
        column_(context, {{GL_VERTEX_SHADER, {sorting::GlBitonicTexture::whole_target()}},
                          {GL_FRAGMENT_SHADER, {shader_files::integrals_glsl, shader_files::column_frag}}}),
        integrals_(context),
        colors_(context, settings.half ? GL_RGBA16F : GL_RGBA32F),
        firsts_(context, GL_R32F),
        tile_(context),
        timer_(context, trace) {
    context.gl().CreateVertexArrays(1, &no_vertices_);
    context.gl().BindVertexArray(no_vertices_);  // a core context draws only if a vertex array is bound
  }
  ~FragmentKernel() override { context_->gl().DeleteVertexArrays(1, &no_vertices_); }

  [[nodiscard]] int in_flight() const override { return 1; }

  void begin(std::span<GlJob> jobs) override {
    for (const GlJob& job : jobs) lights_.push_back(composite(job));
  }

  std::vector<std::vector<GlLight>> finish() override { return std::exchange(lights_, {}); }

 private:
  using Lists = std::span<const GlFragments::List>;

  std::vector<GlLight> composite(const GlJob& job) {
    const GlFragments& fragments = job.fragments;
    const auto width = static_cast<std::uint32_t>(fragments.width);
    const Lists lists = fragments.lists;
    const std::uint32_t top = lists.front().pixel / width, bottom = lists.back().pixel / width + 1;
    const bool fresh = colors_.reserve(fragments.width, static_cast<int>(bottom - top));
    if (firsts_.reserve(fragments.width, static_cast<int>(bottom - top)) || fresh) tile_.attach({&colors_, &firsts_});
    tile_.clear(0, {0, 0, 0, 0});
    tile_.clear(1, {0, 0, 0, 0});

    timer_.begin(static_cast<std::int32_t>(job.rules.frame));
    for (std::size_t at = 0; at < lists.size();) {
      const std::uint32_t line = lists[at].pixel / width;
      const auto end = std::find_if(lists.begin() + static_cast<std::ptrdiff_t>(at), lists.end(),
                                    [&](const GlFragments::List& list) { return list.pixel / width != line; });
      const auto next = static_cast<std::size_t>(end - lists.begin());
      composite_line(job, lists.subspan(at, next - at), static_cast<int>(line - top));
      at = next;
    }
    std::vector<GlLight> lights = read_back(lists, width, top);
    timer_.collect();
    return lights;
  }

  /// Composites neighbouring pixels of a scanline together: the whole scanline, as in the paper, unless the texture
  /// does not have enough room or the lists differ so much in length that most elements would be padding.
  void composite_line(const GlJob& job, Lists lists, int line) {
    constexpr int most_padding = 3;  // powers of two
    const auto width = static_cast<std::uint32_t>(job.fragments.width);
    for (std::size_t at = 0, end = 0; at < lists.size(); at = end) {
      std::uint32_t longest = 0, shortest = 0xffffffff;
      GlBitonicTexture::Layout layout{};
      for (end = at; end < lists.size(); ++end) {
        const std::uint32_t longer = std::max(longest, lists[end].count),
                            shorter = std::min(shortest, lists[end].count);
        const GlBitonicTexture::Layout wider = sort_.layout(longer);
        const auto pixels = static_cast<int>(lists[end].pixel - lists[at].pixel + 1);
        if (end > at && (pixels > wider.lists || std::bit_width(longer) - std::bit_width(shorter) > most_padding))
          break;
        longest = longer, shortest = shorter, layout = wider;
      }
      composite_pixels(job, lists.subspan(at, end - at), layout, longest, static_cast<int>(lists[at].pixel % width),
                       line);
    }
  }

  void composite_pixels(const GlJob& job, Lists lists, const GlBitonicTexture::Layout& layout, std::uint32_t longest,
                        int first, int line) {
    const auto pixels = static_cast<int>(lists.back().pixel - lists.front().pixel + 1);
    fill(job.fragments, lists, layout, pixels);
    const std::uint32_t passes = sort_.sort(layout, pixels, segments_, ties_);
    timer_.record("sort", passes);

    const gl::Functions& gl = context_->gl();
    tile_.bind();
    gl.Viewport(first, line, pixels, 1);
    gl.Enable(GL_BLEND);
    gl.BlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    column_.use();
    integrals_.prepare(column_, job.rules);
    column_.set(0, static_cast<GLuint>(layout.log2_width));
    column_.set(1, static_cast<GLuint>(layout.log2_size));
    column_.set(2, static_cast<GLuint>(first));
    gl.DrawArraysInstanced(GL_TRIANGLES, 0, 3, static_cast<GLsizei>(longest));
    timer_.record("composite", longest);
  }

  /// Writes the padded lists of neighbouring pixels; pixels without a list get only padding.
  void fill(const GlFragments& fragments, Lists lists, const GlBitonicTexture::Layout& layout, int pixels) {
    const std::size_t stride = layout.stride();
    segments_.assign(static_cast<std::size_t>(pixels) * stride, {0, 0, 0, GlBitonicTexture::null_depth});
    ties_.assign(static_cast<std::size_t>(pixels) * stride, {0, 0});
    for (const GlFragments::List& list : lists) {
      const std::size_t to = (list.pixel - lists.front().pixel) * stride;
      for (std::uint32_t i = 0; i < list.count; ++i) {
        const auto& [length, scalar_front, scalar_back, mark] = fragments.values[list.begin + i];
        const sorting::GlKey& key = fragments.keys[list.begin + i];
        segments_[to + i] = {scalar_front, scalar_back, length, static_cast<float>(key.back)};
        ties_[to + i] = {key.tie, i};
      }
    }
  }

  std::vector<GlLight> read_back(Lists lists, std::uint32_t width, std::uint32_t top) {
    const auto row = static_cast<std::size_t>(colors_.width());
    const std::size_t pixels = row * static_cast<std::size_t>(colors_.height());
    std::vector<float> colors(4 * pixels), firsts(pixels);
    const gl::Functions& gl = context_->gl();
    gl.GetTextureImage(colors_.name(), 0, GL_RGBA, GL_FLOAT, static_cast<GLsizei>(16 * pixels), colors.data());
    gl.GetTextureImage(firsts_.name(), 0, GL_RED, GL_FLOAT, static_cast<GLsizei>(4 * pixels), firsts.data());
    context_->check("compositing");
    std::vector<GlLight> lights;
    lights.reserve(lists.size());
    for (const GlFragments::List& list : lists) {
      const std::size_t x = list.pixel % width, y = list.pixel / width - top;
      const float* color = &colors[4 * (y * row + x)];
      GlLight light{color[0], color[1], color[2], 0, GlLight::no_fragment, 0, 0, 0};
      light.optical_depth = optical_depth_of(color[3]);
      const float first = firsts[y * row + x];
      if (first > 0) light.first = list.begin + static_cast<std::uint32_t>(first) - 1;
      lights.push_back(light);
    }
    return lights;
  }

  const gl::Context* context_;
  GlBitonicTexture sort_;
  gl::Program column_;
  GlIntegrals integrals_;
  gl::Texture colors_, firsts_;
  gl::Framebuffer tile_;
  gl::StageTimer timer_;
  GLuint no_vertices_ = 0;
  std::vector<sorting::TextureSegment> segments_;
  std::vector<sorting::TextureTie> ties_;
  std::vector<std::vector<GlLight>> lights_;
};

}  // namespace

std::unique_ptr<GlKernel> make_fragment_kernel(const gl::Context& context, const GlSettings& settings,
                                               scene::Trace* trace) {
  return std::make_unique<FragmentKernel>(context, settings, trace);
}

}  // namespace tessera::compositor
