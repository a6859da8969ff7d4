// SPDX-License-Identifier: BSD-3-Clause
#include "volume/lanes/chunk_view.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "volume/lanes/cast_chunk_two_vectors.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "volume/lanes/cast_slabs-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tessera::volume {
namespace HWY_NAMESPACE {

void cast_chunk_two_vectors_here(const ChunkView& chunk, TileRays& rays, TileCounts& counts) {
  cast_chunk<CL::TableForm::two_vectors>(chunk, rays, counts);
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::volume
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tessera::volume {

HWY_EXPORT(cast_chunk_two_vectors_here);
void cast_chunk_two_vectors(const ChunkView& chunk, TileRays& rays, TileCounts& counts) {
  if (chunk.frame.surfaces != nullptr) return cast_surfaces_two_vectors(chunk, rays, counts);
  HWY_DYNAMIC_DISPATCH(cast_chunk_two_vectors_here)(chunk, rays, counts);
}

}  // namespace tessera::volume
#endif  // HWY_ONCE
