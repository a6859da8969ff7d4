// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace tessera {
inline namespace v0_1 {

/// Whether a picture keeps what its method promises, as some of its pixels tell. Errors are absolute differences in
/// linear premultiplied RGBA to the double-precision reference.
///
/// Excused  a pixel over the bound whose value lies inside the reference's range over rays within 1/1024 pixel of its
///          centre: the picture is discontinuous there (docs/ACCURACY.md).
struct Verification {
  /// What was found in the pixels chosen for one reason.
  struct Tally {
    std::string reason;  ///< "random", "edge", "step", "tie", ...
    std::size_t pixels = 0;
    double max_error = 0;  ///< excused pixels included
    std::size_t over_bound = 0, excused = 0;
  };

  std::size_t pixels_checked = 0, over_bound = 0, excused = 0;
  double max_error = 0, max_error_not_excused = 0;
  double rms_error = 0;  ///< of the pixels chosen at random: an estimate of the picture's
  int worst_x = 0, worst_y = 0;
  std::array<float, 4> worst_value{};
  std::array<double, 4> worst_reference{};
  std::string worst_reason;       ///< why the worst pixel was chosen
  std::vector<Tally> tallies;     ///< those at random first
  std::optional<double> bound{};  ///< none: errors are reported, nothing is promised
  /// Of a picture in layers, one each from the eye on: the same pixels, to the bound below.
  std::vector<Tally> layers{};
  double layer_bound = 0;
  bool layers_met = true;
  /// No pixel is over the bound but excused ones, of which there are not too many; of layers likewise.
  bool met = true;
};

}  // namespace v0_1
}  // namespace tessera
