#include "compositor/window_segments.hpp"

namespace tessera::compositor {

void WindowSegments::take(projection::SegmentWindows& windows, std::int64_t final_step, std::size_t /*at_least*/,
                          scene::TraceLaps& laps) {
  exchange::Bytes& out = writer_.records();
  for (std::size_t p = 0; p < windows.pixels(); ++p) {
    const std::uint32_t count = windows.count(p);
    if (count == 0) continue;
    exchange::append(out, exchange::LatticeHeader{writer_.tile_pixel(p), count});
    for (std::uint32_t k = 0; k < count; ++k) exchange::append(out, windows.segments()[k * windows.stride() + p]);
    writer_.count(count);
    segments_ += count;
  }
  windows.clear();
  writer_.complete_to(lattice_.depth(static_cast<double>(final_step)));
  laps.lap("pack");
  writer_.send_if_full();
}

}  // namespace tessera::compositor
