// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include "scene/sample_source.hpp"
#include "system/byte_sink.hpp"
#include "system/scratch_file.hpp"

namespace tessera::io {

/// Samples available only sequentially and once, as from a stream that must be unpacked.
struct StreamedSamples {
  scene::Grid grid;
  scene::ComponentChoice choice;
  bool swapped = false;  ///< the tuples' byte order is not native
  /// Passes the tuples of all samples, exactly, to the sink. May be called again for another pass.
  std::function<void(const system::ByteSink&)> tuples;
};

/// Size of the samples in bytes, in the grid's storage format.
std::uint64_t bytes_of(const StreamedSamples& samples);

/// Writes them to a brick file that other processes can open (scratch_bricks() of brick_file.hpp), in one pass. Holds
/// some slices at a time: 8 MiB of tuples and as much of samples, or one slice if that is larger. Ranges are computed
/// on the threads of the caller's arena. Throws what `tuples` throws, and Error(bad_input) naming `subject` if there is
/// no space for the file.
std::unique_ptr<system::ScratchFile> scratch_bricks(const StreamedSamples& samples, const std::string& subject);

/// Range and number of blanks of all samples, in one pass.
scene::ValueRange value_range(const StreamedSamples& samples);

}  // namespace tessera::io
