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
/// Over a piece extinction and colour are linear in the position u, so the optical depth is a quadratic q(u) and, by
/// parts,
///   int kappa c exp(-q) = c_0 (1 - M) + c_1 (M - T),  M = int_0^1 exp(-q(u)) du,  T = exp(-q(1)).
/// One integral serves all three colours; where the colour is constant it drops out. M has no closed form without erf
/// or Dawson's function and their cancellations; Gauss-Legendre needs 3 points below an optical depth of 0.05 and 6 up
/// to 1: with q' and q'' at most twice the optical depth, the error terms f^(2n)(xi) (n!)^4 / ((2n+1) ((2n)!)^3) are
/// below 1e-8. Pieces end where the transmittance falls below 1e-10.
///
/// `auto` may cut pieces longer and end them sooner (absorption alone, where light is bounded by opacity):
///   - With q' >= 0, q = D (w u + (1 - w) u^2) with w in [0, 2]: six points err by at most e(D), the largest over w,
///     6e-10, 4e-8, 5e-7, 3e-6, 3e-5 times 1 - exp(-D) for D = 1, 2, 3, 4, 6. What rays gather along their way of
///     1 - exp(-D) is at most 1, so that all pieces of a ray err by that number times the largest colour.
///   - Behind transmittance t there is light of at most t times the largest colour, and opacity of at most t.
/// scene/error_budget.hpp says what each may take.
struct ExactPieces {
  double optical_depth = 1;      ///< of a piece, at most
  double transmittance = 1e-10;  ///< of a segment, from which on the rest is left out
  [[nodiscard]] static ExactPieces within(double accuracy, double max_color);
};

/// Light and optical depth of ray segments: the volume rendering integral over each (Max, "Optical Models for Direct
/// Volume Rendering", 1995), for a transfer function that is piecewise linear in the scalar.
class SegmentIntegrator {
 public:
  /// Of an integrator that is valid for meshes (tessera::validate). Tables are made here and shared by copies.
  SegmentIntegrator(const scene::TransferFunction& function, const scene::Integrator& integrator,
                    scene::Emission emission);

  /// Fills the batch's outputs. Each segment's result depends on that segment alone.
  void integrate(SegmentBatch& batch) const;

  /// Where along a segment, 0 at its front to 1 at its back, the extinction first becomes positive; none if nowhere.
  [[nodiscard]] std::optional<double> first_visible(double scalar_front, double scalar_back) const;

  /// The form that runs: "exact", "sampled:16", "preintegrated:128" or "partial".
  [[nodiscard]] std::string name() const;

  /// Of the sampled form; 0: exact.
  [[nodiscard]] int samples() const { return samples_; }

  /// What a ray may leave out behind nearly opaque matter: largest error in linear RGBA by early termination.
  /// 0: nothing, no pixel is ever closed.
  [[nodiscard]] double termination_error() const { return termination_error_; }

 private:
  PiecewiseTable table_;
  scene::Emission emission_;
  int samples_ = 0;  ///< 0: not sampled
  ExactPieces pieces_;
  // At most one of them; none and no samples: exact.
  std::shared_ptr<const SegmentTable> segments_;
  std::shared_ptr<const PsiTable> psi_;
  double termination_error_;
};

/// What may still come behind a pixel of transmittance 1, the worst channel of linear RGBA: early termination compares
/// its product with the transmittance to the error it may make. With independent emission light grows with the length.
double opacity_weight(double max_color, double longest_ray, scene::Emission emission);

/// `exact`, and `auto` with pieces of its own.
void integrate_exact(const PiecewiseTable& table, scene::Emission emission, SegmentBatch& batch,
                     const ExactPieces& pieces = {});

/// `sampled:Ns`: Ns samples at the middles of Ns equal steps of length / Ns, each step homogeneous (Juliachs et al.
/// 2007, 4.3, where the printed dx = 1 / Ns is read as l / Ns, as its own remark on null elements needs).
void integrate_sampled(const PiecewiseTable& table, scene::Emission emission, int samples, SegmentBatch& batch);

/// `preintegrated:N`: one lookup a segment in a table of the transfer function (segment_table.hpp).
void integrate_preintegrated(const SegmentTable& table, scene::Emission emission, SegmentBatch& batch);

/// `partial` (Moreland and Angel 2004): cut at the knots like `exact`, then M, there Psi, from a table (psi_table.hpp)
/// that no transfer function changes. Exact where the colour does not change; else wrong by Psi's error times the
/// change, which does not shrink with the segment: it adds up over many thin ones. Emission by absorption only.
void integrate_partial(const PiecewiseTable& table, const PsiTable& psi, SegmentBatch& batch);

}  // namespace tessera::integrals
