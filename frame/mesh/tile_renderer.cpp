// SPDX-License-Identifier: BSD-3-Clause
#include "frame/mesh/tile_renderer.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "frame/mesh/double_source.hpp"
#include "frame/mesh/lattice_source.hpp"
#include "scene/error.hpp"

namespace tessera::frame {

template <class Source>
void TileRenderer<Source>::render(const scene::PixelRect& rect, std::span<projection::TileEntry> entries, Sink& sink) {
  projection::DepthOrder order;
  {
    const scene::TraceScope timing(trace_, "bin");
    order = projection::order_by_depth(entries, depth_order_);
  }
  constexpr int side = Encoding::square;
  if constexpr (side == 0) {
    render_part(rect, order, sink);
  } else {
    const auto next = [](int v) { return (v & ~(side - 1)) + side; };
    for (int y = rect.y0; y < rect.y1; y = next(y))
      for (int x = rect.x0; x < rect.x1; x = next(x))
        render_part({x, y, std::min(rect.x1, next(x)), std::min(rect.y1, next(y))}, order, sink);
  }
}

template <class Source>
void TileRenderer<Source>::render_part(const scene::PixelRect& rect, const projection::DepthOrder& order, Sink& sink) {
  if (rect.empty() || try_render(rect, order, sink)) return;
  if (rect.area() == 1)
    throw scene::Error(
        scene::ErrorCode::system_failure,
        fmt::format(
            "pixel {},{}: more than {} of its ray segments overlap in depth, beyond the memory budget; raise `memory`",
            rect.x0, rect.y0, source_.capacity()));
  ++counts_.tiles_split;
  const int x = (rect.x0 + rect.x1 + 1) / 2, y = (rect.y0 + rect.y1 + 1) / 2;
  for (const scene::PixelRect& quarter :
       {scene::PixelRect{rect.x0, rect.y0, x, y}, scene::PixelRect{x, rect.y0, rect.x1, y},
        scene::PixelRect{rect.x0, y, x, rect.y1}, scene::PixelRect{x, y, rect.x1, rect.y1}})
    render_part(quarter, order, sink);
}

template <class Source>
bool TileRenderer<Source>::try_render(const scene::PixelRect& rect, const projection::DepthOrder& order, Sink& sink) {
  scene::StageTimer timer(trace_);
  if (!source_.start(rect, order)) return false;
  sink.start(rect);
  const auto note_fullest = [&] {
    counts_.max_segments_alive = std::max<std::uint64_t>(counts_.max_segments_alive, source_.alive());
    timer.record("project");
  };
  while (source_.fill(sink)) {
    note_fullest();
    sink.take(source_.store(), source_.final_depth(), source_.at_least(), timer);
    if (source_.make_room()) continue;
    if (!sink.take_unordered(source_.store(), source_.final_depth(), timer)) return false;
    ++counts_.tiles_split;
  }
  note_fullest();
  sink.take(source_.store(), Encoding::end, 1, timer);
  sink.finish();
  timer.record("composite");
  return true;
}

template class TileRenderer<DoubleSource>;
template class TileRenderer<DoubleSourceOf<projection::AttributeSegments>>;
template class TileRenderer<LatticeSource>;

}  // namespace tessera::frame
