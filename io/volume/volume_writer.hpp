// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "io/volume/volume_tags.hpp"
#include "scene/sample_source.hpp"

namespace tessera::io {

/// Whether write_volume knows the extension: .vti .vtr .nrrd .raw .bricks.
bool is_volume_output(const std::filesystem::path& file);

/// The type that is written: the stored one, or where scale and shift have to be applied float32 for up to 16 bits and
/// float32, else float64.
scene::SampleType written_type(const scene::Grid& grid);

/// Writes a volume by its extension, samples uncompressed and read from `source` some slices at a time, so that the
/// file may be larger than memory. Stored types stay; where a format knows no scale and shift (all but .bricks) and the
/// volume has them, values are written, float32 for up to 16 bits. `block`: side of a brick file's blocks.
/// `axes` and `tags` are kept by .nrrd, .vti, .vtr and .bricks. Appears by rename. Throws Error(bad_input) for what the
/// format cannot say: cell data in .nrrd and .raw, a rectilinear grid in all but .vtr and .bricks, a direction in .raw
/// and .vtr; Error(system_failure) if it cannot be written.
void write_volume(const scene::SampleSource& source, const std::filesystem::path& file, int block = 64,
                  BodyAxes axes = BodyAxes::none, const VolumeTags& tags = {});

}  // namespace tessera::io
