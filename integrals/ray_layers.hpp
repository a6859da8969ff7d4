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

/// A layer of a ray that is complete: light as if nothing lay in front of it.
struct RayLayer {
  double front, back;  ///< planar depths between which it shows
  double red, green, blue, optical_depth;
};

/// The layer that a ray has come to.
struct OpenLayer {
  int number = 0;                                          ///< from 0
  double front = std::numeric_limits<double>::infinity();  ///< where it begins to show; infinite: nowhere yet
  double red = 0, green = 0, blue = 0, optical_depth = 0, transmittance = 1;
  // The last stretch that shows; of a surface both depths are one.
  double last_front = 0, last_back = 0, last_scalar_front = 0, last_scalar_back = 0;
};

/// Cuts rays into layers: opacity peeling (Moloney 2008, 5.3; Rezk-Salama and Kolb, "Opacity Peeling for Direct Volume
/// Rendering", Computer Graphics Forum 25 (3), 2006). There a ray takes steps, and a layer ends with the step that
/// brings its opacity to the threshold. Here it ends at the very place, wherever in a stretch that is.
///
/// Cut      where the optical depth since the last cut is -log(1 - threshold), or less by no more than a part in 1e12.
///          Between knots of the transfer function it is a parabola in the position, whose root is known in closed
///          form; the parts are integrated anew, each by itself.
/// Surface  it has no inside to cut: what brings the opacity to the threshold or beyond is the end of the layer before
///          the cut.
/// Last     the layer Peel::layers is not cut: it has all that is left of the ray.
/// Error    that of the `exact` integrator. Layers are cut in optical depth, so an error in it moves no more light from
///          layer to layer than it is large.
class RayLayers {
 public:
  /// A stretch of a ray whose scalar is linear.
  struct Stretch {
    double front, back, scalar_front, scalar_back;  ///< planar depths, and the scalars there
    double length;                                  ///< world length
    double own = 1, white = 0;                      ///< what shading makes of a colour c: own * c + white
  };

  /// A valid Peel. `terminates`: whether what cannot be seen behind the last layer's own matter may be left out.
  RayLayers(const scene::TransferFunction& function, scene::Emission emission, const Peel& peel, bool terminates);

  /// What stretches are to be integrated by before they are added: exact, whatever makes the picture.
  [[nodiscard]] const SegmentIntegrator& integrator() const { return integrator_; }

  /// The next stretch of a ray, which is segment `k` of a batch that has been integrated. Appends the layers it ends.
  void add(const Stretch& stretch, const SegmentBatch& batch, std::size_t k, OpenLayer& layer,
           std::vector<RayLayer>& ended);

  /// A surface of no thickness.
  void add_surface(double depth, const scene::SurfaceSet::Light& light, OpenLayer& layer,
                   std::vector<RayLayer>& ended) const;

  /// The ray's end: appends the last layer if it has any light or opacity.
  void end(OpenLayer& layer, std::vector<RayLayer>& ended) const;

  /// At most what is let through of what comes next: of all layers but the last nothing may be left out.
  [[nodiscard]] double transmittance(const OpenLayer& layer) const {
    return is_last(layer) ? layer.transmittance : 1.0;
  }

 private:
  [[nodiscard]] bool is_last(const OpenLayer& layer) const { return layer.number + 1 >= layers_; }
  [[nodiscard]] bool is_full(double optical_depth) const { return optical_depth >= enough_; }
  template <class Visit>
  void visit_pieces(const Stretch& stretch, const Visit& visit) const;
  void find_cuts(const Stretch& stretch, const OpenLayer& layer);
  void append(const Stretch& stretch, const SegmentBatch& batch, std::size_t k, OpenLayer& layer) const;

  PiecewiseTable table_;
  SegmentIntegrator integrator_;
  bool independent_;
  double limit_, enough_;  ///< optical depth of a layer, and what counts as that
  int layers_;
  std::vector<double> cuts_;  ///< of the stretch at hand, 0 to 1 along it
  SegmentBatch parts_;
};

}  // namespace tessera::integrals
