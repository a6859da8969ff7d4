// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "integrals/lane_table.hpp"
#include "projection/cell_record.hpp"
#include "scene/pixel_rect.hpp"
#include "sorting/gl/gl_key.hpp"

namespace tessera::compositor {

/// Cells of a tile that the device is to rasterize.
struct GlCells {
  std::vector<projection::CellRecord> records;
  projection::CellUnits units;
};

/// Fragments of a tile for a device, pixel by pixel, in no order within a pixel.
struct GlFragments {
  /// A pixel's fragments are [begin, begin + count), of which the last `rasterized` are the device's to make.
  struct List {
    std::uint32_t pixel;  ///< row by row in the tile
    std::uint32_t begin, count;
    std::uint32_t rasterized = 0;
  };
  int width = 0;            ///< of the tile, pixels
  std::vector<List> lists;  ///< none empty, ascending in pixel and begin
  /// One a fragment that is given; `element` is its place in the lists (without cells its number).
  std::vector<sorting::GlKey> keys;
  /// A ray segment {length, scalar at entry, scalar at exit, -1}, in the table's units; or a run {red, green, blue,
  /// optical depth}.
  std::vector<std::array<float, 4>> values;
  /// What `rasterized` fragments come from, the pixels of the picture that the lists are of (whole rows of the tile, or
  /// some of one), and the tile's number of the first; null: there are none.
  std::shared_ptr<const GlCells> cells{};
  scene::PixelRect rect{};
  std::uint32_t first_pixel = 0;

  /// Given or not.
  [[nodiscard]] std::size_t size() const { return lists.empty() ? 0 : lists.back().begin + lists.back().count; }
};

/// The optical depth of an opacity in 0 .. 1. Opacity 1 is all that a float, or a half, says of what is deeper.
inline float optical_depth_of(float opacity) {
  constexpr double deepest = 60;
  return static_cast<float>(std::min(-std::log1p(-std::min(double{opacity}, 1.0)), deepest));
}

/// What the device makes of a list.
struct GlLight {
  float red, green, blue, optical_depth;
  std::uint32_t first;  ///< the first fragment along the ray with optical depth; no_fragment: none; rasterized_one
  std::uint32_t front, back;  ///< of rasterized_one: its keys
  float along;                ///< and where light begins, 0 at the front to 1 at the back
  static constexpr std::uint32_t no_fragment = 0xffffffff, rasterized_one = 0xfffffffe;
};
static_assert(sizeof(GlLight) == 32);

/// How a frame's fragments become light.
struct GlRules {
  const integrals::LaneTable* table;  ///< of a frame; lives until its tiles are done
  std::uint32_t frame;                ///< its number; jobs of one frame share all of this
  int samples;                        ///< 0: exact
  float least_transmittance;          ///< behind less nothing shows
};

}  // namespace tessera::compositor
