// SPDX-License-Identifier: BSD-3-Clause
#include "frame/mesh/double_source.hpp"

#include <algorithm>
#include <limits>
#include <type_traits>

#include "scene/frame_watch.hpp"

namespace tessera::frame {
namespace {

/// A buffer of this many segments and the related buffers fit in a core's second-level cache.
constexpr std::size_t comfortable_segments = 8192;

/// `to` must have enough capacity.
template <class Segments>
void append(const Segments& from, Segments& to) {
  const auto copy = [&](const auto& source, auto& target) {
    std::copy_n(source.begin(), from.size, target.begin() + static_cast<std::ptrdiff_t>(to.size));
  };
  copy(from.pixel_and_tet, to.pixel_and_tet);
  copy(from.front, to.front), copy(from.back, to.back);
  copy(from.scalar_front, to.scalar_front), copy(from.scalar_back, to.scalar_back);
  if constexpr (std::is_same_v<Segments, projection::AttributeSegments>)
    copy(from.attribute_front, to.attribute_front), copy(from.attribute_back, to.attribute_back);
  to.size += from.size;
}

}  // namespace

template <class Segments>
bool DoubleSourceOf<Segments>::reserve(std::size_t segments) {
  if (segments <= capacity()) return true;
  if (segments * bytes_a_segment > context_.budget_bytes || segments > std::numeric_limits<std::uint32_t>::max())
    return false;
  lists_.segments.reserve(segments);
  counts_->peak_bytes = std::max<std::uint64_t>(counts_->peak_bytes, segments * bytes_a_segment);
  return true;
}

template <class Segments>
bool DoubleSourceOf<Segments>::start(const scene::PixelRect& rect, const projection::DepthOrder& order) {
  using Key = typename Store::Key;
  rect_ = rect;
  order_ = &order;
  next_ = 0;
  const auto area = static_cast<std::size_t>(rect.area());
  most_ = area * (context_.at_steps != nullptr ? context_.at_steps->most_pieces() : 1);
  // Juliachs et al. 2007, 4.3: z_back is the key.
  lists_.reset(area, context_.rasterizer == Rasterizer::scanline ? Key::back : Key::front);
  std::size_t own = 0;
  if constexpr (std::is_same_v<Segments, projection::RaySegments>)
    if (context_.faces != nullptr) {
      context_.faces->meet(rect, marks_);
      most_ += marks_.size();
      own = marks_.own();
    }
  // Space for at least two segments per pixel: the rasterizer needs one more on every pixel before it starts a cell.
  if (!reserve(own + std::max<std::size_t>(2 * most_,
                                           std::min(comfortable_segments, context_.budget_bytes / bytes_a_segment))))
    return false;
  if (own > 0) marks_.append_own(lists_.segments);
  return true;
}

template <class Segments>
bool DoubleSourceOf<Segments>::fill(const compositor::TileSink<Encoding>& sink) {
  if (!sink.any_open()) return false;
  if (next_ == order_->entries.size()) return false;
  scene::throw_if_stopped(context_.stop);
  next_ += rasterize(order_->entries.subspan(next_));
  return next_ < order_->entries.size();
}

template <class Segments>
double DoubleSourceOf<Segments>::final_depth() const {
  const double depth = context_.depth_origin + order_->nearest_from(next_);
  // The scanline rasterizer's depths are floats. They are rounded in the same way, and are not in front of the nearest
  // vertex of their cell.
  return context_.rasterizer == Rasterizer::scanline ? static_cast<float>(depth) : depth;
}

template <class Segments>
bool DoubleSourceOf<Segments>::make_room() {
  const std::size_t held = lists_.segments.size;
  if (held + most_ <= capacity() / 2) return true;
  return reserve(std::max(2 * capacity(), 2 * (held + most_))) || held + most_ <= capacity();
}

template <class Segments>
std::size_t DoubleSourceOf<Segments>::rasterize(std::span<const projection::TileEntry> entries) {
  if constexpr (std::is_same_v<Segments, projection::RaySegments>)
    if (context_.rasterizer == Rasterizer::scanline)
      return projection::rasterize_scanline({*context_.projected, context_.longest_edge}, entries, rect_, scanline_,
                                            lists_.segments, counts_->raster);
  if (context_.faces != nullptr && marks_.size() > 0) return rasterize_at_faces(entries);
  if (context_.at_steps != nullptr) return rasterize_at_steps(entries);
  return projection::rasterize_planes(*context_.projected, entries, rect_, lists_.segments, counts_->raster);
}

template <class Segments>
std::size_t DoubleSourceOf<Segments>::rasterize_at_steps(std::span<const projection::TileEntry> entries) {
  const auto needs_care = [&](const projection::TileEntry& e) { return context_.at_steps->contain(e.tet); };
  Segments& segments = lists_.segments;
  std::size_t taken = 0;
  while (taken < entries.size()) {
    const auto rest = entries.subspan(taken);
    const auto others = static_cast<std::size_t>(std::find_if(rest.begin(), rest.end(), needs_care) - rest.begin());
    const std::size_t done =
        projection::rasterize_planes(*context_.projected, rest.first(others), rect_, segments, counts_->raster);
    taken += done;
    if (done < others || taken == entries.size() || segments.size + most_ > segments.capacity()) break;
    append(splitter_.rasterize(*context_.projected, context_.steps, entries[taken++], rect_, counts_->raster),
           segments);
  }
  return taken;
}

/// Rasterizes one cell after the other, and cuts the segments of each cell at the triangle surfaces.
template <class Segments>
std::size_t DoubleSourceOf<Segments>::rasterize_at_faces(std::span<const projection::TileEntry> entries) {
  Segments& segments = lists_.segments;
  std::size_t taken = 0;
  for (; taken < entries.size() && segments.size + most_ <= segments.capacity(); ++taken) {
    const projection::TileEntry& entry = entries[taken];
    const std::size_t first = segments.size;
    if (context_.at_steps != nullptr && context_.at_steps->contain(entry.tet))
      append(splitter_.rasterize(*context_.projected, context_.steps, entry, rect_, counts_->raster), segments);
    else
      projection::rasterize_planes(*context_.projected, {&entry, 1}, rect_, segments, counts_->raster);
    marks_.cut(segments, first);
  }
  return taken;
}

template class DoubleSourceOf<projection::RaySegments>;
template class DoubleSourceOf<projection::AttributeSegments>;

}  // namespace tessera::frame
