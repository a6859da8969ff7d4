// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <cstddef>

namespace tessera::scene {

/// Combines the results of of(first, last) over ranges that make up [0, tets) with join(), in parallel. `join` must not
/// depend on the order.
template <class T, class Of, class Join>
T sum_over_tets(std::size_t tets, const T& nothing, const Of& of, const Join& join) {
  constexpr std::size_t tets_a_task = 16384;
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, tets, tets_a_task), nothing,
      [&](const auto& range, const T& sum) { return join(sum, of(range.begin(), range.end())); }, join);
}

}  // namespace tessera::scene
