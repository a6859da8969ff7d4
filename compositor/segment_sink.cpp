// SPDX-License-Identifier: BSD-3-Clause
#include "compositor/segment_sink.hpp"

#include <cstring>
#include <type_traits>

#include "compositor/tuple_record.hpp"
#include "projection/surface_crossings.hpp"

namespace tessera::compositor {

template <class Encoding>
void RawSink<Encoding>::start(const scene::PixelRect& rect) {
  FragmentSink<Encoding>::start(rect);
  if constexpr (std::is_same_v<Encoding, LatticeEncoding>)
    open_.fill(~0u);
  else
    open_.assign(static_cast<std::size_t>(rect.area()), 1);
}

template <class Encoding>
void RawSink<Encoding>::take(Store& store, Depth final_depth, std::size_t /*at_least*/, scene::StageTimer& timer) {
  this->segments_ += write(store, final_depth, this->writer_);
  this->writer_.complete_to(planar(final_depth));
  timer.record("pack");
  this->writer_.send_if_full();
}

template <class Encoding>
bool RawSink<Encoding>::take_unordered(Store& store, Depth final_depth, scene::StageTimer& timer) {
  this->segments_ += write(store, Encoding::end, this->writer_);
  this->writer_.complete_to(planar(final_depth));
  timer.record("pack");
  this->writer_.send_if_full();
  return true;
}

template class RawSink<DoubleEncoding>;
template class RawSink<LatticeEncoding>;

std::uint64_t SegmentSink<DoubleEncoding>::write(Store& lists, double final_depth, exchange::PartWriter& writer) {
  lists.sort();
  const projection::RaySegments& segments = lists.segments;
  exchange::Bytes& out = writer.records();
  for (std::size_t p = 0; p < lists.pixels(); ++p) {
    std::size_t header_at = 0;
    exchange::ChainHeader chain{};
    double back = 0, scalar = 0;
    const auto close = [&] {
      if (chain.links > 0) std::memcpy(out.data() + header_at, &chain, sizeof chain);
      writer.count(chain.links);
      chain.links = 0;
    };
    for (const auto& entry : lists.pixel(p)) {
      const std::uint32_t i = entry.segment;
      if (!(entry.depth < final_depth)) break;
      // With cell data, a link has one scalar, but a crossing has two.
      const bool crossing = cell_data_ && projection::is_crossing(segments.scalar_front[i]);
      const bool touches =
          chain.links > 0 && segments.front[i] == back && !crossing &&
          (cell_data_ ? !projection::is_crossing(chain.scalar_front) : segments.scalar_front[i] == scalar);
      if (!touches) {
        close();
        chain = {writer.tile_pixel(p), 0, segments.front[i], segments.scalar_front[i]};
        header_at = out.size();
        exchange::append(out, chain);
      }
      back = segments.back[i];
      scalar = segments.scalar_back[i];
      const std::uint32_t tet = segments.tet(i);
      exchange::append(out, exchange::ChainLink{back, scalar, global_tet_.empty() ? tet : global_tet_[tet]});
      if (normals_ != nullptr) {
        const bool has_none = projection::is_crossing(segments.scalar_front[i]);
        const glm::vec3 normal = has_none ? glm::vec3(0) : normals_->of(tet);
        exchange::append(out, exchange::LinkNormal{normal.x, normal.y, normal.z});
      }
      ++chain.links;
    }
    close();
  }
  return lists.remove(final_depth, {});
}

std::uint64_t SegmentSink<LatticeEncoding>::write(Store& windows, std::int64_t /*all of them, always*/,
                                                  exchange::PartWriter& writer) {
  exchange::Bytes& out = writer.records();
  std::uint64_t written = 0;
  for (std::size_t p = 0; p < windows.pixels(); ++p) {
    const std::uint32_t count = windows.count(p);
    if (count == 0) continue;
    exchange::append(out, exchange::LatticeHeader{writer.tile_pixel(p), count});
    for (std::uint32_t k = 0; k < count; ++k) {
      const std::size_t at = k * windows.stride() + p;
      exchange::append(out, windows.segments()[at]);
      if (windows.lights() != nullptr) exchange::append(out, windows.lights()[at]);
    }
    writer.count(count);
    written += count;
  }
  windows.clear();
  return written;
}

std::uint64_t TupleSink::write(Store& lists, double final_depth, exchange::PartWriter& writer) {
  lists.sort();
  for (std::size_t p = 0; p < lists.pixels(); ++p)
    for (const auto& entry : lists.pixel(p)) {
      if (!(entry.depth < final_depth)) break;
      exchange::append(
          writer.records(),
          TupleRecord{writer.tile_pixel(p), projection::to_tuple(lists.segments, entry.segment, longest_edge_)});
      writer.count(1);
    }
  return lists.remove(final_depth, {});
}

}  // namespace tessera::compositor
