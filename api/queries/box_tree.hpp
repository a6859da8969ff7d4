// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "scene/camera.hpp"

namespace tessera::api {

/// A binary tree of boxes, split at the median of their centres. It finds the boxes that intersect a given box, in
/// about log n steps for each box found. Building the tree takes time in proportion to n log n.
class BoxTree {
 public:
  explicit BoxTree(std::span<const scene::Box> boxes);

  /// Calls `found(i)` for each box that shares a point with `box`, in unspecified order.
  void visit(const scene::Box& box, const std::function<void(std::uint32_t)>& found) const;

 private:
  static constexpr std::size_t leaf_size = 8;
  void build(std::size_t node, std::size_t begin, std::size_t end);
  template <class Found>
  void descend(std::size_t node, std::size_t begin, std::size_t end, const scene::Box& box, const Found& found) const;

  std::span<const scene::Box> boxes_;
  std::vector<std::uint32_t> order_;
  std::vector<scene::Box> nodes_;  ///< nodes in heap order: node i has the children 2 i + 1 and 2 i + 2
};

}  // namespace tessera::api
