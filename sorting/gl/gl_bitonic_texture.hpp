// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "gl/shader.hpp"
#include "gl/texture.hpp"

namespace tessera::sorting {

/// An element of the sorting texture: a ray segment as in Juliachs et al. 2007, 4.3. The corresponding TextureTie, in a
/// second texture, orders segments of equal depth.
struct TextureSegment {
  float scalar_front, scalar_back, length, z_back;
};
struct TextureTie {
  std::uint32_t tie, place;
};

/// Sorts lists of ray segments by decreasing z_back in a texture, as in the paper: ping-pong fragment passes of a
/// bitonic sort over lists padded with null elements to a power of two. Two differences: the paper's power of two is
/// 2^(ceil(log2 S) + 1), which is one too large, and its null elements are {0, 0, 0, 0}, which assumes z_back > 0.
/// Here, the z_back of a null element is null_depth.
///
/// A list longer than the width of the texture takes several rows. So depth complexity is not limited as in the paper;
/// instead, fewer long lists fit into one texture.
class GlBitonicTexture {
 public:
  static constexpr float null_depth = -3.4e38f;

  /// `limit`: largest side of a texture; 0: the largest that the device supports.
  explicit GlBitonicTexture(const gl::Context& context, int limit = 0);

  /// Returns the vertex stage of a triangle that covers the viewport; the output `column` of this stage is the instance
  /// number.
  static gl::ShaderSource whole_target();

  /// How lists of up to `longest` elements are arranged in the texture. layout() throws Error(system_failure) if one
  /// list does not fit.
  struct Layout {
    std::uint32_t log2_size, log2_width;  ///< log2 of the elements of a padded list, and of a row
    int rows_a_list, lists;               ///< rows per list; number of lists that fit into the texture
    [[nodiscard]] std::size_t stride() const { return std::size_t{1} << log2_size; }
  };
  [[nodiscard]] Layout layout(std::uint32_t longest) const;

  /// Uploads `lists` padded lists, which follow each other with the layout's stride, and sorts them. Afterwards the
  /// sorted textures are bound to units 0 and 1. Returns the number of passes.
  std::uint32_t sort(const Layout& layout, int lists, std::span<const TextureSegment> segments,
                     std::span<const TextureTie> ties);
  /// The ties in sorted order, list after list, in rows of 2^Layout::log2_width elements.
  [[nodiscard]] const gl::Texture& sorted_ties() const { return targets_[sorted_].ties; }

 private:
  struct Target {
    explicit Target(const gl::Context& context)
        : segments(context, GL_RGBA32F), ties(context, GL_RG32UI), framebuffer(context) {}
    gl::Texture segments, ties;
    gl::Framebuffer framebuffer;
  };
  const gl::Context* context_;
  int limit_;
  gl::Program pass_;
  std::array<Target, 2> targets_;
  std::size_t sorted_ = 0;  ///< the target that holds the result
};

}  // namespace tessera::sorting
