// SPDX-License-Identifier: BSD-3-Clause
#include "volume/lanes/preintegrated_table.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>

#include "integrals/integrate_lanes.hpp"

namespace tessera::volume {

PreintegratedTable::PreintegratedTable(const integrals::LaneTable& function, float low_scalar, float high_scalar,
                                       float step, int size_)
    : size(size_), low(low_scalar) {
  // A constant field needs a positive width, too.
  const float width = std::max(high_scalar - low_scalar, 1.0f);
  scale = static_cast<float>(size - 1) / width;
  const auto n = static_cast<std::size_t>(size);
  entries.resize(4 * n * n);
  tbb::parallel_for(0, size, [&](int front) {
    integrals::FloatBatch batch;
    batch.reserve(n);
    batch.size = n;
    for (std::size_t back = 0; back < n; ++back) {
      batch.length[back] = step;
      batch.scalar_front[back] = low + static_cast<float>(front) / scale;
      batch.scalar_back[back] = low + static_cast<float>(back) / scale;
    }
    integrals::integrate_lanes(function, batch);
    const std::vector<float>* const channels[] = {&batch.optical_depth, &batch.red, &batch.green, &batch.blue};
    for (std::size_t c = 0; c < 4; ++c)
      std::copy_n(channels[c]->begin(), n, &entries[(c * n + static_cast<std::size_t>(front)) * n]);
  });
}

int PreintegratedTable::size_for(const integrals::LaneTable& function, float low_scalar, float high_scalar) {
  const float* const edges = function.column(integrals::LaneTable::edge);
  float closest = high_scalar - low_scalar;
  for (std::size_t knot = 2; knot <= function.knot_count; ++knot)
    if (edges[knot] > low_scalar && edges[knot - 1] < high_scalar && edges[knot] > edges[knot - 1])
      closest = std::min(closest, edges[knot] - edges[knot - 1]);
  if (!(closest > 0)) return least_size;
  const float wanted = std::min(16 * (high_scalar - low_scalar) / closest, static_cast<float>(most_size));
  return std::clamp(static_cast<int>(std::bit_ceil(static_cast<unsigned>(wanted))), least_size, most_size);
}

}  // namespace tessera::volume
