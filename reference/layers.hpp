// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "reference/ray_reference.hpp"
#include "tessera/settings.hpp"

/// Opacity peeling (tessera::Peel), implemented separately for the reference. The integral along a ray restarts each
/// time its optical depth since the last restart reaches -log(1 - threshold). The last layer contains the rest of the
/// ray.
namespace tessera::reference {

/// The sums of an integral since the last cut between layers.
struct LayerSum {
  std::array<double, 3> color{0, 0, 0};  ///< linear RGB, premultiplied, without what is in front of the cut
  double optical_depth = 0;
  double first_visible_depth = std::numeric_limits<double>::infinity();
};

/// The layers that a ray has completed, and whether it may complete another.
class LayerCuts {
 public:
  explicit LayerCuts(const Peel& peel)
      : limit_(-std::log1p(-peel.threshold)), count_(static_cast<std::size_t>(peel.layers)) {}

  /// Whether the current layer ends at or before this optical depth. Tolerates rounding, which occurs for example if
  /// the combined opacity of surfaces equals the threshold.
  [[nodiscard]] bool ends(double optical_depth) const {
    constexpr double granted = 1e-12;
    return ended_.size() + 1 < count_ && optical_depth >= limit_ * (1 - granted);
  }
  [[nodiscard]] double limit() const { return limit_; }
  void end(LayerSum& sum) {
    ended_.push_back(sum);
    sum = {};
  }

  /// Returns the position in [u0, u1] of a segment at which the layer ends. optical_depth(u) must increase with u, and
  /// ends() must be true at u1. Bisection down to neighbouring doubles.
  template <class OpticalDepth>
  [[nodiscard]] double place(double u0, double u1, const OpticalDepth& optical_depth) const {
    double low = u0, high = u1;
    while (true) {
      const double middle = low + (high - low) / 2;
      if (!(middle > low && middle < high)) return high;
      (optical_depth(middle) < limit_ ? low : high) = middle;
    }
  }

  /// Returns all layers of a ray, including the current one. Layers that the ray does not reach are empty.
  [[nodiscard]] std::vector<Pixel> pixels(const LayerSum& at_hand) const;

 private:
  double limit_;
  std::size_t count_;
  std::vector<LayerSum> ended_;
};

/// A reference solution for layers.
class LayerReference {
 public:
  virtual ~LayerReference() = default;

  /// Returns the Peel::layers layers of the ray through pixel coordinates (x, y). Callable from any thread.
  [[nodiscard]] virtual std::vector<Pixel> layers(double x, double y, const Peel& peel) const = 0;

  /// Returns the layers of the rays through the centres of `wanted`, in that order. `threads` 0: all cores.
  [[nodiscard]] virtual std::vector<std::vector<Pixel>> layers(std::span<const PixelIndex> wanted, const Peel& peel,
                                                               int threads = 0) const = 0;

 protected:
  LayerReference() = default;
  LayerReference(const LayerReference&) = default;
  LayerReference& operator=(const LayerReference&) = default;
};

}  // namespace tessera::reference
