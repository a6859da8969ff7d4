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

/// Samples that come in the order of their file and only once, as out of a stream that has to be unpacked.
struct StreamedSamples {
  scene::Grid grid;
  scene::ComponentChoice choice;
  bool swapped = false;  ///< tuples are of the other byte order than this machine's
  /// Gives the sink the tuples of all samples, no byte more or fewer. May be called again, for another pass.
  std::function<void(const system::ByteSink&)> tuples;
};

/// Bytes that its samples take as the grid stores them.
std::uint64_t bytes_of(const StreamedSamples& samples);

/// A brick file of them that other processes can open (scratch_bricks() of brick_file.hpp), in one pass. Holds some
/// slices at a time: 8 MiB of tuples and as much of samples, or what one slice takes if that is more. Ranges are found
/// on the threads of the caller's arena. Throws what `tuples` throws, and Error(bad_input) of `subject` if there is no
/// room for the file.
std::unique_ptr<system::ScratchFile> scratch_bricks(const StreamedSamples& samples, const std::string& subject);

/// Range and blanks of all of them, in one pass.
scene::ValueRange value_range(const StreamedSamples& samples);

}  // namespace tessera::io
