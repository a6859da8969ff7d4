// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "compositor/tile_scene.hpp"
#include "compositor/window_kernel.hpp"
#include "integrals/segment_batch.hpp"
#include "projection/surface_crossings.hpp"
#include "sorting/encodings.hpp"

namespace tessera::compositor {

/// A crossing of a surface in a batch of segments. It takes the place of a segment; its light is set after integration.
struct CrossingInBatch {
  std::size_t at;
  projection::Crossing crossing;
  double value;  ///< the field's value at the crossing, or the value of the surface
};
/// Applies the light that falls on the tet of segment `at` of a batch. Must be called after integration.
inline void light_segment(const projection::MatterLight::Light& light, std::size_t at, double optical_depth,
                          integrals::SegmentBatch& batch) {
  const double white = light.white * -std::expm1(-optical_depth);
  for (auto* color : {&batch.red, &batch.green, &batch.blue}) (*color)[at] = light.own * (*color)[at] + white;
}

/// Sets the light of crossings, which the integrator has treated as segments of length zero.
void light_crossings(const scene::SurfaceSet& surfaces, std::span<const CrossingInBatch> crossings,
                     integrals::SegmentBatch& batch);

/// The pixels of a rectangle while segments are composited into them, front to back. The whole ray of a pixel is one
/// run; with `runs`, a new run begins wherever a segment does not touch the previous one.
///
///   start(rect)                          makes all pixels empty and open
///   take(store, final, at_least, timer)  composites the final segments and removes them; returns the number removed
///   open(), any_open()                   the pixels that are open. A pixel is closed, and accepts no more segments,
///                                        once everything behind its segments would change it by less than the
///                                        integrator's termination error
///   value(p)                             returns a pixel of an image
///   ended, end_runs()                    with runs: the visible runs that have ended; ends all runs
///   keep_open()                          with runs: no pixel is closed until the next start(), because segments that
///                                        hide the pixel may belong behind segments that come later
///
/// There are two specializations, because each encoding has its own arithmetic: lists of doubles here, and on the
/// lattice one pixel per lane (window_kernel.hpp). compositor/README.md states how much faster the second one is.
template <class Encoding>
class TilePixels;

/// Sums are in double precision, including optical depth. The opacity is -expm1(-optical depth), so that a hundred
/// thousand segments of opacity 1e-9 add up, and 1 - 1e-8 is not rounded to 1.
template <>
class TilePixels<sorting::DoubleEncoding> {
 public:
  /// Runs touch if the back of one run equals the front of the other bit for bit. This holds for neighbouring cells,
  /// which compute a shared face from the same numbers.
  struct Run {
    std::uint32_t pixel = 0;
    bool begun = false;                                      ///< false: the run has no segment yet
    double front = std::numeric_limits<double>::infinity();  ///< depth where the run becomes visible
    double back = 0;
    double red = 0, green = 0, blue = 0, transmittance = 1, optical_depth = 0;
    [[nodiscard]] bool visible() const { return optical_depth > 0 || red != 0 || green != 0 || blue != 0; }
  };
  std::vector<Run> ended;

  TilePixels(const TileScene& scene, bool runs) : scene_(scene), runs_(runs) {}

  void start(const scene::PixelRect& rect);
  std::uint64_t take(sorting::SegmentLists& lists, double final_depth, std::size_t /*at_least*/,
                     scene::StageTimer& timer) {
    composite(lists, final_depth, timer);
    return lists.remove(final_depth, open_);
  }
  /// Same as take(), but does not remove segments.
  void composite(sorting::SegmentLists& lists, double final_depth, scene::StageTimer& timer);

  [[nodiscard]] const std::vector<std::uint8_t>& open() const { return open_; }
  [[nodiscard]] bool any_open() const { return open_count_ > 0; }
  void keep_open() { closes_ = false; }
  void end_runs();
  [[nodiscard]] PixelValue value(std::size_t pixel) const;

 private:
  void integrate(const sorting::SegmentLists& lists, double final_depth);
  void light_matter(const sorting::SegmentLists& lists, double final_depth);
  template <bool runs>
  void add(const sorting::SegmentLists& lists, double final_depth);
  void end(Run& run);

  TileScene scene_;
  bool runs_, closes_ = true;
  scene::PixelRect rect_{0, 0, 0, 0};
  std::vector<Run> pixels_;
  std::vector<double> transmittance_;  ///< transmittance of each ray: the product over its runs so far
  std::vector<double> length_per_depth_;
  std::vector<std::uint8_t> open_;
  std::size_t open_count_ = 0;
  integrals::SegmentBatch batch_;
  std::vector<CrossingInBatch> crossings_;
};

template <>
class TilePixels<sorting::LatticeEncoding> {
 public:
  using Run = WindowState::Run;

  TilePixels(const TileScene& scene, bool runs)
      : scene_(scene), rules_{scene.table, scene.least_transmittance(), runs, scene.surfaces} {
    rules_.lattice = &scene_.lattice;
    if (!scene.integrator->is_exact()) rules_.integrator = scene.integrator;
  }

  TilePixels(const TilePixels&) = delete;  // the rules refer to members
  TilePixels& operator=(const TilePixels&) = delete;
  /// Also makes the deep samples of the pixels, in `samples`, which must outlive this object.
  TilePixels(const TileScene& scene, WindowSamples& samples) : TilePixels(scene, false) { rules_.samples = &samples; }

  void start(const scene::PixelRect& rect);
  std::uint64_t take(projection::SegmentWindows& windows, std::int64_t final_step, std::size_t at_least,
                     scene::StageTimer& timer) {
    const std::uint64_t gone = composite_windows(rules_, windows, final_step, at_least, state_, timer);
    open_count_ = state_.open_pixels(rect_, open_);
    timer.record("composite");
    return gone;
  }

  [[nodiscard]] const projection::OpenPixels& open() const { return open_; }
  [[nodiscard]] bool any_open() const { return open_count_ > 0; }
  void keep_open() { rules_.least_transmittance = 0; }
  void end_runs();
  [[nodiscard]] PixelValue value(std::size_t pixel) const;

  /// state().ended contains the runs that have ended; the other runs can be read from the state, too.
  [[nodiscard]] WindowState& state() { return state_; }

 private:
  TileScene scene_;
  WindowRules rules_;
  scene::PixelRect rect_{0, 0, 0, 0};
  projection::OpenPixels open_{};
  int open_count_ = 0;
  WindowState state_;
};

}  // namespace tessera::compositor
