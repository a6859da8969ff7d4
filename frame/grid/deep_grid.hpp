// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <stop_token>
#include <vector>

#include "scene/camera.hpp"
#include "scene/deep_image.hpp"
#include "scene/optical_model.hpp"
#include "scene/sample_source.hpp"
#include "scene/selection.hpp"
#include "scene/shading.hpp"
#include "scene/transfer_function.hpp"
#include "tessera/settings.hpp"
#include "volume/precise/grid_surfaces.hpp"

namespace tessera::frame {

struct DeepSettings {
  double accuracy = 1e-3;  ///< of samples cut anywhere: largest error in linear RGBA, 1e-6 to 1
  scene::Emission emission = scene::Emission::absorption;
  int threads = 0;                                 ///< 0: all cores
  std::uint64_t memory_bytes = 4ull << 30;         ///< half of it may be samples
  std::vector<scene::HalfSpace> clip{};            ///< that rays are kept in
  const volume::GridSurfaces* surfaces = nullptr;  ///< in the volume; null: none
  std::optional<Peel> peel{};                      ///< samples are layers (volume/precise/voxel_layers.hpp), not tidy
  std::optional<scene::Shading> shading{};         ///< of layers alone
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
/// Throws Error(bad_input) for an accuracy out of range, Error(system_failure) if memory does not hold the samples,
/// scene::FrameStopped within a row of 32 rays of each thread once `stop` is asked for.
scene::DeepImage deep_image(const scene::SampleSource& source, const scene::Camera& camera, scene::ImageSize size,
                            const scene::TransferFunction& function, const DeepSettings& settings, int y0, int y1,
                            const std::stop_token& stop = {});

}  // namespace tessera::frame
