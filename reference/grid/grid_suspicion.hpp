// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "reference/suspicion.hpp"
#include "scene/camera.hpp"
#include "scene/image.hpp"
#include "scene/optical_model.hpp"
#include "scene/sample_source.hpp"
#include "scene/transfer_function.hpp"

namespace tessera::reference {

/// Where a regular or rectilinear grid is difficult to render correctly.
///
/// Noise   the field is assumed to be rounded to 2^-23 of its range, as in 32-bit floats.
/// Hidden  parts far behind the first visible sample of an opaque pixel have low scores.
/// Cost    a pass over the samples, in blocks of 8^3 voxels; if there are more than 8,192 blocks, only 8,192 of them,
///         evenly distributed.
struct GridSuspicion {
  SuspicionMap step;    ///< possible error of light from rounding of the field in a voxel; set at some of its pixels
  SuspicionMap border;  ///< light of voxels at a boundary of blank samples: those with blank and other samples, and
                        ///< those next to blank voxels
  SuspicionMap tie;     ///< contrast times the nearness of the ray to a lattice plane or to an edge of the volume
};

/// `edge` is the image's ImageSuspicion::edge. `threads` 0: all cores.
GridSuspicion suspect(const scene::SampleSource& source, const scene::Camera& camera,
                      const scene::TransferFunction& transfer_function, scene::Emission emission,
                      const scene::Image& image, const SuspicionMap& edge, int threads = 0);

}  // namespace tessera::reference
