// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>

#include "frame/mesh/magnified_ranges.hpp"
#include "frame/mesh/render.hpp"
#include "projection/depth_limits.hpp"
#include "projection/pixel_space.hpp"
#include "scene/camera.hpp"
#include "scene/lattice.hpp"
#include "scene/optical_model.hpp"
#include "scene/transfer_function.hpp"

namespace tessera::frame {

/// Returns the integer lattice of a frame. It is computed only from the box and scalar range of the whole mesh and from
/// the triangle surfaces, so that all processes have the same lattice. Returns nothing if the frame needs double
/// precision:
///   - the mesh's depth times the largest extinction is above 2000: 16 steps of the lattice, 1e-8 of the depth, could
///     be visible. With perspective, the longest ray of the image replaces the depth;
///   - the transfer function changes so fast between two knots that the rounding of scalars could exceed its share of
///     the error (scene/error_budget.hpp), and magnified ranges (frame/mesh/magnified_ranges.hpp) cannot help: either
///     too many would be needed, or there are triangle surfaces or devices, which do not support them;
///   - there are both triangle surfaces and iso-surfaces: where they nearly touch, the lattice cannot resolve their
///     order;
///   - there are surfaces, and the rounding of depths or of the cosine in their light exceeds the error;
///   - the integrator is neither exact nor automatic, and there are devices, or the function has steps: such an
///     integrator uses the function as given, while scalars are rounded, so they may be on the wrong side of a step;
///   - the lattice is switched off, or the rasterizer is `scanline`;
///   - nothing is in front of the eye, or Highway only emulates lanes on this processor.
std::optional<FrameLattice> lattice_of(const projection::PixelSpace& space, const scene::Box& box,
                                       const std::array<double, 2>& scalar_range,
                                       const scene::TransferFunction& function, const Settings& settings);

/// Same as lattice_of() for a frame with these settings. Returns nothing for deep images and layers of independent
/// emission or with surfaces (compositor/deep/), and for a `deep_accuracy` below 2.7e-4.
std::optional<FrameLattice> lattice_of(const projection::PixelSpace& space, const scene::Box& box,
                                       const std::array<double, 2>& scalar_range,
                                       const scene::TransferFunction& function, const Settings& settings,
                                       const FrameSettings& frame);

/// Returns the integrator of a frame with these settings. In a deep image, rays may end only where nothing behind can
/// be seen through a cut, which may require a smaller accuracy than the image alone.
scene::Integrator integrator_of(const Settings& settings, const FrameSettings& frame);

/// Returns the limits by which single cells need double precision on this lattice. `longest_ray` is an upper bound of a
/// ray's length in the whole mesh, world units.
projection::DepthLimits depth_limits_of(const projection::PixelSpace& space, const scene::Lattice& lattice,
                                        const scene::TransferFunction& function, scene::Emission emission,
                                        double longest_ray);

}  // namespace tessera::frame
