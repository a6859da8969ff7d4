#include "frame/lattice_tile_renderer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/error.hpp"
#include "scene/frame_watch.hpp"

namespace tessera::frame {
namespace {

constexpr std::size_t first_capacity = 32;         // segments a pixel: half a MiB of windows
constexpr std::size_t capacity_where_opaque = 16;  // rays end soon: the less is behind them
constexpr std::size_t cells_at_once = 16;
// Where one list is full, lists of fewer than this part of the first capacity wait: what is sorted should be final.
constexpr double fullness = 0.75;
// Cells that lie slanting to the rays are in front long before their segments are. Where more than this part of a list
// waits for that it is sorted again and again: there is more room then, as long as that stays in the cache.
constexpr double rest_worth_growing = 0.25;
constexpr std::size_t roomy = 256;
// Computed depths may lie this many steps before the cell's nearest vertex (planes: 16, irregular cells: rounding).
constexpr std::int64_t depth_error = 64;

}  // namespace

void LatticeTileRenderer::render(const scene::PixelRect& rect, std::span<projection::TileEntry> entries,
                                 compositor::WindowSink& sink) {
  projection::DepthOrder order;
  {
    const scene::TraceScope timing(context_.trace, "bin");
    order = projection::order_by_depth(entries, depth_order_);
  }
  constexpr int side = projection::SegmentWindows::side;
  for (int y = rect.y0; y < rect.y1; y = (y & ~(side - 1)) + side)
    for (int x = rect.x0; x < rect.x1; x = (x & ~(side - 1)) + side)
      render_square({x, y, std::min(rect.x1, (x & ~(side - 1)) + side), std::min(rect.y1, (y & ~(side - 1)) + side)},
                    order, sink);
}

void LatticeTileRenderer::render_square(const scene::PixelRect& rect, const projection::DepthOrder& order,
                                        compositor::WindowSink& sink) {
  if (rect.empty()) return;
  if (try_render(rect, order, sink)) return;
  if (rect.area() == 1)
    throw scene::Error(
        scene::ErrorCode::system_failure,
        fmt::format(
            "pixel {},{}: more than {} of its ray segments overlap in depth, beyond the memory budget; raise `memory`",
            rect.x0, rect.y0, windows_.capacity()));
  ++counts_.tiles_split;
  const int x = (rect.x0 + rect.x1 + 1) / 2, y = (rect.y0 + rect.y1 + 1) / 2;
  for (const scene::PixelRect& quarter :
       {scene::PixelRect{rect.x0, rect.y0, x, y}, scene::PixelRect{x, rect.y0, rect.x1, y},
        scene::PixelRect{rect.x0, y, x, rect.y1}, scene::PixelRect{x, y, rect.x1, rect.y1}})
    render_square(quarter, order, sink);
}

std::int64_t LatticeTileRenderer::step_before(double near_depth) const {
  const double steps = (context_.depth_origin + near_depth - view_.lattice.depth_origin) / view_.lattice.depth_unit;
  return static_cast<std::int64_t>(std::floor(std::clamp(steps, -0x1p32, 0x1p32))) - depth_error;
}

bool LatticeTileRenderer::try_render(const scene::PixelRect& rect, const projection::DepthOrder& order,
                                     compositor::WindowSink& sink) {
  const std::span<const projection::TileEntry> entries = order.entries;
  scene::TraceLaps laps(context_.trace);
  const std::size_t capacity = context_.opaque ? capacity_where_opaque : first_capacity;
  const auto at_least = static_cast<std::size_t>(fullness * static_cast<double>(capacity));
  windows_.reset(static_cast<std::size_t>(rect.area()), capacity);
  sink.start(rect);
  for (std::size_t from = 0; from < entries.size() && sink.any_open(); from += cells_at_once) {
    scene::throw_if_stopped(context_.stop);
    const auto cells = entries.subspan(from, std::min(cells_at_once, entries.size() - from));
    stream_.size = 0;
    projection::rasterize_lattice(view_, cells, entries.subspan(from + cells.size()), rect, sink.open(), scratch_,
                                  stream_, counts_.raster);
    for (std::size_t dealt = 0; (dealt = windows_.deal(stream_, dealt)) < stream_.size;) {
      counts_.max_segments_alive = std::max(counts_.max_segments_alive, windows_.total());
      laps.lap("project");
      // What lies before these cells is final.
      sink.take(windows_, step_before(order.nearest_from(from)), at_least, laps);
      const std::size_t left = windows_.count(static_cast<std::size_t>(stream_.pixel[dealt]));
      const double part = static_cast<double>(left) / static_cast<double>(windows_.capacity());
      const bool full = left == windows_.capacity(), crowded = part > rest_worth_growing && windows_.capacity() < roomy;
      if (!full && !crowded) continue;
      if (windows_.bytes_after_growth() <= std::min<std::uint64_t>(context_.budget_bytes, windows_.most_bytes)) {
        windows_.grow();
        continue;
      }
      if (!full) continue;
      if (!sink.take_unordered(windows_, step_before(order.nearest_from(from)), laps)) return false;
      ++counts_.tiles_split;
    }
    counts_.peak_bytes = std::max<std::uint64_t>(counts_.peak_bytes, windows_.bytes() + stream_.bytes());
  }
  counts_.max_segments_alive = std::max(counts_.max_segments_alive, windows_.total());
  laps.lap("project");
  sink.take(windows_, std::numeric_limits<std::int64_t>::max(), 1, laps);
  sink.finish();
  laps.lap("composite");
  return true;
}

}  // namespace tessera::frame
