// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gl/buffer.hpp"
#include "gl/shader.hpp"
#include "sorting/gl/gl_key.hpp"

namespace tessera::sorting {

/// A list of keys: which ones.
struct GlList {
  std::uint32_t begin, count;
};
static_assert(sizeof(GlList) == 8);

/// Sorts many lists of any length at once by compute shaders: bitonic networks in shared memory (up to 1024 elements),
/// then as many merge passes as the longest list needs, back and forth between two buffers.
///
/// Used on the context's thread. The lists are told beforehand (plan), so that tables can go up with the keys.
class GlListSort {
 public:
  static constexpr std::uint32_t piece_size = 1024;

  explicit GlListSort(const gl::Context& context);

  /// What to do with these lists. Afterwards `tables()` are to be copied into a device buffer.
  void plan(std::span<const GlList> lists);
  [[nodiscard]] std::span<const std::uint32_t> tables() const { return tables_; }
  /// Which of the two buffers a list of this length ends up in.
  [[nodiscard]] static std::uint32_t buffer_of(std::uint32_t count);

  /// Queues the passes. `keys` holds unsorted keys; sorted ones lie in `buffers[buffer_of(count)]`, where the list lay.
  /// Returns the number of passes over the elements.
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
  std::vector<Pieces> pieces_;  ///< by the logarithm of their size
  std::vector<Merges> merges_;  ///< by pass; `first` in units of a table's entry
};

}  // namespace tessera::sorting
