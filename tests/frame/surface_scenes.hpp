#pragma once

#include "frame/render.hpp"

/// What tests of surfaces in a cube [-1, 1]^3 share.
namespace tessera::frame {

inline RenderSettings exact(const scene::Surfaces& surfaces, bool lattice = true) {
  RenderSettings settings;
  settings.integrator.kind = scene::IntegratorKind::exact;
  settings.surfaces = surfaces;
  settings.use.lattice = lattice;
  return settings;
}

inline scene::Camera view(scene::ProjectionKind kind, const glm::dvec3& from) {
  scene::Camera camera;
  camera.position = from;
  camera.projection = kind;
  camera.parallel_scale = 1.5;
  camera.view_angle = 38;
  return camera;
}

inline scene::TransferFunction clear() {
  return scene::TransferFunction({{0, {0.2, 0.4, 0.6}, 0}, {1, {0.2, 0.4, 0.6}, 0}});
}
inline scene::TransferFunction grey_fog() {
  return scene::TransferFunction({{0, {0.5, 0.5, 0.5}, 0.7}, {1, {0.5, 0.5, 0.5}, 0.7}});
}

}  // namespace tessera::frame
