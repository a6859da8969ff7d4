// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "io/volume/volume_tags.hpp"
#include "scene/sample_source.hpp"

namespace tessera::io {

/// Whether write_volume supports the extension: .vti .vtr .nrrd .raw .bricks.
bool is_volume_output(const std::filesystem::path& file);

/// Returns the type that is written. This is the stored type, unless scale and shift must be applied: then float32 for
/// float32 and types of up to 16 bits, float64 for others.
scene::SampleType written_type(const scene::Grid& grid);

/// Writes a volume, uncompressed, in the format of the extension. Reads some slices of `source` at a time, so that the
/// file may be larger than memory. Stored types are kept, but if the format cannot store the volume's scale and shift
/// (only .bricks can), these are applied and written_type() is used. `block`: side of a brick file's blocks. .nrrd,
/// .vti, .vtr and .bricks store `axes` and `tags`. The file appears by rename. Throws Error(bad_input) for features
/// that the format cannot represent: cell data in .nrrd and .raw, a rectilinear grid in all formats but .vtr and
/// .bricks, a direction in .raw and .vtr; Error(system_failure) if writing fails.
void write_volume(const scene::SampleSource& source, const std::filesystem::path& file, int block = 64,
                  BodyAxes axes = BodyAxes::none, const VolumeTags& tags = {});

}  // namespace tessera::io
