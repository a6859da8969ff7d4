// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "compositor/gl/gl_fragments.hpp"
#include "integrals/segment_integrator.hpp"
#include "scene/lattice.hpp"

namespace tessera::compositor {

/// Computes on the CPU, in double precision, the lights that a device would compute; for compositors whose device has
/// failed. `units` are the units of the fragments' depths and scalars.
std::vector<GlLight> composite_on_cpu(const GlFragments& fragments, const GlRules& rules,
                                      const integrals::SegmentIntegrator& integrator, const scene::Lattice& units);

}  // namespace tessera::compositor
