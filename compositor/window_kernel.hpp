// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "integrals/lane_table.hpp"
#include "integrals/segment_integrator.hpp"
#include "projection/lattice/lattice_rasterizer.hpp"
#include "projection/lattice/segment_windows.hpp"
#include "projection/pixel_space.hpp"
#include "scene/lattice.hpp"
#include "scene/surface_set.hpp"
#include "scene/trace.hpp"
#include "sorting/window_order.hpp"

namespace tessera::compositor {

/// The pixels of one square while windows of lattice segments go through them, numbered row by row in the rectangle:
/// the light of the run of segments that each is in. For a picture that run is the whole ray.
///
/// Sums are kept in double, segment after segment, so a pixel's bits do not depend on how its segments
/// were cut into windows.
struct WindowState {
  static constexpr std::size_t pixels =
      projection::SegmentWindows::most_pixels + projection::SegmentWindows::pixel_padding;
  static constexpr std::int32_t not_yet = 0x7fffffff;

  alignas(64) std::array<double, pixels> red, green, blue, transmittance;
  alignas(64) std::array<float, pixels> length_per_step;  ///< world units, in the lattice's unit of depth
  alignas(64) std::array<std::int32_t, pixels> open;      ///< -1 or 0: takes nothing any more
  /// The run's first segment with optical depth (or light); first_back is not_yet before there is one.
  alignas(64) std::array<std::int32_t, pixels> first_front, first_back;
  alignas(64) std::array<float, pixels> first_scalar_front, first_scalar_back;

  // Runs only.
  alignas(64) std::array<double, pixels> ray_transmittance;  ///< of the runs before this one
  alignas(64) std::array<std::int32_t, pixels> back;         ///< where the run ends; not_yet: no run
  alignas(64) std::array<std::int32_t, pixels> several;      ///< -1: more than one of its segments shows
  /// A run that shows and has ended.
  struct Run {
    std::uint32_t pixel;
    std::int32_t back;
    bool several;                      ///< false: nothing but `first` shows
    projection::LatticeSegment first;  ///< the segment in which it begins to show
    double red, green, blue, opacity;
  };
  std::vector<Run> ended;

  /// By group of as many pixels as a vector has lanes: rows that the last compositing left, as they were not final.
  std::array<std::int32_t, pixels / 4> rest_rows;

  // Working memory.
  sorting::WindowOrder order;
  std::vector<projection::LatticeSegment> rest;

  /// Empty rays for the pixels of `rect`, all open.
  void start(const scene::PixelRect& rect, const projection::PixelSpace& space);
  /// The run that a pixel is in, one that shows.
  [[nodiscard]] Run run(std::size_t pixel) const;
  /// Ends a pixel's run, if it is in one that shows.
  void end_run(std::size_t pixel);
  /// Which pixels of `rect` are open, as the rasterizer asks. Returns how many.
  int open_pixels(const scene::PixelRect& rect, projection::OpenPixels& open_rows) const;
};

/// Where the planar depth of a segment becomes visible: world units.
double first_visible_depth(const scene::Lattice& lattice, const projection::LatticeSegment& segment,
                           const class integrals::SegmentIntegrator& integrator);

/// How windows are composited.
struct WindowRules {
  const integrals::LaneTable* table;
  double least_transmittance;                   ///< a pixel of less is closed
  bool runs = false;                            ///< segments that do not touch begin a new run
  const scene::SurfaceSet* surfaces = nullptr;  ///< whose crossings are among the segments; null: none are
};

/// Runs end where the next segment's front is further from their back than this. Neighbours' depths are the same to the
/// bit but where double precision took over an edge-on cell: then a few steps of 2^-30 of half the mesh's depth.
constexpr std::int32_t touching_steps = 64;

/// Sorts, integrates and composites, in each pixel's order, all segments of the windows whose front lies before
/// `final_step`, and removes them, 16 pixels at a time, a pixel a lane; groups of pixels none of which has `at_least`
/// segments wait, unless that is 1, and so do groups without full lists that have less than twice what was not final
/// the last time. Returns how many segments are gone, those left out behind opaque ones included.
///
/// Order: front, back, then the scalars, so that what is equal is interchangeable, and no process, partition or thread
/// shows in a pixel's bits. In a mesh whose cells do not overlap only segments of length zero are level.
std::uint64_t composite_windows(const WindowRules& rules, projection::SegmentWindows& windows, std::int64_t final_step,
                                std::size_t at_least, WindowState& state, scene::StageTimer& timer);

}  // namespace tessera::compositor
