// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "scene/optical_model.hpp"
#include "scene/transfer_function.hpp"

namespace tessera::compositor {

/// A stretch of a ray segment. Planar depths; the scalar is linear in between.
struct DeepPiece {
  double front, back, scalar_front, scalar_back;
  double optical_depth = 0;  ///< of a piece that PieceCutter made: exact, however opaque
};

/// The largest optical depth t of a sample behind `transmittance` whose alpha may be a float. Where alpha rounds by e,
/// cutting at x gives a transmittance off by x exp(t (1 - x)) e, at most exp(t - 1) e / t; that, and as much light as
/// goes with it (`ratio` bounds light over alpha), may take a sixteenth of the accuracy. An alpha that has become 1
/// would be opaque however thin it is cut. At least 1.
double most_optical_depth(double accuracy, double transmittance, double ratio);

/// Cuts ray segments into pieces so short that each may be cut anywhere as if its matter had constant density.
///
/// Compositing packages cut a volume sample of alpha a and colour C at the fraction x of its depth into
///   a' = 1 - (1 - a)^x,  C' = C a' / a  (a = 0: C' = C x)
/// (OpenEXR, "Interpreting OpenEXR Deep Pixels"). So they take the optical depth as linear in z, and the light as
/// linear in alpha. What a wrong cut does to a picture: light L' for L and transmittance T' for T, so in front of
/// something of colour up to 1 an error of at most T_before (|L' - L| + |T' - T|), where T_before is the transmittance
/// of all before the piece. Pieces keep this below accuracy / 2; merging them (deep_fragments.hpp) has a quarter, and
/// the rounding of alpha to float a sixteenth.
///
/// Between knots of the transfer function extinction and colour are linear in z. In a piece of world length l, over
/// which the extinction changes by dk and the colour by dc (the largest of its channels), with colours up to c:
/// - the optical depth is a parabola, off its chord by d = dk l / 8 at most, and |T' - T| <= d;
/// - absorption: L as a function of alpha has slopes (the colour) that differ by dc at most, so it is off its chord by
///   dc a / 4, and |L' - L| <= dc a / 4 + c d, where a is at most the optical depth;
/// - independent emission: dL = c T dt, and with the share of the light before z in place of alpha,
///   |L' - L| <= l (dc + 2 c d) / 4 for d <= 1.
/// All of these shrink with the square of the piece's length or faster, which gives the length at once. Pieces behind
/// transmittance that hides any error are not cut; the transmittance here is that of this pixel's own segments, and
/// what other processes have before them only makes it smaller.
class PieceCutter {
 public:
  PieceCutter(const scene::TransferFunction& function, scene::Emission emission, double accuracy);

  /// Appends the pieces of one segment that carry anything, front to back: they touch, with the same bits, but where
  /// the transfer function is zero. `length_per_depth` is the pixel's. `transmittance` is that before the segment, and
  /// after the call that behind it.
  void cut(const DeepPiece& segment, double length_per_depth, double& transmittance,
           std::vector<DeepPiece>& pieces) const;

 private:
  struct Optics {
    double extinction;
    std::array<double, 3> color;
  };
  /// The function at `s` as it is on the interval after knot `interval` (0: below the first).
  [[nodiscard]] Optics optics(std::size_t interval, double s) const;
  void cut_linear(const DeepPiece& stretch, const Optics& a, const Optics& b, double length_per_depth,
                  double& transmittance, std::vector<DeepPiece>& pieces) const;

  std::vector<scene::Knot> knots_;
  bool independent_;
  double accuracy_;
};

}  // namespace tessera::compositor
