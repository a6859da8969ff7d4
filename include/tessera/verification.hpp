// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace tessera {
inline namespace v0_1 {

/// Whether an image meets its method's promised error, checked on some of its pixels. Errors are absolute differences
/// in linear premultiplied RGBA from the double-precision reference.
///
/// Excused  a pixel over the bound whose value is within the reference's range over rays within 1/1024 pixel of its
///          centre: the image is discontinuous there (docs/ACCURACY.md).
struct Verification {
  /// Result for the pixels chosen for one reason.
  struct Tally {
    std::string reason;  ///< "random", "edge", "step", "tie", ...
    std::size_t pixels = 0;
    double max_error = 0;  ///< including excused pixels
    std::size_t over_bound = 0, excused = 0;
  };

  std::size_t pixels_checked = 0, over_bound = 0, excused = 0;
  double max_error = 0, max_error_not_excused = 0;
  double rms_error = 0;  ///< of the pixels chosen at random: an estimate for the image
  int worst_x = 0, worst_y = 0;
  std::array<float, 4> worst_value{};
  std::array<double, 4> worst_reference{};
  std::string worst_reason;       ///< why the worst pixel was chosen
  std::vector<Tally> tallies;     ///< the random ones first
  std::optional<double> bound{};  ///< none: errors are reported, but nothing is promised
  /// For an image in layers, one each starting at the eye: the same pixels, against `layer_bound`.
  std::vector<Tally> layers{};
  double layer_bound = 0;
  bool layers_met = true;
  /// No pixel is over the bound except excused ones, and these are few; the same for layers.
  bool met = true;
};

}  // namespace v0_1
}  // namespace tessera
