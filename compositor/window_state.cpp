// SPDX-License-Identifier: BSD-3-Clause
#include <limits>

#include "compositor/window_kernel.hpp"
#include "integrals/segment_integrator.hpp"
#include "projection/surface_crossings.hpp"

namespace tessera::compositor {
namespace {
constexpr int side = projection::SegmentWindows::side;
}

void WindowState::start(const scene::PixelRect& rect, const projection::PixelSpace& space) {
  for (auto* a : {&red, &green, &blue}) a->fill(0);
  transmittance.fill(1);
  ray_transmittance.fill(1);
  open.fill(0);
  first_back.fill(not_yet);
  back.fill(not_yet);
  several.fill(0);
  length_per_step.fill(0);
  rest_rows.fill(0);
  ended.clear();
  std::size_t p = 0;
  for (int y = rect.y0; y < rect.y1; ++y)
    for (int x = rect.x0; x < rect.x1; ++x, ++p) {
      open[p] = -1;
      length_per_step[p] = static_cast<float>(space.length_per_depth(x + 0.5, y + 0.5));
    }
}

WindowState::Run WindowState::run(std::size_t p) const {
  return {static_cast<std::uint32_t>(p),
          back[p],
          // The record of a segment has no light; its receiver integrates it in lanes.
          several[p] != 0 || ((lit || is_in_double) && first_front[p] < first_back[p]),
          {first_front[p], first_back[p], first_scalar_front[p], first_scalar_back[p]},
          red[p],
          green[p],
          blue[p],
          1 - transmittance[p]};
}

void WindowState::end_run(std::size_t p) {
  if (first_back[p] != not_yet) ended.push_back(run(p));
  ray_transmittance[p] *= transmittance[p];
  red[p] = green[p] = blue[p] = 0;
  transmittance[p] = 1;
  several[p] = 0;
  first_back[p] = back[p] = not_yet;
}

int WindowState::open_pixels(const scene::PixelRect& rect, projection::OpenPixels& open_rows) const {
  open_rows.fill(0);
  int count = 0;
  std::size_t p = 0;
  for (int y = rect.y0; y < rect.y1; ++y) {
    std::uint32_t row = 0;
    for (int x = rect.x0; x < rect.x1; ++x, ++p) row |= static_cast<std::uint32_t>(open[p] & 1) << (x % side);
    open_rows[static_cast<std::size_t>(y % side)] = row;
    count += __builtin_popcount(row);
  }
  return count;
}

double first_visible_depth(const scene::Lattice& lattice, const projection::LatticeSegment& segment,
                           const integrals::SegmentIntegrator& integrator) {
  if (projection::is_crossing(segment.scalar_front)) return lattice.depth(segment.front);
  const double along =
      integrator.first_visible(lattice.scalar(segment.scalar_front), lattice.scalar(segment.scalar_back)).value_or(0);
  const double front = lattice.depth(segment.front), back = lattice.depth(segment.back);
  return front + (back - front) * along;
}

}  // namespace tessera::compositor
