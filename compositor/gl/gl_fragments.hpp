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

/// Cells of a tile for the device to rasterize.
struct GlCells {
  std::vector<projection::CellRecord> records;
  projection::CellUnits units;
};

/// Fragments of a tile for a device, by pixel, in any order within a pixel.
struct GlFragments {
  /// A pixel's fragments are [begin, begin + count); the device makes the last `rasterized` of them.
  struct List {
    std::uint32_t pixel;  ///< row by row in the tile
    std::uint32_t begin, count;
    std::uint32_t rasterized = 0;
  };
  int width = 0;            ///< of the tile, in pixels
  std::vector<List> lists;  ///< none empty, ascending in pixel and begin
  /// One per given fragment; `element` is its position in the lists (without cells, its index).
  std::vector<sorting::GlKey> keys;
  /// A ray segment {length, scalar at entry, scalar at exit, -1}, in the table's units; or a run {red, green, blue,
  /// optical depth}.
  std::vector<std::array<float, 4>> values;
  /// The source of the `rasterized` fragments: the cells, the pixels of the frame that the lists cover (whole rows of
  /// the tile, or part of one), and the index of the first of these pixels in the tile. Null: there are none.
  std::shared_ptr<const GlCells> cells{};
  scene::PixelRect rect{};
  std::uint32_t first_pixel = 0;

  /// Includes those that the device makes.
  [[nodiscard]] std::size_t size() const { return lists.empty() ? 0 : lists.back().begin + lists.back().count; }
};

/// The optical depth of an opacity in 0 .. 1, at most 60: larger depths have opacity 1 as a float or half.
inline float optical_depth_of(float opacity) {
  constexpr double deepest = 60;
  return static_cast<float>(std::min(-std::log1p(-std::min(double{opacity}, 1.0)), deepest));
}

/// The device's result for a list.
struct GlLight {
  float red, green, blue, optical_depth;
  std::uint32_t first;        ///< the first fragment along the ray with optical depth; no_fragment: there is none;
                              ///< rasterized_one: one that the device made
  std::uint32_t front, back;  ///< the keys of a rasterized_one
  float along;                ///< where its light begins, 0 at the front to 1 at the back
  static constexpr std::uint32_t no_fragment = 0xffffffff, rasterized_one = 0xfffffffe;
};
static_assert(sizeof(GlLight) == 32);

/// The parameters by which a frame's fragments become light.
struct GlRules {
  const integrals::LaneTable* table;  ///< of the frame; exists until its tiles are finished
  std::uint32_t frame;                ///< its number; all jobs of a frame have the same rules
  int samples;                        ///< 0: exact
  float least_transmittance;          ///< behind a lower transmittance, nothing is visible
};

}  // namespace tessera::compositor
