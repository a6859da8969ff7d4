#pragma once

#include <tbb/enumerable_thread_specific.h>

#include <memory>
#include <span>
#include <vector>

#include "scene/camera.hpp"
#include "scene/selection.hpp"
#include "volume/surface_walk.hpp"

namespace tessera::volume {

/// Where the rays of a picture cross the surfaces of a grid. Any number of threads may use one; source and surfaces
/// must outlive it.
class RayCrossings {
 public:
  /// A valid camera and size.
  RayCrossings(const scene::SampleSource& source, const scene::Camera& camera, scene::ImageSize size,
               std::span<const scene::HalfSpace> clip, const GridSurfaces& surfaces)
      : rays_(camera, size, source.geometry(), clip),
        walks_([&source, &surfaces] { return std::make_unique<SurfaceWalk>(source, surfaces); }) {}

  /// SurfaceWalk::find() of the ray through the centre of a pixel, which may lie beside the picture.
  bool find(int x, int y, double least, std::vector<SurfaceCrossing>& found) const {
    return walks_.local()->find(rays_.ray(x + 0.5, y + 0.5), least, found);
  }

 private:
  VoxelRays rays_;
  mutable tbb::enumerable_thread_specific<std::unique_ptr<SurfaceWalk>> walks_;
};

}  // namespace tessera::volume
