// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>

#include "frame/mesh/render.hpp"
#include "projection/depth_limits.hpp"
#include "projection/pixel_space.hpp"
#include "scene/camera.hpp"
#include "scene/lattice.hpp"
#include "scene/optical_model.hpp"
#include "scene/transfer_function.hpp"

namespace tessera::frame {

/// The integer lattice of a frame, from the whole mesh's box and scalar range alone, so that all processes have the
/// same one. None where the lattice is not good enough, and double precision has to do:
///   - the mesh's depth times the largest extinction is above 2000: 16 steps, 1e-8 of the depth, could show. Under
///     perspective a ray is longer than the depth that it goes through: as long as the longest of the picture counts;
///   - the transfer function changes so fast between two knots that the rounding of scalars could show by 2e-5, or by
///     three quarters of what was promised;
///   - two steps of the function lie so close together that the lattice takes them for one;
///   - there are surfaces of triangles, which cut segments in double precision, or the mesh is shaded, by the tets of
///     segments, which the lattice's do not know;
///   - it is switched off, the integrator is neither exact nor automatic, or the rasterizer is `scanline`;
///   - nothing is in front of the eye, or the processor has no lanes, and Highway emulates them.
std::optional<scene::Lattice> lattice_of(const projection::PixelSpace& space, const scene::Box& box,
                                         const std::array<double, 2>& scalar_range,
                                         const scene::TransferFunction& function, const Settings& settings);

/// Which single cells need double precision on that lattice. `longest_ray` bounds a ray's length in the whole mesh,
/// world units.
projection::DepthLimits depth_limits_of(const projection::PixelSpace& space, const scene::Lattice& lattice,
                                        const scene::TransferFunction& function, scene::Emission emission,
                                        double longest_ray);

}  // namespace tessera::frame
