// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "scene/optical_model.hpp"
#include "scene/transfer_function.hpp"

namespace tessera::compositor {

/// A part of a ray segment. Depths are planar; the scalar is linear between front and back.
struct DeepPiece {
  double front, back, scalar_front, scalar_back;
  double optical_depth = 0;  ///< set by PieceCutter: exact for any opacity
};

/// Returns the largest optical depth t of a sample behind `transmittance` whose alpha may be stored as a float. If
/// alpha is rounded by e, cutting at x gives a transmittance with an error of x exp(t (1 - x)) e, at most exp(t - 1) e
/// / t. This error and the resulting error of light (`ratio` is an upper bound of light over alpha) may use a sixteenth
/// of the accuracy. The result is at least 1. An alpha that was rounded to 1 would be opaque however thinly it is cut.
double most_optical_depth(double accuracy, double transmittance, double ratio);

/// Cuts ray segments into pieces so short that each may be cut anywhere as if its matter had constant density.
///
/// Compositing packages cut a volume sample of alpha a and colour C at the fraction x of its depth into
///   a' = 1 - (1 - a)^x,  C' = C a' / a  (a = 0: C' = C x)
/// (OpenEXR, "Interpreting OpenEXR Deep Pixels"). So they assume that the optical depth is linear in z, and light
/// linear in alpha. A wrong cut has light L' instead of L and transmittance T' instead of T, so the error in front of
/// an object of colour up to 1 is at most T_before (|L' - L| + |T' - T|), where T_before is the transmittance of
/// everything before the piece. Pieces keep this below accuracy / 2; merging them (deep_fragments.hpp) may use a
/// quarter, and the rounding of alpha to float a sixteenth.
///
/// Between knots of the transfer function, extinction and colour are linear in z. In a piece of world length l, let the
/// extinction change by dk and the colour by dc (the largest change of a channel), with colours up to c:
/// - the optical depth is a parabola, which differs from its chord by d = dk l / 8 at most, and |T' - T| <= d;
/// - absorption: L as a function of alpha has slopes (the colour) that differ by dc at most, so it differs from its
///   chord by dc a / 4, and |L' - L| <= dc a / 4 + c d, where a is at most the optical depth;
/// - independent emission: dL = c T dt, and with the share of the light before z instead of alpha,
///   |L' - L| <= l (dc + 2 c d) / 4 for d <= 1.
/// All of these decrease with the square of the piece's length or faster, which determines the length directly. Pieces
/// behind a transmittance that hides any error are not cut. This transmittance is computed from the segments that this
/// process has of the pixel; segments of other processes in front of them can only reduce it.
class PieceCutter {
 public:
  PieceCutter(const scene::TransferFunction& function, scene::Emission emission, double accuracy);

  /// Appends the pieces of one segment that contain light or optical depth, front to back. They touch with the same
  /// bits, except where the transfer function is zero. `length_per_depth` is the world length per planar depth of the
  /// pixel's ray. `transmittance` is the transmittance before the segment; the call changes it to the transmittance
  /// behind the segment.
  void cut(const DeepPiece& segment, double length_per_depth, double& transmittance,
           std::vector<DeepPiece>& pieces) const;

 private:
  struct Optics {
    double extinction;
    std::array<double, 3> color;
  };
  /// The function's value at `s`, by linear continuation from the interval after knot `interval` (0: the interval below
  /// the first knot).
  [[nodiscard]] Optics optics(std::size_t interval, double s) const;
  void cut_linear(const DeepPiece& stretch, const Optics& a, const Optics& b, double length_per_depth,
                  double& transmittance, std::vector<DeepPiece>& pieces) const;

  std::vector<scene::Knot> knots_;
  bool independent_;
  double accuracy_;
};

}  // namespace tessera::compositor
