// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tessera {
inline namespace v0_1 {

/// The source term of the volume rendering integral (Max, "Optical Models for Direct Volume Rendering", TVCG 1995).
enum class Emission {
  absorption,   ///< I = int kappa c T dt: light in proportion to extinction, the usual model
  independent,  ///< I = int c T dt: emission c per world unit, independent of kappa (Juliachs et al. 2007, 4.3)
};

/// How a ray segment becomes colour and opacity.
enum class IntegratorKind {
  exact,          ///< split at the transfer function's knots, error near rounding
  sampled,        ///< `samples` midpoint samples per segment, at step length / samples
  preintegrated,  ///< one lookup per segment in a table of `table_size` scalars per side
  partial,        ///< split at the knots, attenuation of a linear piece from a table (Moreland, Angel 2004)
  automatic       ///< the cheapest method that meets `accuracy`
};

struct Integrator {
  IntegratorKind kind = IntegratorKind::automatic;
  int samples = 0;         ///< sampled only, >= 1
  double accuracy = 1e-4;  ///< automatic only: largest error in linear RGBA, at least 1e-6
  int table_size = 128;    ///< preintegrated only, 8 to 512
  bool terminates = true;  ///< rays end where the remaining contribution is below the accuracy; false: never early
};

}  // namespace v0_1
}  // namespace tessera
