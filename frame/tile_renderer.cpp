#include "frame/tile_renderer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "scene/error.hpp"
#include "scene/frame_watch.hpp"

namespace tessera::frame {
namespace {

/// A buffer of this many segments and its companions stay in a core's second-level cache.
constexpr std::size_t comfortable_segments = 8192;

/// There must be room.
void append(const projection::RaySegments& from, projection::RaySegments& to) {
  const auto copy = [&](const auto& source, auto& target) {
    std::copy_n(source.begin(), from.size, target.begin() + static_cast<std::ptrdiff_t>(to.size));
  };
  copy(from.pixel_and_tet, to.pixel_and_tet);
  copy(from.front, to.front), copy(from.back, to.back);
  copy(from.scalar_front, to.scalar_front), copy(from.scalar_back, to.scalar_back);
  to.size += from.size;
}

}  // namespace

void TileRenderer::render(const scene::PixelRect& rect, std::span<projection::TileEntry> entries,
                          compositor::TileSink& sink) {
  projection::DepthOrder order;
  {
    const scene::TraceScope timing(context_.trace, "bin");
    order = projection::order_by_depth(entries, depth_order_);
  }
  render_sorted(rect, order, sink);
}

void TileRenderer::render_sorted(const scene::PixelRect& rect, const projection::DepthOrder& order,
                                 compositor::TileSink& sink) {
  if (rect.empty()) return;
  const TileCounts before = counts_;
  if (try_render(rect, order, sink)) {
    const scene::TraceScope timing(context_.trace, "composite");
    sink.finish();
    return;
  }
  if (rect.area() == 1)
    throw scene::Error(
        scene::ErrorCode::system_failure,
        fmt::format(
            "pixel {},{}: more than {} of its ray segments overlap in depth, beyond the memory budget; raise `memory`",
            rect.x0, rect.y0, segments_.capacity()));
  counts_.segments = before.segments;
  ++counts_.tiles_split;
  const int x = (rect.x0 + rect.x1 + 1) / 2, y = (rect.y0 + rect.y1 + 1) / 2;
  for (const scene::PixelRect& quarter :
       {scene::PixelRect{rect.x0, rect.y0, x, y}, scene::PixelRect{x, rect.y0, rect.x1, y},
        scene::PixelRect{rect.x0, y, x, rect.y1}, scene::PixelRect{x, y, rect.x1, rect.y1}})
    render_sorted(quarter, order, sink);
}

bool TileRenderer::reserve(std::size_t segments) {
  if (segments <= segments_.capacity()) return true;
  if (segments * bytes_a_segment > context_.budget_bytes || segments > std::numeric_limits<std::uint32_t>::max())
    return false;
  segments_.reserve(segments);
  counts_.peak_bytes = std::max<std::uint64_t>(counts_.peak_bytes, segments * bytes_a_segment);
  return true;
}

bool TileRenderer::try_render(const scene::PixelRect& rect, const projection::DepthOrder& order,
                              compositor::TileSink& sink) {
  const std::span<const projection::TileEntry> entries = order.entries;
  const auto area = static_cast<std::size_t>(rect.area());
  // What a cell may add.
  const std::size_t most = area * (context_.at_steps != nullptr ? context_.at_steps->most_pieces() : 1);
  segments_.size = 0;
  // Room for at least two segments a pixel: the rasterizer wants space for one more on every pixel before it takes a
  // cell.
  if (!reserve(
          std::max<std::size_t>(2 * most, std::min(comfortable_segments, context_.budget_bytes / bytes_a_segment))))
    return false;
  sink.start(rect);
  for (std::size_t next = 0; next < entries.size();) {
    scene::throw_if_stopped(context_.stop);
    {
      const scene::TraceScope timing(context_.trace, "project");
      next += rasterize(entries.subspan(next), rect);
    }
    double final_depth = next < entries.size() ? context_.depth_origin + order.nearest_from(next)
                                               : std::numeric_limits<double>::infinity();
    // Its depths are floats, rounded the same way and not before their cell's nearest vertex.
    if (context_.rasterizer == Rasterizer::scanline) final_depth = static_cast<float>(final_depth);
    flush(area, final_depth, sink);
    if (sink.open_count() == 0) break;
    const bool wants_room = next < entries.size() && segments_.size + most > segments_.capacity() / 2;
    if (wants_room && !reserve(std::max(2 * segments_.capacity(), 2 * (segments_.size + most))) &&
        segments_.size + most > segments_.capacity()) {
      lists_.sort(segments_, area, key());
      if (!sink.take_unordered(segments_, lists_, final_depth)) return false;
      counts_.segments += segments_.size;
      segments_.size = 0;
    }
  }
  return true;
}

std::size_t TileRenderer::rasterize(std::span<const projection::TileEntry> entries, const scene::PixelRect& rect) {
  if (context_.rasterizer == Rasterizer::scanline)
    return projection::rasterize_scanline(*context_.projected, context_.longest_edge, entries, rect, scanline_,
                                          segments_, counts_.raster);
  if (context_.at_steps != nullptr) return rasterize_at_steps(entries, rect);
  return projection::rasterize_planes(*context_.projected, entries, rect, segments_, counts_.raster);
}

std::size_t TileRenderer::rasterize_at_steps(std::span<const projection::TileEntry> entries,
                                             const scene::PixelRect& rect) {
  const std::size_t most = static_cast<std::size_t>(rect.area()) * context_.at_steps->most_pieces();
  const auto needs_care = [&](const projection::TileEntry& e) { return context_.at_steps->contain(e.tet); };
  std::size_t taken = 0;
  while (taken < entries.size()) {
    const auto rest = entries.subspan(taken);
    const auto others = static_cast<std::size_t>(std::find_if(rest.begin(), rest.end(), needs_care) - rest.begin());
    const std::size_t done =
        projection::rasterize_planes(*context_.projected, rest.first(others), rect, segments_, counts_.raster);
    taken += done;
    if (done < others || taken == entries.size() || segments_.size + most > segments_.capacity()) break;
    const projection::RaySegments& pieces =
        splitter_.rasterize(*context_.projected, context_.steps, entries[taken++], rect, counts_.raster);
    append(pieces, segments_);
  }
  return taken;
}

void TileRenderer::flush(std::size_t pixel_count, double final_depth, compositor::TileSink& sink) {
  counts_.max_segments_alive = std::max<std::uint64_t>(counts_.max_segments_alive, segments_.size);
  {
    const scene::TraceScope timing(context_.trace, "sort");
    lists_.sort(segments_, pixel_count, key());
  }
  const scene::TraceScope timing(context_.trace, "composite");
  sink.take(segments_, lists_, final_depth);
  const std::vector<double>& depth = key() == sorting::PixelLists::Key::back ? segments_.back : segments_.front;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < segments_.size; ++i)
    if (!(depth[i] < final_depth) && sink.open(segments_.pixel(i))) segments_.move(i, kept++);
  counts_.segments += segments_.size - kept;
  segments_.size = kept;
}

}  // namespace tessera::frame
