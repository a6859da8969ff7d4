// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "compositor/tile_merger.hpp"

namespace tessera::compositor {

/// Returns the units in which a device gets the depths and scalars of a frame that is not on the integer lattice. They
/// are powers of two; the origin of scalars is in the middle of the transfer function, so that a float has an error of
/// 6e-8 times the distance from the middle.
scene::Lattice device_units(const scene::TransferFunction& function, double longest_ray);

/// Makes a merger for parts of any kind. `context.device` sorts, integrates and composites the fragments. Final
/// fragments go to the device in portions; the merger composites the lights of the portions in double precision.
std::unique_ptr<TileMerger> make_gl_merger(const MergeContext& context, const scene::PixelRect& rect);

}  // namespace tessera::compositor
