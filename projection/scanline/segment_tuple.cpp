// SPDX-License-Identifier: BSD-3-Clause
#include "projection/scanline/segment_tuple.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <glm/geometric.hpp>

namespace tessera::projection {

SegmentDepths depths_of(float z_back, float length, float longest_edge) {
  return {z_back - static_cast<double>(length) * static_cast<double>(longest_edge), z_back};
}

SegmentTuple to_tuple(const RaySegments& segments, std::size_t i, float longest_edge) {
  return {static_cast<float>(segments.back[i]),
          static_cast<float>((segments.back[i] - segments.front[i]) / static_cast<double>(longest_edge)),
          static_cast<float>(segments.scalar_front[i]), static_cast<float>(segments.scalar_back[i])};
}

void from_tuple(const SegmentTuple& tuple, std::uint32_t pixel, std::uint32_t tet, float longest_edge,
                RaySegments& segments, std::size_t i) {
  const SegmentDepths depths = depths_of(tuple.z_back, tuple.length, longest_edge);
  segments.pixel_and_tet[i] = static_cast<std::uint64_t>(tet) << 32 | pixel;
  segments.front[i] = depths.front;
  segments.back[i] = depths.back;
  segments.scalar_front[i] = tuple.scalar_front;
  segments.scalar_back[i] = tuple.scalar_back;
}

float longest_edge(const scene::TetMeshView& mesh) {
  const double longest = tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, mesh.tets.size(), 4096), 0.0,
      [&](const auto& range, double most) {
        for (std::size_t t = range.begin(); t != range.end(); ++t)
          for (int i = 0; i < 4; ++i)
            for (int j = i + 1; j < 4; ++j)
              most = std::max(most, glm::distance(mesh.positions[mesh.tets[t][i]], mesh.positions[mesh.tets[t][j]]));
        return most;
      },
      [](double a, double b) { return std::max(a, b); });
  return longest > 0 ? static_cast<float>(longest) : 1;
}

}  // namespace tessera::projection
