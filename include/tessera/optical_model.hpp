// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tessera {
inline namespace v0_1 {

/// The source term of the volume rendering integral (Max, "Optical Models for Direct Volume Rendering", TVCG 1995).
enum class Emission {
  absorption,   ///< I = int kappa c T dt: light in proportion to extinction, the usual model
  independent,  ///< I = int c T dt: emission c per world unit, whatever kappa is (Juliachs et al. 2007, 4.3)
};

/// How a ray segment becomes colour and opacity.
enum class IntegratorKind {
  exact,          ///< split at the transfer function's knots, error near rounding
  sampled,        ///< `samples` midpoint samples a segment, at step length / samples
  preintegrated,  ///< one lookup a segment in a table of `table_size` scalars a side
  partial,        ///< split at the knots, attenuation of a linear piece from a table (Moreland, Angel 2004)
  automatic       ///< the cheapest that meets `accuracy`
};

struct Integrator {
  IntegratorKind kind = IntegratorKind::automatic;
  int samples = 0;         ///< sampled only, >= 1
  double accuracy = 1e-4;  ///< automatic only: largest error in linear RGBA, 1e-6 at least
  int table_size = 128;    ///< preintegrated only, 8 to 512
  bool terminates = true;  ///< rays end where what is left is below the accuracy; false: they never do
};

}  // namespace v0_1
}  // namespace tessera
