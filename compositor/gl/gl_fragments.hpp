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

/// Fragments of a tile for a device, pixel by pixel; the fragments of one pixel may be in any order.
struct GlFragments {
  /// The fragments of a pixel are [begin, begin + count). The device makes the last `rasterized` of them; the others
  /// are given.
  struct List {
    std::uint32_t pixel;  ///< row by row in the tile
    std::uint32_t begin, count;
    std::uint32_t rasterized = 0;
  };
  int width = 0;            ///< width of the tile, in pixels
  std::vector<List> lists;  ///< no list is empty; `pixel` and `begin` ascend
  /// One per given fragment. `element` is the fragment's position in the lists (without cells, this is its index).
  std::vector<sorting::GlKey> keys;
  /// One per given fragment: a ray segment {length, scalar at entry, scalar at exit, -1}, in the table's units; or a
  /// run {red, green, blue, optical depth}.
  std::vector<std::array<float, 4>> values;
  /// The input for the `rasterized` fragments: the cells, the pixels of the frame that the lists cover (whole rows of
  /// the tile, or part of one row), and the index of the first of these pixels in the tile. Null: there are no such
  /// fragments.
  std::shared_ptr<const GlCells> cells{};
  scene::PixelRect rect{};
  std::uint32_t first_pixel = 0;

  /// Number of fragments, including those that the device makes.
  [[nodiscard]] std::size_t size() const { return lists.empty() ? 0 : lists.back().begin + lists.back().count; }
};

/// Returns the optical depth of an opacity in 0 .. 1, limited to 60: at larger depths, the opacity is 1 as a float or
/// half.
inline float optical_depth_of(float opacity) {
  constexpr double deepest = 60;
  return static_cast<float>(std::min(-std::log1p(-std::min(double{opacity}, 1.0)), deepest));
}

/// The device's result for a list.
struct GlLight {
  float red, green, blue, optical_depth;
  std::uint32_t first;        ///< the first fragment along the ray with optical depth; no_fragment: there is none;
                              ///< rasterized_one: the device made it
  std::uint32_t front, back;  ///< keys of the first fragment if it is a rasterized_one
  float along;  ///< position in the first fragment where its light begins, from 0 at its front to 1 at its back
  static constexpr std::uint32_t no_fragment = 0xffffffff, rasterized_one = 0xfffffffe;
};
static_assert(sizeof(GlLight) == 32);

/// The parameters that determine how the fragments of a frame become light.
struct GlRules {
  const integrals::LaneTable* table;  ///< table of the frame; it exists until the frame's tiles are finished
  std::uint32_t frame;                ///< number of the frame; all jobs of a frame have the same rules
  int samples;                        ///< samples per segment; 0: exact integration
  float least_transmittance;          ///< behind a lower transmittance, nothing is visible
};

}  // namespace tessera::compositor
