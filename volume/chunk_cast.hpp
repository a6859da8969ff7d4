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

/// One frame of a volume, chunk by chunk: the state of its rays outlives a chunk, and a sink gets what they gather. For
/// callers that have, or want, no more than a part of the volume at a time:
///
///   early termination   go on while any_open()
///   occlusion           close() rays that something else hides, between chunks
///   sort-last           advance() through one's chunks, emit() the fragments to whoever composites them front to back
///                       (a process that has one box casts it in one go: CastRequest::part)
///   shadows             a camera at the light; transmittance() after each chunk is the light that reaches what is next
///
///     ChunkCast cast(renderer, camera, size, function);
///     for (const VoxelBox& chunk : boxes_front_to_back(geometry, {32, 32, 32}, camera)) cast.advance(chunk);
///     cast.emit(sink);
///
/// Order    chunks come front to back along every ray (boxes_front_to_back()); a ray never goes back. What lies between
///          two chunks counts as empty.
/// Covers   every method, point and cell data, shading, surfaces, both projections, regular and rectilinear grids. With
///          IntegratorKind::preintegrated a step that begins in one chunk and ends in the next needs the ray's state:
///          it is left out where a cast begins in the middle of the volume, so sort-last is for the other methods.
/// Bits     one emit() after all chunks gives those of Renderer::render() where chunks are whole slices of the volume
///          that begin at multiples of 32 voxels, counted along the axis that the rays move along most from where they
///          come in (regular grids). Other chunks, and fragments composited, give the same picture to rounding: 1e-6,
///          in steps through narrow peaks of the transfer function 1e-5.
/// Error    of the method; rays of which float lanes are not sure are cast again in double precision between the
///          places where their fragment begins and ends, when it is emitted.
/// Threads  advance() and emit() use those of the renderer's settings; one call at a time, and none while the renderer
///          renders.
/// Memory   150 bytes a pixel of the region, twice that in tiles whose rays differ in their main axis.
class ChunkCast {
 public:
  /// The rays of a whole picture, or of a region of it. The renderer must outlive the cast. Throws Error(bad_input) for
  /// an invalid camera or size.
  ChunkCast(Renderer& renderer, const scene::Camera& camera, scene::ImageSize size,
            const scene::TransferFunction& function, std::optional<scene::PixelRect> region = std::nullopt);
  ~ChunkCast();
  ChunkCast(const ChunkCast&) = delete;
  ChunkCast& operator=(const ChunkCast&) = delete;

  /// Takes every open ray through its voxels of `chunk`. Reads bricks of the chunk, no others (rectilinear: blocks of
  /// 16^3 voxels). Throws scene::FrameStopped once `stop` is asked for, and is then of no more use; Error(bad_input)
  /// for a chunk that is empty or not of the volume.
  void advance(const VoxelBox& chunk, const std::stop_token& stop = {});

  /// Whether something may still be added to the ray of a pixel of the region: it has not left the volume, lets light
  /// through and has not been closed.
  [[nodiscard]] bool open(int x, int y) const;
  [[nodiscard]] bool any_open() const;
  /// What gets through all that a pixel's ray has met: 1 where it met nothing.
  [[nodiscard]] float transmittance(int x, int y) const;
  /// Ends the ray of a pixel where it is: nothing is added to what it has.
  void close(int x, int y);

  /// Gives what rays have gathered since the last emit(), a fragment for each that met a chunk since then. Rays go on
  /// from there without light, but what they have met still counts for open() and transmittance().
  void emit(FragmentSink& sink, const std::stop_token& stop = {});

  /// So far: rays, voxels visited, samples, pixels cast again; the others are 0.
  [[nodiscard]] GridCounters counters() const;

  class State;

 private:
  std::unique_ptr<State> state_;
};

}  // namespace tessera::volume
