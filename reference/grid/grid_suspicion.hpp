// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "reference/suspicion.hpp"
#include "scene/camera.hpp"
#include "scene/image.hpp"
#include "scene/optical_model.hpp"
#include "scene/sample_source.hpp"
#include "scene/transfer_function.hpp"

namespace tessera::reference {

/// Where a regular or rectilinear grid makes a picture hard.
///
/// Noise   the field is taken as rounded to 2^-23 of its range: 32-bit floats.
/// Hidden  what lies well behind the first visible sample of an opaque pixel counts for little.
/// Cost    a pass over the samples, in blocks of 8^3 voxels; of more than 8,192 blocks that many, evenly spread.
struct GridSuspicion {
  SuspicionMap step;    ///< error of light that the field's rounding may make in one voxel, at some pixels of it
  SuspicionMap border;  ///< light of voxels that have blank and other samples, or lie beside blank ones
  SuspicionMap tie;     ///< nearness of the ray to a plane of the lattice or to an edge of the volume, times contrast
};

/// `edge`: the picture's ImageSuspicion::edge. `threads` 0: all cores.
GridSuspicion suspect(const scene::SampleSource& source, const scene::Camera& camera,
                      const scene::TransferFunction& transfer_function, scene::Emission emission,
                      const scene::Image& image, const SuspicionMap& edge, int threads = 0);

}  // namespace tessera::reference
