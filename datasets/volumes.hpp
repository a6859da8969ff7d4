// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <string>

#include "datasets/generate.hpp"
#include "scene/sample_source.hpp"

namespace tessera::datasets {

/// Returns volumes by name, like generate() for meshes, on [-1, 1]^3 with n points per side (2 to 4096). `bits` is 8 or
/// 16 for integers, value * 255 or 65535 rounded, or 32 for float. "ripples" is smooth_field; "radial", "head" and
/// "turbulence" are the fields of volume_fields.hpp; "checker" alternates 0 and 1 from point to point (the roughest
/// possible field; float). Samples are computed when they are read, so that a volume may be larger than memory. Throws
/// Error(bad_input) for an unknown kind or parameter, or a value out of range.
std::unique_ptr<scene::SampleSource> generate_volume(const std::string& kind,
                                                     const std::map<std::string, double>& parameters);

/// Returns all kinds with their parameters.
std::vector<Generator> volume_generators();

}  // namespace tessera::datasets
