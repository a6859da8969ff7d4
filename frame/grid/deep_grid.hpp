// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stop_token>

#include "scene/camera.hpp"
#include "scene/deep_image.hpp"
#include "scene/sample_source.hpp"
#include "scene/transfer_function.hpp"
#include "volume/precise/grid_surfaces.hpp"
#include "volume/render.hpp"

namespace tessera::frame {

/// Of valid settings. Half of `memory_bytes` may be samples.
struct DeepSettings : volume::RenderSettings {
  FrameSettings frame{};  ///< with `peel` samples are layers (volume/precise/voxel_layers.hpp), not tidy
  const volume::GridSurfaces* surfaces_of_grid = nullptr;  ///< null: none
};

/// The deep picture of a volume's rows y0 <= y < y1; the others stay empty. Regular and rectilinear grids, point and
/// cell data.
///
/// How       A pass of its own in double precision, beside the caster, which has no time for depth. Every ray goes from
///           voxel to voxel. Its cubic is cut where it turns and at the knots of the transfer function, and into
///           stretches so short that a line through its mean gives their light to 2e-9 (volume/lanes/ray_piece-inl.h
///           has the bound); from there on it is as with meshes: compositor/deep/deep_pieces.hpp,
///           compositor/deep/deep_fragments.hpp.
/// Surfaces  are samples without length.
/// Flat      the samples flattened are the volume's picture to 1e-5, and within --accuracy of the caster's.
/// Cost      about twenty times the caster's. Samples are read in blocks of 16^3 voxels, 256 of them kept a thread: 10
///           MB.
///
/// Throws Error(system_failure) if memory does not hold the samples, scene::FrameStopped within a row of 32 rays of
/// each thread once `stop` is asked for.
scene::DeepImage deep_image(const scene::SampleSource& source, const scene::Camera& camera, scene::ImageSize size,
                            const scene::TransferFunction& function, const DeepSettings& settings, int y0, int y1,
                            const std::stop_token& stop = {});

}  // namespace tessera::frame
