// SPDX-License-Identifier: BSD-3-Clause
#include "api/queries/box_tree.hpp"

#include <algorithm>
#include <bit>
#include <glm/common.hpp>
#include <numeric>

namespace tessera::api {
namespace {

bool meet(const scene::Box& a, const scene::Box& b) {
  return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y &&
         a.low.z <= b.high.z && b.low.z <= a.high.z;
}

}  // namespace

BoxTree::BoxTree(std::span<const scene::Box> boxes) : boxes_(boxes), order_(boxes.size()) {
  std::iota(order_.begin(), order_.end(), 0u);
  nodes_.resize(4 * std::bit_ceil(boxes.size() / leaf_size + 1));
  if (!boxes.empty()) build(0, 0, boxes.size());
}

void BoxTree::build(std::size_t node, std::size_t begin, std::size_t end) {
  scene::Box all = boxes_[order_[begin]];
  scene::Box centres{all.low + all.high, all.low + all.high};
  for (std::size_t i = begin; i < end; ++i) {
    const scene::Box& b = boxes_[order_[i]];
    all.low = glm::min(all.low, b.low), all.high = glm::max(all.high, b.high);
    centres.low = glm::min(centres.low, b.low + b.high), centres.high = glm::max(centres.high, b.low + b.high);
  }
  nodes_[node] = all;
  if (end - begin <= leaf_size) return;
  const glm::dvec3 extent = centres.high - centres.low;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const std::size_t middle = begin + (end - begin) / 2;
  const auto at = [&](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
    return boxes_[a].low[axis] + boxes_[a].high[axis] < boxes_[b].low[axis] + boxes_[b].high[axis];
  });
  build(2 * node + 1, begin, middle);
  build(2 * node + 2, middle, end);
}

template <class Found>
void BoxTree::descend(std::size_t node, std::size_t begin, std::size_t end, const scene::Box& box,
                      const Found& found) const {
  if (!meet(nodes_[node], box)) return;
  if (end - begin <= leaf_size) {
    for (std::size_t i = begin; i < end; ++i)
      if (meet(boxes_[order_[i]], box)) found(order_[i]);
    return;
  }
  const std::size_t middle = begin + (end - begin) / 2;
  descend(2 * node + 1, begin, middle, box, found);
  descend(2 * node + 2, middle, end, box, found);
}

void BoxTree::visit(const scene::Box& box, const std::function<void(std::uint32_t)>& found) const {
  if (!boxes_.empty()) descend(0, 0, boxes_.size(), box, found);
}

}  // namespace tessera::api
