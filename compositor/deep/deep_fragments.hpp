// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

namespace tessera::compositor {

/// An interval with matter on one pixel's ray. Depths are planar; the linear light is that which leaves the front of
/// the interval, not attenuated by what is in front of the interval.
struct DeepSample {
  double front, back;
  std::array<double, 3> light;  ///< red, green, blue
  double optical_depth;
};

/// Merges the integrated pieces of one pixel (deep_pieces.hpp), front to back, into as few samples as possible that may
/// still be cut anywhere with an error below the accuracy. The algorithm is greedy, takes one piece at a time, and
/// needs constant memory. So the samples do not depend on the batches in which pieces arrive.
///
/// A sample of optical depth t and light C between z0 and z1 is cut as if the optical depth were s (z - z0) with
/// s = t / (z1 - z0), and the light S alpha with S = C / alpha(t). At the joints z_k between its pieces, the true
/// optical depth t_k and light L_k are known, so the differences are bounded if s and S are in cones through z0:
///   |t_k - s (z_k - z0)| <= w_k    and    |L_k - S alpha(t_k)| <= e_light  in each channel.
/// Every joint narrows the two intervals of allowed s and S; a piece is added to the sample if the resulting s and S
/// are in them. Within a piece, the logarithms of both transmittances are linear in z, so they differ most at a joint;
/// with w_k = log1p(e_T / T_(k-1)), the transmittances differ by at most e_T on both sides of the joint. The code uses
/// 2 x / (2 + x), a lower bound of log1p(x). Within a piece, light is linear in the alpha of the piece, so L - S alpha
/// is largest at a joint, too, and |S alpha - S alpha'| <= S e_T. The error of a cut is at most T_before (e_light +
/// (1 + S) e_T), plus the pieces' own half: e_light = accuracy / (4 T_before) and e_T = e_light / (1 + S_most). The
/// sample ends before a piece with more light per alpha than S_most, and before a piece that would make the sample more
/// opaque than a float's alpha can represent (most_optical_depth).
///
/// Pieces without optical depth, which independent emission creates, are kept separate: their light is linear in z.
/// Pieces are only merged if they touch with the same bits. If cells overlap, which is invalid, a piece may begin
/// before the end of the last one; it is then moved behind the last one.
class DeepMerger {
 public:
  explicit DeepMerger(double accuracy) : accuracy_(accuracy) {}

  /// Takes the next piece along the ray. If the piece ends the current sample, appends that sample. A `surface` has no
  /// thickness and is not merged.
  void add(const DeepSample& piece, std::vector<DeepSample>& samples, bool surface = false);

  /// Appends the last sample, if one has begun.
  void end(std::vector<DeepSample>& samples);

  /// Transmittance of all pieces so far.
  [[nodiscard]] double transmittance() const { return transmittance_; }

 private:
  [[nodiscard]] bool extend(const DeepSample& piece);

  double accuracy_;
  double transmittance_ = 1;  ///< transmittance behind the last piece
  bool begun_ = false, absorbs_ = false;
  DeepSample sample_{};
  double alpha_ = 0, last_alpha_ = 0;  ///< alpha of the sample, and of the sample before its last piece
  double light_error_ = 0, transmittance_error_ = 0, most_ratio_ = 0, most_depth_ = 0;
  double slope_low_ = 0, slope_high_ = 0;
  std::array<double, 3> light_low_{}, light_high_{};
};

}  // namespace tessera::compositor
