// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "scene/tet_mesh.hpp"
#include "tessera/mesh_check.hpp"

namespace tessera::api {

using tessera::CheckProgressFunction;
using tessera::MeshCheck;

MeshCheck check_mesh(const scene::TetMeshView& mesh, const CheckProgressFunction& progress = nullptr);

}  // namespace tessera::api
