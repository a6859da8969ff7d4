// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gl/buffer.hpp"
#include "gl/shader.hpp"
#include "sorting/gl/gl_key.hpp"

namespace tessera::sorting {

/// A list: the range [begin, begin + count) of the keys.
struct GlList {
  std::uint32_t begin, count;
};
static_assert(sizeof(GlList) == 8);

/// Sorts many lists of any length at once by compute shaders: bitonic networks in shared memory for pieces of up to
/// 1024 elements, then as many merge passes as the longest list needs, alternating between two buffers.
///
/// May only be used on the context's thread. plan() must be called before sort(), so that its tables can be uploaded
/// together with the keys.
class GlListSort {
 public:
  static constexpr std::uint32_t piece_size = 1024;

  explicit GlListSort(const gl::Context& context);

  /// Prepares the passes for these lists. The caller then copies `tables()` into a device buffer.
  void plan(std::span<const GlList> lists);
  [[nodiscard]] std::span<const std::uint32_t> tables() const { return tables_; }
  /// Returns which of the two buffers contains a list of `count` elements after sorting.
  [[nodiscard]] static std::uint32_t buffer_of(std::uint32_t count);

  /// Queues the passes. `keys` contains the unsorted keys. Afterwards, a sorted list of `count` elements is in
  /// `buffers[buffer_of(count)]`, in the range that it had before. Returns the number of passes over the elements.
  std::uint32_t sort(const gl::Buffer& keys, const gl::Buffer* const (&buffers)[2], const gl::Buffer& tables) const;

 private:
  struct Pieces {
    std::uint32_t first, count;
  };
  struct Merges {
    std::uint32_t first, count;
  };
  const gl::Context* context_;
  gl::Program sort_, merge_;
  std::vector<std::uint32_t> tables_;
  std::vector<Pieces> pieces_;  ///< index: log2 of the size of a piece, rounded up
  std::vector<Merges> merges_;  ///< index: the pass; `first` counts table entries of four integers
};

}  // namespace tessera::sorting
