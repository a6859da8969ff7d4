// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "reference/suspicion.hpp"
#include "scene/camera.hpp"
#include "scene/image.hpp"
#include "scene/optical_model.hpp"
#include "scene/tet_mesh.hpp"
#include "scene/transfer_function.hpp"

namespace tessera::reference {

/// Where a mesh is difficult to render correctly.
///
/// Noise   scalars and depths are assumed to be rounded to 2^-30 of their range over the mesh. The ranking of suspects
///         is the same for a renderer that rounds more or less.
/// Cost    a pass over the tets and over the pixels of their edges. If there are more than 262,144 tets, only 262,144
///         of them are used, evenly distributed, and the edges of 65,536 of these.
struct MeshSuspicion {
  SuspicionMap step;   ///< possible error of light from rounding of the scalars in one cell; set at some of its pixels
  SuspicionMap tie;    ///< contrast times the nearness of an edge to the pixel's centre (at most 1e-3 pixel)
  SuspicionMap depth;  ///< possible error of light from rounding of the depths in one cell; set at some of its pixels
};

/// `edge` is the image's ImageSuspicion::edge. `threads` 0: all cores.
MeshSuspicion suspect(const scene::TetMeshView& mesh, const scene::Camera& camera,
                      const scene::TransferFunction& transfer_function, scene::Emission emission,
                      const scene::Image& image, const SuspicionMap& edge, int threads = 0);

}  // namespace tessera::reference
