// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "integrals/lane_table.hpp"
#include "integrals/segment_batch.hpp"
#include "integrals/segment_integrator.hpp"
#include "projection/lattice/lattice_rasterizer.hpp"
#include "projection/lattice/segment_windows.hpp"
#include "projection/pixel_space.hpp"
#include "scene/lattice.hpp"
#include "scene/surface_set.hpp"
#include "scene/trace.hpp"
#include "sorting/window_order.hpp"

namespace tessera::compositor {

/// The pixels of one square while windows of lattice segments are composited into them, numbered row by row in the
/// rectangle. The state of a pixel is the light of its current run of segments. In an image, this run is the whole ray.
///
/// Sums are in double precision, segment after segment, so a pixel's bits do not depend on how its segments were
/// divided into windows.
struct WindowState {
  static constexpr std::size_t pixels =
      projection::SegmentWindows::most_pixels + projection::SegmentWindows::pixel_padding;
  static constexpr std::int32_t not_yet = 0x7fffffff;

  alignas(64) std::array<double, pixels> red, green, blue, transmittance;
  alignas(64) std::array<float, pixels> length_per_step;  ///< world units per step of the lattice's depth
  alignas(64) std::array<std::int32_t, pixels> open;      ///< -1: the pixel accepts segments; 0: it is closed
  /// The run's first segment with optical depth or light. `first_back` is `not_yet` before there is such a segment.
  alignas(64) std::array<std::int32_t, pixels> first_front, first_back;
  alignas(64) std::array<float, pixels> first_scalar_front, first_scalar_back;

  // The following are only used for runs.
  alignas(64) std::array<double, pixels> ray_transmittance;  ///< transmittance of the ray's runs before this one
  alignas(64) std::array<std::int32_t, pixels> back;         ///< end of the run; not_yet: there is no run
  alignas(64) std::array<std::int32_t, pixels> several;      ///< -1: more than one segment of the run is visible
  /// A visible run that has ended.
  struct Run {
    std::uint32_t pixel;
    std::int32_t back;
    bool several;                      ///< false: only the segment `first` is visible
    projection::LatticeSegment first;  ///< the segment in which it becomes visible
    double red, green, blue, opacity;
  };
  std::vector<Run> ended;

  /// For each group of as many pixels as a vector has lanes: the number of rows that the last compositing left in the
  /// windows because they were not final.
  std::array<std::int32_t, pixels / 4> rest_rows;

  // Working memory.
  sorting::WindowOrder order;
  std::vector<projection::LatticeSegment> rest;
  std::vector<projection::SegmentLight> rest_lights;
  integrals::SegmentBatch batch;
  bool lit = false;           ///< whether the windows contain the lights of segments
  bool is_in_double = false;  ///< whether WindowRules::integrator computes their light

  /// Starts empty rays for the pixels of `rect`, all open.
  void start(const scene::PixelRect& rect, const projection::PixelSpace& space);
  /// The current run of a pixel, which must be visible.
  [[nodiscard]] Run run(std::size_t pixel) const;
  /// Ends a pixel's run, and stores it if it is visible.
  void end_run(std::size_t pixel);
  /// Writes the open pixels of `rect` to `open_rows` in the rasterizer's format. Returns their number.
  int open_pixels(const scene::PixelRect& rect, projection::OpenPixels& open_rows) const;
};

/// The planar depth at which a segment becomes visible, in world units.
double first_visible_depth(const scene::Lattice& lattice, const projection::LatticeSegment& segment,
                           const class integrals::SegmentIntegrator& integrator);

/// The layers of the pixels of a square (integrals/ray_layers.hpp). The state of a pixel is the light of its current
/// layer. Segments in which the layer ends, and segments with an alpha above `most_alpha`, are added in double
/// precision.
class WindowLayers {
 public:
  /// In all layers but the last, lanes do not add segments with a larger alpha (compositor/deep/layer_sink.hpp).
  static constexpr float most_alpha = 0.5f;

  /// A segment that lanes do not add.
  struct End {
    std::uint32_t pixel;
    projection::LatticeSegment segment;
    projection::SegmentLight light;
  };

  WindowLayers() = default;
  WindowLayers(const WindowLayers&) = delete;
  WindowLayers& operator=(const WindowLayers&) = delete;
  virtual ~WindowLayers() = default;

  /// Adds these segments to their pixels, to which all segments in front of them have been added. Updates the state and
  /// the arrays below.
  virtual void add(std::span<const End> ends) = 0;

  /// `end_at`: the transmittance at which the current layer of a pixel ends; `least`: the pixel is closed below this
  /// transmittance. Only the last layer, which never ends, closes the pixel.
  alignas(64) std::array<double, WindowState::pixels> end_at, least;
  /// The last visible segment of the layer. `last_back` is WindowState::not_yet before there is one.
  alignas(64) std::array<std::int32_t, WindowState::pixels> last_front, last_back;
  alignas(64) std::array<float, WindowState::pixels> last_scalar_front, last_scalar_back;
};

struct WindowSamples;  // compositor/deep/window_samples.hpp

/// The parameters of compositing windows.
struct WindowRules {
  const integrals::LaneTable* table;
  double least_transmittance;                   ///< pixels with less transmittance are closed
  bool runs = false;                            ///< segments that do not touch begin a new run
  const scene::SurfaceSet* surfaces = nullptr;  ///< the surfaces whose crossings are among the segments; null: none
  const scene::Lattice* lattice = nullptr;      ///< with `integrator`: the lattice of the segments
  /// If not null, this integrator computes the segments' light, in double precision.
  const integrals::SegmentIntegrator* integrator = nullptr;
  WindowLayers* layers = nullptr;    ///< if not null, the state of a pixel is that of its current layer
  WindowSamples* samples = nullptr;  ///< if not null, deep samples are made, too
};

/// A run ends if the front of the next segment is more than this number of steps from the back of the run. At a shared
/// face, the depths of two cells have the same bits, unless double precision was used for a cell that is seen edge-on:
/// they then differ by a few steps. A step is 2^-30 of half the mesh's depth.
constexpr std::int32_t touching_steps = 64;

/// Sorts, integrates and composites, in each pixel's order, all segments of the windows whose front is before
/// `final_step`, and removes them, one pixel per lane. If `at_least` is not 1, a group of pixels is left for later in
/// two cases. Either all its lists have fewer than `at_least` segments, or no list is full and all are shorter than
/// twice the number of rows that were not final the last time. Returns the number of removed segments, including those
/// left out behind opaque segments.
///
/// Order: front, back, then the scalars. Segments that are equal in all of these are interchangeable, so the bits of
/// the pixels do not depend on processes, partitions or threads. In a mesh whose cells do not overlap, only segments of
/// length zero have equal depths.
std::uint64_t composite_windows(const WindowRules& rules, projection::SegmentWindows& windows, std::int64_t final_step,
                                std::size_t at_least, WindowState& state, scene::StageTimer& timer);

}  // namespace tessera::compositor
