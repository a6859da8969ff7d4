// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "compositor/tile_merger.hpp"

namespace tessera::compositor {

/// The units in which a device gets depths and scalars of a frame that is not on the integer lattice: powers of two,
/// the scalars' origin in the middle of the transfer function. A float is then right to 6e-8 of the distance from
/// there.
scene::Lattice device_units(const scene::TransferFunction& function, double longest_ray);

/// A merger for parts of any kind whose fragments are sorted, integrated and composited by context.device. What is
/// final leaves for the device in portions; their lights are put together here, in double.
std::unique_ptr<TileMerger> make_gl_merger(const MergeContext& context, const scene::PixelRect& rect);

}  // namespace tessera::compositor
