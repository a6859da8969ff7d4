// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "compositor/tile_merger.hpp"

namespace tessera::compositor {

/// The units in which a device gets the depths and scalars of a frame that is not on the integer lattice: powers of
/// two, with the origin of scalars in the middle of the transfer function. A float then has an error of 6e-8 times the
/// distance from there.
scene::Lattice device_units(const scene::TransferFunction& function, double longest_ray);

/// A merger for parts of any kind, whose fragments context.device sorts, integrates and composites. Final fragments go
/// to the device in portions; the portions' lights are composited here, in double precision.
std::unique_ptr<TileMerger> make_gl_merger(const MergeContext& context, const scene::PixelRect& rect);

}  // namespace tessera::compositor
