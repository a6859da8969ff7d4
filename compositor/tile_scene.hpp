// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "integrals/lane_table.hpp"
#include "integrals/segment_integrator.hpp"
#include "projection/matter_light.hpp"
#include "projection/pixel_space.hpp"
#include "scene/image.hpp"
#include "scene/lattice.hpp"
#include "scene/surface_set.hpp"

namespace tessera::compositor {

/// What sinks and mergers that integrate segments need to know about a frame. All of it must outlive them.
struct TileScene {
  const projection::PixelSpace* space;
  const integrals::SegmentIntegrator* integrator;
  double left_out_per_transmittance;  ///< integrals::opacity_weight()
  // For the lattice:
  const integrals::LaneTable* table = nullptr;
  scene::Lattice lattice{};
  const scene::SurfaceSet* surfaces = nullptr;  ///< surfaces inside the volume; null: none
  // For double precision:
  const projection::MatterLight* light = nullptr;    ///< lighting of the matter; null: none
  const projection::CellNormals* normals = nullptr;  ///< with `light`: the normals of the segments' tets

  /// Behind a lower transmittance, nothing can change a pixel by the integrator's termination error or more.
  [[nodiscard]] double least_transmittance() const {
    return integrator->termination_error() / left_out_per_transmittance;
  }
};

/// A pixel of an image: premultiplied linear RGB, opacity, and the planar depth at which the pixel becomes visible, in
/// world units; the depth is infinite if the pixel is empty.
struct PixelValue {
  double red, green, blue, opacity, depth;
};

/// Target of finished pixels. The image's first pixel is pixel (x0, y0) of the frame.
struct ImageWindow {
  scene::Image* image;
  int x0 = 0, y0 = 0;

  /// Sets pixel (x, y) of the frame.
  void put(int x, int y, const PixelValue& value) const {
    const std::size_t at = image->index(x - x0, y - y0);
    image->rgba[4 * at + 0] = static_cast<float>(value.red);
    image->rgba[4 * at + 1] = static_cast<float>(value.green);
    image->rgba[4 * at + 2] = static_cast<float>(value.blue);
    image->rgba[4 * at + 3] = static_cast<float>(value.opacity);
    image->depth[at] = static_cast<float>(value.depth);
  }
};

}  // namespace tessera::compositor
