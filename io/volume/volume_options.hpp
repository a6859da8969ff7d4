// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>

#include "tessera/read_options.hpp"

namespace tessera::io {

/// Options for reading a volume file.
struct VolumeOptions : ReadOptions {
  bool scratch_is_needed = false;  ///< other processes read the unpacked samples

  /// Largest size in bytes of unpacked samples that stay in memory; larger ones are written to a scratch file. The
  /// limit is half of the memory: bricks are copies and need the other half.
  [[nodiscard]] std::uint64_t most_in_memory() const {
    if (scratch_is_needed) return 0;
    return memory_bytes > 0 ? memory_bytes / 2 : std::numeric_limits<std::uint64_t>::max();
  }
};

}  // namespace tessera::io
