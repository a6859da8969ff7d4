// SPDX-License-Identifier: BSD-3-Clause
#include "volume/lanes/chunk_view.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "volume/lanes/cast_chunk_in_steps.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "volume/lanes/sample_slabs-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tessera::volume {
namespace HWY_NAMESPACE {

void cast_chunk_in_steps_here(const ChunkView& chunk, TileRays& rays, TileCounts& counts) {
  sample_chunk(chunk, rays, counts);
}

void skip_chunk_in_steps_here(const ChunkView& chunk, TileRays& rays) { skip_chunk(chunk, rays); }

}  // namespace HWY_NAMESPACE
}  // namespace tessera::volume
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tessera::volume {

HWY_EXPORT(cast_chunk_in_steps_here);
void cast_chunk_in_steps(const ChunkView& chunk, TileRays& rays, TileCounts& counts) {
  HWY_DYNAMIC_DISPATCH(cast_chunk_in_steps_here)(chunk, rays, counts);
}

HWY_EXPORT(skip_chunk_in_steps_here);
void skip_chunk_in_steps(const ChunkView& chunk, TileRays& rays) {
  HWY_DYNAMIC_DISPATCH(skip_chunk_in_steps_here)(chunk, rays);
}

}  // namespace tessera::volume
#endif  // HWY_ONCE
