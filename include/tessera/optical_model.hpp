// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tessera {
inline namespace v0_1 {

/// The emission term of the volume rendering integral (Max, "Optical Models for Direct Volume Rendering", TVCG 1995).
/// Here I is the light of a ray, kappa the extinction, c the colour and T the transmittance up to t.
enum class Emission {
  absorption,   ///< I = int kappa c T dt: emission in proportion to extinction, the usual model
  independent,  ///< I = int c T dt: emission c per world unit, independent of kappa (Juliachs et al. 2007, 4.3)
};

/// How the colour and the opacity of a ray segment are computed.
enum class IntegratorKind {
  exact,          ///< split at the knots of the transfer function; the error is near rounding
  sampled,        ///< `samples` samples per segment, at the midpoints of equal steps
  preintegrated,  ///< one lookup per segment in a square table with `table_size` scalars per side
  partial,        ///< split at the knots of the transfer function; a table gives the attenuation of each linear piece
                  ///< (Moreland, Angel 2004)
  automatic       ///< the cheapest method that meets `accuracy`
};

struct Integrator {
  IntegratorKind kind = IntegratorKind::automatic;
  int samples = 0;         ///< sampled only, >= 1
  double accuracy = 1e-4;  ///< automatic only: largest error in linear RGBA, at least 1e-6
  int table_size = 128;    ///< preintegrated only, 8 to 512
  bool terminates = true;  ///< true: rays end where the remaining contribution is below the accuracy; false: rays never
                           ///< end early
};

}  // namespace v0_1
}  // namespace tessera
