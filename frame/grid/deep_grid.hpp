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
  FrameSettings frame{};  ///< with `peel`, samples are layers (volume/precise/voxel_layers.hpp) and are not made tidy
  const volume::GridSurfaces* surfaces_of_grid = nullptr;  ///< null: there are no surfaces
};

/// Renders the rows y0 <= y < y1 of a volume's deep image; the other rows stay empty. Supports regular and rectilinear
/// grids, with point or cell data.
///
/// Method    The samples come from a separate pass in double precision, since the caster keeps no depths. Every ray
///           goes from voxel to voxel. Its cubic is cut at its turning points, at the knots of the transfer function,
///           and into intervals so short that a line through the mean gives their light to 2e-9 (the bound is derived
///           in volume/lanes/ray_piece-inl.h). The rest is as for meshes: compositor/deep/deep_pieces.hpp,
///           compositor/deep/deep_fragments.hpp.
/// Surfaces  A surface is a sample without length.
/// Flat      The flattened samples equal the volume's exact image to 1e-5, and the caster's image within --accuracy.
/// Cost      The pass takes about twenty times as long as the caster. Samples are read in blocks of 16^3 voxels; each
///           thread keeps 256 blocks: 10 MB.
///
/// Throws Error(system_failure) if the samples exceed the memory. After `stop` is requested, throws scene::FrameStopped
/// as soon as each thread has finished its row of 32 rays.
scene::DeepImage deep_image(const scene::SampleSource& source, const scene::Camera& camera, scene::ImageSize size,
                            const scene::TransferFunction& function, const DeepSettings& settings, int y0, int y1,
                            const std::stop_token& stop = {});

}  // namespace tessera::frame
