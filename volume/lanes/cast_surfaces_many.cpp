// SPDX-License-Identifier: BSD-3-Clause
#include "volume/lanes/chunk_view.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "volume/lanes/cast_surfaces_many.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "volume/lanes/cast_slabs-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tessera::volume {
namespace HWY_NAMESPACE {

void cast_surfaces_many_here(const ChunkView& chunk, TileRays& rays, TileCounts& counts) {
  cast_chunk_with_surfaces<CL::TableForm::many>(chunk, rays, counts);
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::volume
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tessera::volume {

HWY_EXPORT(cast_surfaces_many_here);
void cast_surfaces_many(const ChunkView& chunk, TileRays& rays, TileCounts& counts) {
  HWY_DYNAMIC_DISPATCH(cast_surfaces_many_here)(chunk, rays, counts);
}

}  // namespace tessera::volume
#endif  // HWY_ONCE
