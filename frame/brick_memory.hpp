#pragma once

#include <cstdint>

#include "scene/image.hpp"

namespace tessera::frame {

/// Bytes of memory that this process holds now, shared libraries included; 0 where the system does not tell.
std::uint64_t resident_bytes();

/// What of a process's `memory` is left for bricks beside the rest of it: `resident` (the program and what it has
/// read, ranges of cells), the picture and its copy on the way out, what each thread keeps for its tiles, pages of a
/// mapped file. At least 16 MiB, or all of `memory` if that is less: so small budgets are exceeded by the program
/// itself.
std::uint64_t brick_memory(std::uint64_t memory, std::uint64_t resident, scene::ImageSize picture, int threads);

}  // namespace tessera::frame
