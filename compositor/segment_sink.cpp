#include "compositor/segment_sink.hpp"

#include <limits>

#include "compositor/tuple_record.hpp"

namespace tessera::compositor {

void SegmentSink::write(const projection::RaySegments& segments, const sorting::PixelLists& lists, double end_depth) {
  exchange::Bytes& out = records();
  const auto pixels = static_cast<std::size_t>(rect().area());
  for (std::size_t p = 0; p < pixels; ++p) {
    std::size_t header_at = 0;
    exchange::ChainHeader chain{};
    double back = 0, scalar = 0;
    const auto close = [&] {
      if (chain.links > 0) std::memcpy(out.data() + header_at, &chain, sizeof chain);
      count(chain.links);
      chain.links = 0;
    };
    for (const auto& entry : lists.pixel(p)) {
      const std::uint32_t i = entry.segment;
      if (!(entry.depth < end_depth)) break;
      const bool touches =
          chain.links > 0 && segments.front[i] == back && (cell_data_ || segments.scalar_front[i] == scalar);
      if (!touches) {
        close();
        chain = {tile_pixel(p), 0, segments.front[i], segments.scalar_front[i]};
        header_at = out.size();
        exchange::append(out, chain);
      }
      back = segments.back[i];
      scalar = segments.scalar_back[i];
      const std::uint32_t tet = segments.tet(i);
      exchange::append(out, exchange::ChainLink{back, scalar, global_tet_.empty() ? tet : global_tet_[tet]});
      ++chain.links;
    }
    close();
  }
}

void SegmentSink::take(const projection::RaySegments& segments, const sorting::PixelLists& lists, double final_depth) {
  write(segments, lists, final_depth);
  complete_to(final_depth);
  send_if_full();
}

bool SegmentSink::take_unordered(const projection::RaySegments& segments, const sorting::PixelLists& lists,
                                 double final_depth) {
  write(segments, lists, std::numeric_limits<double>::infinity());
  complete_to(final_depth);
  send_if_full();
  return true;
}

void TupleSink::write(const projection::RaySegments& segments, const sorting::PixelLists& lists, double end_depth) {
  const auto pixels = static_cast<std::size_t>(rect().area());
  for (std::size_t p = 0; p < pixels; ++p)
    for (const auto& entry : lists.pixel(p)) {
      if (!(entry.depth < end_depth)) break;
      exchange::append(records(),
                       TupleRecord{tile_pixel(p), projection::to_tuple(segments, entry.segment, longest_edge_)});
      count(1);
    }
}

void TupleSink::take(const projection::RaySegments& segments, const sorting::PixelLists& lists, double final_depth) {
  write(segments, lists, final_depth);
  complete_to(final_depth);
  send_if_full();
}

bool TupleSink::take_unordered(const projection::RaySegments& segments, const sorting::PixelLists& lists,
                               double final_depth) {
  write(segments, lists, std::numeric_limits<double>::infinity());
  complete_to(final_depth);
  send_if_full();
  return true;
}

}  // namespace tessera::compositor
