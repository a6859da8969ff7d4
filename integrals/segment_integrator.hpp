// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "integrals/piecewise_table.hpp"
#include "integrals/psi_table.hpp"
#include "integrals/segment_batch.hpp"
#include "integrals/segment_table.hpp"
#include "scene/optical_model.hpp"
#include "scene/transfer_function.hpp"

namespace tessera::integrals {

/// `exact`: a segment is cut where its scalar crosses a knot, and pieces of more than one optical depth are cut again.
/// Over a piece, extinction and colour are linear in the position u, so the optical depth is a quadratic q(u).
/// Integration by parts gives
///   int kappa c exp(-q) = c_0 (1 - M) + c_1 (M - T),  M = int_0^1 exp(-q(u)) du,  T = exp(-q(1)).
/// One integral serves all three colours, and it is not needed where the colour is constant. M has no closed form
/// without erf or Dawson's function and their cancellations. Gauss-Legendre quadrature needs 3 points below an optical
/// depth of 0.05 and 6 points up to 1: because q' and q'' are at most twice the optical depth, the error terms
///   f^(2n)(xi) (n!)^4 / ((2n+1) ((2n)!)^3)
/// are below 1e-8. Integration ends where the transmittance falls below 1e-10.
///
/// `auto` may use thicker pieces and end sooner (only for emission by absorption, where opacity bounds the light):
///   - Because q' >= 0, q = D (w u + (1 - w) u^2) with w in [0, 2]. Over all w, the error of quadrature with six points
///     is at most 6e-10, 4e-8, 5e-7, 3e-6, 3e-5 times 1 - exp(-D) for D = 1, 2, 3, 4, 6. The opacity that a ray
///     accumulates is at most 1, so the error of all its pieces is at most this factor (6e-10 to 3e-5) times the
///     largest colour.
///   - Where the transmittance has fallen to t, the remaining light is at most t times the largest colour, and the
///     remaining opacity is at most t.
///
/// scene/error_budget.hpp defines the share of the error that each of these two may use.
struct ExactPieces {
  double optical_depth = 1;      ///< largest optical depth of a piece
  double transmittance = 1e-10;  ///< transmittance of a segment below which the rest is omitted
  [[nodiscard]] static ExactPieces within(double accuracy, double max_color);
};

/// Computes the light and optical depth of ray segments: the volume rendering integral over each segment (Max, "Optical
/// Models for Direct Volume Rendering", 1995), for a transfer function that is piecewise linear in the scalar.
class SegmentIntegrator {
 public:
  /// The integrator must be valid for meshes (tessera::validate). The constructor builds the tables; copies share them.
  SegmentIntegrator(const scene::TransferFunction& function, const scene::Integrator& integrator,
                    scene::Emission emission);

  /// Fills the batch's outputs. Each segment's result depends only on the segment.
  void integrate(SegmentBatch& batch) const;

  /// Returns the position along a segment, from 0 at its front to 1 at its back, at which the extinction first becomes
  /// positive; empty if there is no such position.
  [[nodiscard]] std::optional<double> first_visible(double scalar_front, double scalar_back) const;

  /// Whether the integrator is `exact` or `auto`.
  [[nodiscard]] bool is_exact() const { return samples_ == 0 && !segments_ && !psi_; }

  /// Name of the integrator that is used: "exact", "sampled:16", "preintegrated:128" or "partial".
  [[nodiscard]] std::string name() const;

  /// Samples per segment of the `sampled` integrator; 0 for all others.
  [[nodiscard]] int samples() const { return samples_; }

  /// The largest error in linear RGBA that early termination of a ray may cause. 0: rays never terminate early.
  [[nodiscard]] double termination_error() const { return termination_error_; }

 private:
  PiecewiseTable table_;
  scene::Emission emission_;
  int samples_ = 0;  ///< 0: the integrator is not `sampled`
  ExactPieces pieces_;
  // At most one of these is set; `exact` and `auto` use neither.
  std::shared_ptr<const SegmentTable> segments_;
  std::shared_ptr<const PsiTable> psi_;
  double termination_error_;
};

/// Upper bound of the light or opacity that the rest of a ray can add, for the worst channel of linear RGBA, if nothing
/// in front attenuates it. Early termination compares the product of this bound and the ray's transmittance to the
/// allowed error. With independent emission, light grows with the length of the ray.
double opacity_weight(double max_color, double longest_ray, scene::Emission emission);

/// The `exact` integrator, and, with other limits of its pieces, the `auto` integrator.
void integrate_exact(const PiecewiseTable& table, scene::Emission emission, SegmentBatch& batch,
                     const ExactPieces& pieces = {});

/// `sampled:Ns`: takes Ns samples at the midpoints of Ns equal steps of length / Ns, each step homogeneous (Juliachs et
/// al. 2007, 4.3; dx = 1 / Ns in the paper is read as l / Ns, which the paper's remark on null elements requires).
void integrate_sampled(const PiecewiseTable& table, scene::Emission emission, int samples, SegmentBatch& batch);

/// `preintegrated:N`: one lookup per segment in a table of the transfer function (segment_table.hpp).
void integrate_preintegrated(const SegmentTable& table, scene::Emission emission, SegmentBatch& batch);

/// `partial` (Moreland and Angel 2004): cuts segments at the knots like `exact`, and takes M, which the paper calls
/// Psi, from a table that does not depend on the transfer function (psi_table.hpp). The result is exact where the
/// colour is constant. Elsewhere the error is that of Psi times the change of colour. It does not shrink with the
/// segment, so it accumulates over many thin segments. Supports only emission by absorption.
void integrate_partial(const PiecewiseTable& table, const PsiTable& psi, SegmentBatch& batch);

}  // namespace tessera::integrals
