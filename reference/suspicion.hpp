// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "reference/ray_reference.hpp"
#include "scene/camera.hpp"

namespace tessera::reference {

/// Why a pixel is selected for checking: because of the image (image_suspicion.hpp), of the scene (mesh_suspicion.hpp,
/// grid_suspicion.hpp), or of the renderer that made the image.
enum class Suspicion {
  edge,      ///< differs much from a neighbour
  outlier,   ///< does not match the extrapolation from its neighbours, in any direction
  block,     ///< in a 4x4 block that differs from its surroundings: one packet of rays
  plateau,   ///< one of many pixels of the same colour: one pixel for each
  estimate,  ///< the renderer's own error estimate is large, or its alternative method gives another result
  step,      ///< light there depends on rounding of the field: steps, steep ramps
  border,    ///< at blank (NaN) samples of a grid
  tie,       ///< the ray passes through an edge, a vertex or a face seen edge-on, or very close to one
  depth      ///< light there depends on rounding of depth: dense, thin matter
};
inline constexpr std::size_t suspicions = 9;

/// "edge", "outlier", ...
const char* name_of(Suspicion suspicion);

/// How suspicious each pixel is, row-major; 0: not at all. Scores are comparable only within one map.
using SuspicionMap = std::vector<float>;

/// Raises a score to `to` if it is lower. Callable from any threads at once: the result does not depend on their order.
void raise(float& score, float to);

/// A pseudo-random number in [0, 1) that depends only on `n` and `salt`.
double hashed(std::uint64_t n, std::uint64_t salt);

/// A map's pixels in the order of checking, at most `most`: alternately the most suspicious one, the most suspicious
/// one of another 8x8 block, and a random one, high scores more often. Repeatable.
std::vector<PixelIndex> ranked(const SuspicionMap& map, scene::ImageSize size, std::size_t most);

/// Suspect pixels for each Suspicion, best first.
using Suspects = std::array<std::vector<PixelIndex>, suspicions>;

/// A pixel to check, with the reason; no reason: chosen at random.
struct ChosenPixel {
  PixelIndex at;
  std::optional<Suspicion> why;
};

/// `most` different suspects, taken from all kinds in turn.
std::vector<ChosenPixel> by_turns(const Suspects& suspects, std::size_t most);

/// Pixels of an image to be judged, `count` different ones (all if there are fewer): a third at random, the rest from
/// the suspects of each kind in turn, or at random if there are too few. Random pixels come first. The same in every
/// run.
std::vector<ChosenPixel> choose_pixels(scene::ImageSize size, std::size_t count, const Suspects& suspects);

}  // namespace tessera::reference
