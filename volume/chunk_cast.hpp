// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <stop_token>

#include "scene/camera.hpp"
#include "scene/pixel_rect.hpp"
#include "scene/transfer_function.hpp"
#include "tessera/frame_counters.hpp"
#include "volume/fragment_sink.hpp"
#include "volume/split/voxel_box.hpp"

namespace tessera::volume {

class Renderer;

/// Casts one frame of a volume, chunk by chunk: the state of the rays persists between chunks, and a sink receives the
/// light of the rays. For callers that have, or want, only a part of the volume at a time:
///
///   early termination   continue while any_open()
///   occlusion           between chunks, close() rays that other objects hide
///   sort-last           advance() through the process's chunks, then emit() the fragments for compositing front to
///                       back (a process that has one box casts it in one call: CastRequest::part)
///   shadows             use a camera at the light; transmittance() after each chunk is the light that reaches the next
///                       chunk
///
///     ChunkCast cast(renderer, camera, size, function);
///     for (const VoxelBox& chunk : boxes_front_to_back(geometry, {32, 32, 32}, camera)) cast.advance(chunk);
///     cast.emit(sink);
///
/// Order     Chunks are passed front to back along every ray (boxes_front_to_back()); a ray never goes back. Gaps
///           between chunks are treated as empty.
/// Covers    Every integrator, point and cell data, shading, surfaces, both projections, regular and rectilinear grids.
///           With IntegratorKind::preintegrated a step from one chunk to the next needs the ray's state. Such steps are
///           missing where a cast begins in the middle of the volume, so sort-last should use the other integrators.
/// Bits      One emit() after all chunks gives the bits of Renderer::render() if chunks are whole slices of the volume
///           that begin at multiples of 32 voxels, counted along the rays' main axis from where they enter (regular
///           grids). Other chunks, and composited fragments, give the same image up to rounding: 1e-6, and 1e-5 with
///           steps through narrow peaks of the transfer function.
/// Error     The error is that of the integrator. When a fragment is emitted whose light in float lanes is uncertain,
///           its part of the ray is cast again in double precision.
/// Threads   advance() and emit() use the threads of the renderer's settings. Only one call may run at a time, and none
///           while the renderer renders.
/// Memory    150 bytes per pixel of the region, twice that in tiles whose rays differ in their main axis.
class ChunkCast {
 public:
  /// Casts the rays of a whole image, or of a region of the image. The renderer must outlive the cast. Throws
  /// Error(bad_input) for an invalid camera or size.
  ChunkCast(Renderer& renderer, const scene::Camera& camera, scene::ImageSize size,
            const scene::TransferFunction& function, std::optional<scene::PixelRect> region = std::nullopt);
  ~ChunkCast();
  ChunkCast(const ChunkCast&) = delete;
  ChunkCast& operator=(const ChunkCast&) = delete;

  /// Casts every open ray through its voxels of `chunk`. Reads only bricks of the chunk (rectilinear grids: blocks of
  /// 16^3 voxels). Throws scene::FrameStopped after a request on `stop`; the cast cannot be continued then. Throws
  /// Error(bad_input) for a chunk that is empty or not inside the volume.
  void advance(const VoxelBox& chunk, const std::stop_token& stop = {});

  /// Whether light may still be added to the ray of a pixel of the region: it has not left the volume, is not opaque
  /// and has not been closed.
  [[nodiscard]] bool open(int x, int y) const;
  [[nodiscard]] bool any_open() const;
  /// Transmittance of the part of a pixel's ray that has been cast: 1 if it met nothing.
  [[nodiscard]] float transmittance(int x, int y) const;
  /// Ends the ray of a pixel; the light that it has accumulated is kept.
  void close(int x, int y);

  /// Passes the light accumulated since the last emit() to `sink`: a fragment for each ray that met a chunk since then.
  /// Rays continue without light, but open() and transmittance() still take their whole path into account.
  void emit(FragmentSink& sink, const std::stop_token& stop = {});

  /// Totals of rays, voxels visited, samples and pixels cast again; other counters are 0.
  [[nodiscard]] GridCounters counters() const;

  class State;

 private:
  std::unique_ptr<State> state_;
};

}  // namespace tessera::volume
