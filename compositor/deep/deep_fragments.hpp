// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

namespace tessera::compositor {

/// A stretch of one pixel's ray with matter in it. Planar depths; linear light that leaves its front, not attenuated by
/// what lies before it.
struct DeepSample {
  double front, back;
  std::array<double, 3> light;  ///< red, green, blue
  double optical_depth;
};

/// Merges one pixel's integrated pieces (deep_pieces.hpp), front to back, into as few samples as may still be cut
/// anywhere at an error below the accuracy. Greedy, in constant memory, a piece at a time: so the samples do not depend
/// on how pieces come in batches.
///
/// A sample of optical depth t and light C between z0 and z1 is cut as if the optical depth were s (z - z0) with
/// s = t / (z1 - z0), and the light S alpha with S = C / alpha(t). At the joints z_k between its pieces the true
/// optical depth t_k and light L_k are known, so they may differ if s and S lie in cones through z0:
///   |t_k - s (z_k - z0)| <= w_k    and    |L_k - S alpha(t_k)| <= e_light  in each channel.
/// Every joint narrows the two intervals; a piece is taken in while the sample's own s and S lie in them. Within a
/// piece the logarithms of both transmittances are linear in z, so they differ most at a joint; with w_k = log1p(e_T /
/// T_(k-1)) the transmittances differ by at most e_T on both sides of it. In a piece light is linear in its alpha, so L
/// - S alpha is largest at a joint too, and |S alpha - S alpha'| <= S e_T. The cut errs by at most T_before (e_light +
/// (1 + S) e_T), plus the pieces' own half: e_light = accuracy / (4 T_before) and e_T = e_light / (1 + S_most), where a
/// piece with more light for its alpha than S_most ends the sample. So does one with which the sample would be more
/// opaque than a float's alpha tells (most_optical_depth).

///
/// Pieces without optical depth, which independent emission has, keep to themselves: their light is linear in z.
/// Pieces that do not touch to the bit are never merged. A piece that begins before the last one's end, as overlapping
/// (invalid) cells give, is moved behind it.
class DeepMerger {
 public:
  explicit DeepMerger(double accuracy) : accuracy_(accuracy) {}

  /// The next piece along the ray. Appends the sample that it ends, if it does.
  /// A `surface` is a point, which stays one.
  void add(const DeepSample& piece, std::vector<DeepSample>& samples, bool surface = false);

  /// Appends the last sample, if one is begun.
  void end(std::vector<DeepSample>& samples);

  /// Of all pieces so far.
  [[nodiscard]] double transmittance() const { return transmittance_; }

 private:
  [[nodiscard]] bool extend(const DeepSample& piece);

  double accuracy_;
  double transmittance_ = 1;  ///< behind the last piece
  bool begun_ = false, absorbs_ = false;
  DeepSample sample_{};
  double last_depth_ = 0;  ///< optical depth of the sample before its last piece
  double light_error_ = 0, transmittance_error_ = 0, most_ratio_ = 0, most_depth_ = 0;
  double slope_low_ = 0, slope_high_ = 0;
  std::array<double, 3> light_low_{}, light_high_{};
};

}  // namespace tessera::compositor
