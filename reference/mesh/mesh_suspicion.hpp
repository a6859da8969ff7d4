// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "reference/suspicion.hpp"
#include "scene/camera.hpp"
#include "scene/image.hpp"
#include "scene/optical_model.hpp"
#include "scene/tet_mesh.hpp"
#include "scene/transfer_function.hpp"

namespace tessera::reference {

/// Where a mesh makes a picture hard.
///
/// Noise   scalars and depths are taken as rounded to 2^-30 of their range over the mesh. A renderer that rounds more
///         or less has the same order of suspects.
/// Cost    a pass over the tets and over their edges' pixels; of more than 262,144 tets that many, evenly spread, and
///         the edges of 65,536.
struct MeshSuspicion {
  SuspicionMap step;   ///< error of light that the scalars' rounding may make in one cell, at some pixels of it
  SuspicionMap tie;    ///< nearness of an edge to the pixel's centre (1e-3 pixel at most), times the picture's contrast
  SuspicionMap depth;  ///< error of light that the depths' rounding may make in one cell, at some pixels of it
};

/// `edge`: the picture's ImageSuspicion::edge. `threads` 0: all cores.
MeshSuspicion suspect(const scene::TetMeshView& mesh, const scene::Camera& camera,
                      const scene::TransferFunction& transfer_function, scene::Emission emission,
                      const scene::Image& image, const SuspicionMap& edge, int threads = 0);

}  // namespace tessera::reference
