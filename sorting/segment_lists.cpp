// SPDX-License-Identifier: BSD-3-Clause
#include "sorting/segment_lists.hpp"

namespace tessera::sorting {

template <class Segments>
std::size_t SegmentListsOf<Segments>::remove(double final_depth, std::span<const std::uint8_t> open) {
  const std::vector<double>& depth = key_ == Key::back ? segments.back : segments.front;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < segments.size; ++i)
    if (!(depth[i] < final_depth) && (open.empty() || open[segments.pixel(i)] != 0)) segments.move(i, kept++);
  const std::size_t gone = segments.size - kept;
  segments.size = kept;
  return gone;
}

template class SegmentListsOf<projection::RaySegments>;
template class SegmentListsOf<projection::AttributeSegments>;

}  // namespace tessera::sorting
