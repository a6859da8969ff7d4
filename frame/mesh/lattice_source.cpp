// SPDX-License-Identifier: BSD-3-Clause
#include "frame/mesh/lattice_source.hpp"

#include <algorithm>
#include <cmath>

#include "scene/frame_watch.hpp"

namespace tessera::frame {
namespace {

constexpr std::size_t usual_capacity = 32;         // segments per pixel: half a MiB of windows
constexpr std::size_t capacity_where_opaque = 16;  // rays end soon: fewer segments behind that point
constexpr std::size_t cells_at_once = 16;
// When one list is full, lists shorter than this fraction of the first capacity stay in the store, so that most of the
// segments that are sorted are final.
constexpr double fullness = 0.75;
// If more than this fraction of a list is not final, the lists get more capacity, as long as they fit in the cache.
// Otherwise the same segments would be sorted again and again. This happens with cells that are oblique to the rays:
// their nearest depth is far in front of most of their segments.
constexpr double rest_worth_growing = 0.25;
constexpr std::size_t roomy = 256;
// Computed depths may be this many steps before the cell's nearest vertex (planes: 16, irregular cells: rounding).
constexpr std::int64_t depth_error = 64;

}  // namespace

LatticeSource::LatticeSource(const TileContext& context, TileCounts& counts, const projection::LatticeView& view)
    : context_(context),
      counts_(&counts),
      view_(view),
      first_capacity_(context.opaque ? capacity_where_opaque : usual_capacity),
      at_least_(static_cast<std::size_t>(fullness * static_cast<double>(first_capacity_))) {}

bool LatticeSource::start(const scene::PixelRect& rect, const projection::DepthOrder& order) {
  rect_ = rect;
  order_ = &order;
  cells_ = from_ = placed_ = stream_.size = 0;
  windows_.reset(static_cast<std::size_t>(rect.area()), first_capacity_, view_.light != nullptr);
  if (context_.faces == nullptr) return true;
  context_.faces->meet(rect, marks_);
  faces_.set(marks_, view_.lattice, view_.steps);
  stream_.lit = view_.light != nullptr;
  faces_.append_own(stream_);
  return true;
}

bool LatticeSource::fill(const compositor::TileSink<Encoding>& sink) {
  const std::span<const projection::TileEntry> entries = order_->entries;
  for (;;) {
    placed_ = windows_.scatter(stream_, placed_);
    if (placed_ < stream_.size) return true;
    counts_->peak_bytes = std::max<std::uint64_t>(counts_->peak_bytes, windows_.bytes() + stream_.bytes());
    if (cells_ == entries.size() || !sink.any_open()) return false;
    scene::throw_if_stopped(context_.stop);
    const auto cells = entries.subspan(cells_, std::min(cells_at_once, entries.size() - cells_));
    from_ = cells_;
    cells_ += cells.size();
    stream_.size = placed_ = 0;
    projection::rasterize_lattice(view_, {cells, entries.subspan(cells_)},
                                  {rect_, sink.open(), faces_.empty() ? nullptr : &faces_}, scratch_, stream_,
                                  counts_->raster);
  }
}

/// Returns a depth before which there are neither segments of cells nor crossings of surfaces that are still in the
/// stream.
std::int64_t LatticeSource::first_of_marks() const {
  std::int64_t first = std::int64_t{1} << 32;
  if (!order_->entries.empty()) first = first_of_cells();
  for (std::size_t i = placed_; i < stream_.size; ++i) first = std::min<std::int64_t>(first, stream_.front[i]);
  return first;
}

std::int64_t LatticeSource::final_depth() const { return cells_ == 0 ? first_of_marks() : first_of_cells(); }

/// Returns a depth before which neither the cells in the stream nor later cells have segments.
std::int64_t LatticeSource::first_of_cells() const {
  const double near_depth = context_.depth_origin + order_->nearest_from(from_);
  const double steps = (near_depth - view_.lattice.depth_origin) / view_.lattice.depth_unit;
  return static_cast<std::int64_t>(std::floor(std::clamp(steps, -0x1p32, 0x1p32))) - depth_error;
}

bool LatticeSource::make_room() {
  const std::size_t left = windows_.count(static_cast<std::size_t>(stream_.pixel[placed_]));
  const double part = static_cast<double>(left) / static_cast<double>(windows_.capacity());
  const bool full = left == windows_.capacity(), crowded = part > rest_worth_growing && windows_.capacity() < roomy;
  if (!full && !crowded) return true;
  if (windows_.bytes_after_growth() <= std::min<std::uint64_t>(context_.budget_bytes, windows_.most_bytes)) {
    windows_.grow();
    return true;
  }
  return !full;
}

}  // namespace tessera::frame
