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

/// Valid settings of a deep image. Samples may take half of `memory_bytes`.
struct DeepSettings : volume::RenderSettings {
  FrameSettings frame{};  ///< with `peel` samples are layers (volume/precise/voxel_layers.hpp), not tidy
  const volume::GridSurfaces* surfaces_of_grid = nullptr;  ///< null: none
};

/// The deep image of a volume's rows y0 <= y < y1; other rows are empty. Regular and rectilinear grids, point and cell
/// data.
///
/// Method    A separate pass in double precision, since the caster keeps no depths. Every ray goes from voxel to voxel.
///           Its cubic is cut at its turning points, at the knots of the transfer function, and into intervals so short
///           that a line through the mean gives their light to 2e-9 (volume/lanes/ray_piece-inl.h has the bound). The
///           rest is as for meshes: compositor/deep/deep_pieces.hpp, compositor/deep/deep_fragments.hpp.
/// Surfaces  are samples without length.
/// Flat      the flattened samples equal the volume's exact image to 1e-5, and the caster's within --accuracy.
/// Cost      about twenty times the caster's. Samples are read in blocks of 16^3 voxels; each thread keeps 256 of them:
///           10 MB.
///
/// Throws Error(system_failure) if the samples exceed the memory; scene::FrameStopped within a row of 32 rays per
/// thread after `stop` is requested.
scene::DeepImage deep_image(const scene::SampleSource& source, const scene::Camera& camera, scene::ImageSize size,
                            const scene::TransferFunction& function, const DeepSettings& settings, int y0, int y1,
                            const std::stop_token& stop = {});

}  // namespace tessera::frame
