// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace tessera {
inline namespace v0_1 {

/// The result of checking on some pixels whether an image meets the promised error of its method. Errors are absolute
/// differences from the double-precision reference, in linear premultiplied RGBA.
///
/// Excused  The image is discontinuous at some pixels (docs/ACCURACY.md). A pixel whose error is above the bound is
///          excused if its value is within the range of the reference's results for rays within 1/1024 pixel of the
///          pixel's centre.
struct Verification {
  /// Result for the pixels that were chosen for one reason.
  struct Tally {
    std::string reason;  ///< "random", "edge", "step", "tie", ...
    std::size_t pixels = 0;
    double max_error = 0;  ///< including excused pixels
    std::size_t over_bound = 0, excused = 0;
  };

  std::size_t pixels_checked = 0, over_bound = 0, excused = 0;
  double max_error = 0, max_error_not_excused = 0;
  double rms_error = 0;  ///< root mean square error of the pixels chosen at random, an estimate for the whole image
  int worst_x = 0, worst_y = 0;
  std::array<float, 4> worst_value{};
  std::array<double, 4> worst_reference{};
  std::string worst_reason;       ///< why the worst pixel was chosen
  std::vector<Tally> tallies;     ///< the tally of the random pixels is first
  std::optional<double> bound{};  ///< the promised error; none: errors are only reported
  /// For an image in layers: one tally per layer, the first for the layer at the eye. The same pixels of each layer are
  /// compared with `layer_bound`.
  std::vector<Tally> layers{};
  double layer_bound = 0;
  bool layers_met = true;
  /// Whether only excused pixels have errors above the bound, and there are few excused pixels. The same is required of
  /// layers.
  bool met = true;
};

}  // namespace v0_1
}  // namespace tessera
