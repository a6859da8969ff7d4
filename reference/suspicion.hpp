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

/// Why a pixel is looked at rather than another. Of a picture (image_suspicion.hpp), of a scene (mesh_suspicion.hpp,
/// grid_suspicion.hpp), of the renderer that made the picture.
enum class Suspicion {
  edge,      ///< differs much from a neighbour
  outlier,   ///< does not fit what its neighbours lead up to, along any direction
  block,     ///< in a 4x4 block that stands out against what is around it: one packet of rays
  plateau,   ///< one of many of one colour: a pixel of each
  estimate,  ///< the renderer's own estimate of the error is large, or another way of its own comes out otherwise
  step,      ///< light there hangs on roundings of the field: steps, steep ramps
  border,    ///< at blank (NaN) samples of a grid
  tie,       ///< the ray passes through an edge, a vertex or a face seen edge-on, or very nearly does
  depth      ///< light there hangs on roundings of depth: dense, thin matter
};
inline constexpr std::size_t suspicions = 9;

/// "edge", "outlier", ...
const char* name_of(Suspicion suspicion);

/// How suspicious each pixel is, row-major; 0: not at all. Scores compare within one map only.
using SuspicionMap = std::vector<float>;

/// Raises a score to `score` where it is lower. From any threads at once: the outcome does not depend on their order.
void raise(float& score, float to);

/// A number in [0, 1) that depends on `n` and `salt` alone.
double hashed(std::uint64_t n, std::uint64_t salt);

/// A map's pixels in the order they are to be looked at, `most` at most: by turns the most suspicious one, the most
/// suspicious one of another 8x8 pixels, and one drawn at random, high scores more often. Repeatable.
std::vector<PixelIndex> ranked(const SuspicionMap& map, scene::ImageSize size, std::size_t most);

/// Pixels to look at for each Suspicion, best first.
using Suspects = std::array<std::vector<PixelIndex>, suspicions>;

/// A pixel that is looked at, and why; at random if there is no reason.
struct ChosenPixel {
  PixelIndex at;
  std::optional<Suspicion> why;
};

/// `most` different suspects, of each kind by turns.
std::vector<ChosenPixel> by_turns(const Suspects& suspects, std::size_t most);

/// Pixels of a picture to be judged, `count` different ones (all of them if there are no more): a third at random, the
/// rest from the suspects of each kind by turns; at random again where there are too few. Pixels at random come first.
/// The same in every run.
std::vector<ChosenPixel> choose_pixels(scene::ImageSize size, std::size_t count, const Suspects& suspects);

}  // namespace tessera::reference
