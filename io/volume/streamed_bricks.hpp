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

/// Samples that are available only sequentially, for example from a stream that must be unpacked.
struct StreamedSamples {
  scene::Grid grid;
  scene::ComponentChoice choice;
  bool swapped = false;  ///< the tuples' byte order is not native
  /// Passes the tuples of exactly all samples to the sink. May be called again for another pass.
  std::function<void(const system::ByteSink&)> tuples;
};

/// Size of the samples in bytes, in the grid's storage format.
std::uint64_t bytes_of(const StreamedSamples& samples);

/// Writes the samples, in one pass, to a brick file that other processes can open (scratch_bricks() of brick_file.hpp).
/// Keeps some slices in memory at a time: 8 MiB of tuples and the same amount of samples, or one slice if that is
/// larger. Ranges are computed on the threads of the caller's arena. Throws what `tuples` throws, and Error(bad_input)
/// naming `subject` if there is no space for the file.
std::unique_ptr<system::ScratchFile> scratch_bricks(const StreamedSamples& samples, const std::string& subject);

/// Computes the range and the number of blanks of all samples, in one pass.
scene::ValueRange value_range(const StreamedSamples& samples);

}  // namespace tessera::io
