// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "integrals/piecewise_table.hpp"
#include "integrals/segment_batch.hpp"
#include "integrals/segment_integrator.hpp"
#include "scene/optical_model.hpp"
#include "scene/surface_set.hpp"
#include "scene/transfer_function.hpp"
#include "tessera/settings.hpp"

namespace tessera::integrals {

/// A complete layer of a ray. Its light is not attenuated by the layers in front of it.
struct RayLayer {
  double front, back;  ///< planar depths between which the layer is visible
  double red, green, blue, optical_depth;
};

/// The layer at the current position of a ray.
struct OpenLayer {
  int number = 0;  ///< starting at 0
  /// Depth at which the layer becomes visible; infinite until then.
  double front = std::numeric_limits<double>::infinity();
  double red = 0, green = 0, blue = 0, optical_depth = 0, transmittance = 1;
  // The last visible stretch; both depths of a surface are equal.
  double last_front = 0, last_back = 0, last_scalar_front = 0, last_scalar_back = 0;
};

/// Cuts rays into layers: opacity peeling (Moloney 2008, 5.3; Rezk-Salama and Kolb, "Opacity Peeling for Direct Volume
/// Rendering", Computer Graphics Forum 25 (3), 2006). In these papers a ray advances in steps, and a layer ends with
/// the step that brings its opacity to the threshold. Here, a layer ends at the exact position, anywhere in a stretch.
///
/// Cut       A layer ends where the optical depth since the last cut is -log(1 - threshold), or smaller by a relative
///           error of at most 1e-12. Between knots of the transfer function the optical depth is a parabola in the
///           position, whose root is known in closed form. The parts are integrated again separately.
/// Surface   A surface has no interior to cut. A surface that brings the opacity to the threshold or beyond belongs to
///           the layer in front of the cut, and ends this layer.
/// Last      The last of Peel::layers layers is not cut: it contains the rest of the ray.
/// Error     The error is that of the `exact` integrator. Layers are cut by optical depth, so an error of the optical
///           depth moves no more light between layers than the error itself.
class RayLayers {
 public:
  /// A part of a ray on which the scalar is linear.
  struct Stretch {
    double front, back, scalar_front, scalar_back;  ///< planar depths, and the scalars there
    double length;                                  ///< length of the stretch in world units
    double own = 1, white = 0;                      ///< shading turns a colour c into own * c + white
  };

  /// `peel` must be valid. `terminates` states whether the last layer may end where the rest of the ray is invisible.
  RayLayers(const scene::TransferFunction& function, scene::Emission emission, const Peel& peel, bool terminates);

  /// The integrator for stretches that are passed to add(). It is `exact`, whichever integrator the frame uses.
  [[nodiscard]] const SegmentIntegrator& integrator() const { return integrator_; }

  /// Adds the next stretch of a ray; it must be segment `k` of an integrated batch. Appends the layers that end in the
  /// stretch.
  void add(const Stretch& stretch, const SegmentBatch& batch, std::size_t k, OpenLayer& layer,
           std::vector<RayLayer>& ended);

  /// Adds a surface, which has no thickness.
  void add_surface(double depth, const scene::SurfaceSet::Light& light, OpenLayer& layer,
                   std::vector<RayLayer>& ended) const;

  /// Ends the ray. Appends the last layer if the layer has any light or opacity.
  void end(OpenLayer& layer, std::vector<RayLayer>& ended) const;

  /// Whether the layer is the last one, which does not end before the ray does.
  [[nodiscard]] bool is_last(const OpenLayer& layer) const { return layer.number + 1 >= layers_; }

  /// Upper bound of the visibility of the rest of the ray. It is 1 before the last layer, because the light of a layer
  /// is not attenuated by earlier layers.
  [[nodiscard]] double transmittance(const OpenLayer& layer) const {
    return is_last(layer) ? layer.transmittance : 1.0;
  }

 private:
  [[nodiscard]] bool is_full(double optical_depth) const { return optical_depth >= enough_; }
  template <class Visit>
  void visit_pieces(const Stretch& stretch, const Visit& visit) const;
  void find_cuts(const Stretch& stretch, const OpenLayer& layer);
  void append(const Stretch& stretch, const SegmentBatch& batch, std::size_t k, OpenLayer& layer) const;

  PiecewiseTable table_;
  SegmentIntegrator integrator_;
  bool independent_;
  double limit_, enough_;  ///< optical depth of a layer, and the smallest optical depth that counts as reaching it
  int layers_;
  std::vector<double> cuts_;  ///< positions of the cuts in the current stretch, from 0 to 1
  SegmentBatch parts_;
};

}  // namespace tessera::integrals
