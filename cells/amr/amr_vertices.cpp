// SPDX-License-Identifier: BSD-3-Clause
#include "cells/amr/amr_vertices.hpp"

#include "cells/mix_bits.hpp"
#include "scene/error.hpp"

namespace tessera::cells {
namespace {

/// Sixteen consecutive points in a row have adjacent slots, which share cache lines, because these points are usually
/// requested together.
std::uint64_t hash_of(const AmrIndex& p) {
  const auto word = [](std::int32_t n) { return static_cast<std::uint64_t>(static_cast<std::uint32_t>(n)); };
  const std::uint64_t x = word(p[0]);
  return mix((word(p[1]) | (word(p[2]) << 32)) + mix((x >> 4) + 0x9e3779b97f4a7c15ull)) + (x & 15);
}

}  // namespace

/// Returns the slot of the point, or the free slot for it. There is always a free slot.
std::size_t AmrVertices::slot_of(const AmrIndex& p) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = hash_of(p) & mask;
  const auto is_at = [&p](const AmrIndex& q) { return q[0] == p[0] && q[1] == p[1] && q[2] == p[2]; };
  while (slots_[slot] != none && !is_at(points_[slots_[slot]])) slot = (slot + 1) & mask;
  return slot;
}

std::uint32_t AmrVertices::find(const AmrIndex& p) const { return slots_.empty() ? none : slots_[slot_of(p)]; }

std::uint32_t AmrVertices::add(const AmrIndex& p) {
  if (2 * points_.size() >= slots_.size()) grow();
  const std::size_t slot = slot_of(p);
  if (slots_[slot] == none) {
    if (points_.size() + 1 >= none)
      throw scene::bad_input("an AMR mesh: it has more than 2^32 cell corners; give fewer levels or a part of it");
    slots_[slot] = static_cast<std::uint32_t>(points_.size());
    points_.push_back(p);
  }
  return slots_[slot];
}

void AmrVertices::grow() {
  slots_.assign(slots_.empty() ? 1024 : 2 * slots_.size(), none);
  for (std::size_t id = 0; id < points_.size(); ++id) slots_[slot_of(points_[id])] = static_cast<std::uint32_t>(id);
}

}  // namespace tessera::cells
