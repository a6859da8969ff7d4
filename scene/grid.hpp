// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <glm/vec3.hpp>

#include "scene/camera.hpp"
#include "scene/tet_mesh.hpp"
#include "tessera/grid.hpp"

namespace tessera::scene {

using tessera::bounds;
using tessera::fits_float;
using tessera::Grid;
using tessera::GridGeometry;
using tessera::GridIndex;
using tessera::index_of_world;
using tessera::is_float;
using tessera::mean_thickness;
using tessera::name_of;
using tessera::SampleBox;
using tessera::SampleType;
using tessera::size_of;
using tessera::validate;
using tessera::world_of_index;
using tessera::world_to_local;

/// Sets spacing and direction from the world vector of one index step along each axis.
void set_axes(GridGeometry& geometry, const std::array<glm::dvec3, 3>& steps);

}  // namespace tessera::scene
