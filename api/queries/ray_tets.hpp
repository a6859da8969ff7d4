// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "scene/tet_mesh.hpp"
#include "tessera/reference.hpp"
#include "tessera/surfaces.hpp"
#include "tessera/view.hpp"

namespace tessera::api {

/// Returns all tets of a mesh that the ray of a pixel meets and a few others, in ascending order. The function makes
/// one pass over points and tets on all cores and needs no stored data. For a mesh of 12 million tets it takes about a
/// tenth of a second.
std::vector<std::uint32_t> tets_near_ray(const scene::TetMeshView& mesh, const View& view, PixelIndex pixel);

/// Does the same for triangles. Points and values are not changed.
TriangleMesh triangles_near_ray(const TriangleMesh& mesh, const View& view, PixelIndex pixel);

}  // namespace tessera::api
