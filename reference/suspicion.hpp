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

/// Why a pixel is selected for checking. The reason comes from the image (image_suspicion.hpp), the scene
/// (mesh_suspicion.hpp, grid_suspicion.hpp), or the renderer that made the image.
enum class Suspicion {
  edge,      ///< differs considerably from a neighbour
  outlier,   ///< does not match the extrapolation from its neighbours, in any direction
  block,     ///< is in a 4x4 block, one packet of rays, that differs from its surroundings
  plateau,   ///< is one of many pixels of the same colour; one pixel is chosen for each colour
  estimate,  ///< the renderer's own error estimate is large, or its alternative method gives another result
  step,      ///< the light depends on rounding of the field: steps, steep ramps
  border,    ///< is at blank (NaN) samples of a grid
  tie,       ///< the ray passes through an edge, a vertex or a face seen edge-on, or very close to one
  depth      ///< the light depends on rounding of depths: dense, thin matter
};
inline constexpr std::size_t suspicions = 9;

/// "edge", "outlier", ...
const char* name_of(Suspicion suspicion);

/// How suspicious each pixel is, row-major; 0: not at all. Scores are comparable only within one map.
using SuspicionMap = std::vector<float>;

/// Raises a score to `to` if the score is lower. Callable from several threads at the same time: the result does not
/// depend on their order.
void raise(float& score, float to);

/// Returns a pseudo-random number in [0, 1) that depends only on `n` and `salt`.
double hashed(std::uint64_t n, std::uint64_t salt);

/// Returns at most `most` pixels of a map in the order in which they should be checked: alternately the most suspicious
/// pixel, the most suspicious pixel of another 8x8 block, and a random pixel, where pixels with high scores are more
/// likely. The result is the same in every run.
std::vector<PixelIndex> ranked(const SuspicionMap& map, scene::ImageSize size, std::size_t most);

/// Suspect pixels for each Suspicion, best first.
using Suspects = std::array<std::vector<PixelIndex>, suspicions>;

/// A pixel to check, and the reason; no reason: the pixel was chosen at random.
struct ChosenPixel {
  PixelIndex at;
  std::optional<Suspicion> why;
};

/// Returns `most` different suspects, chosen from all kinds in turn.
std::vector<ChosenPixel> by_turns(const Suspects& suspects, std::size_t most);

/// Returns `count` different pixels of an image to be judged (all if there are fewer). A third of them are random; the
/// others are suspects of each kind in turn, or random if there are too few suspects. Random pixels come first. The
/// result is the same in every run.
std::vector<ChosenPixel> choose_pixels(scene::ImageSize size, std::size_t count, const Suspects& suspects);

}  // namespace tessera::reference
