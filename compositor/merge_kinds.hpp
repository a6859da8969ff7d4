// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "compositor/tile_merger.hpp"

/// The mergers for each kind of record, used only by make_tile_merger().
namespace tessera::compositor {

std::unique_ptr<TileMerger> make_segment_merger(const MergeContext& context, const scene::PixelRect& rect);
std::unique_ptr<TileMerger> make_tuple_merger(const MergeContext& context, const scene::PixelRect& rect);
std::unique_ptr<TileMerger> make_window_merger(const MergeContext& context, const scene::PixelRect& rect);
std::unique_ptr<TileMerger> make_run_merger(const MergeContext& context, const scene::PixelRect& rect);
std::unique_ptr<TileMerger> make_pixel_merger();

}  // namespace tessera::compositor
