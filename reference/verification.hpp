// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "reference/judge.hpp"
#include "reference/ray_reference.hpp"
#include "reference/suspicion.hpp"
#include "scene/image.hpp"

namespace tessera::reference {

/// The result for the pixels chosen for one reason.
struct Tally {
  std::size_t pixels = 0;
  double max_error = 0;  ///< including excused pixels
  std::size_t over_bound = 0, excused = 0;
};

/// Whether an image keeps its method's promise, according to a sample of its pixels.
///
/// Passed  only excused pixels are over the bound, and among those chosen at random no more are excused than a sample
///         may contain (most_excused()). All pixels chosen as suspicious may be excused, because they were chosen where
///         excuses are likely.
struct Verification {
  Judgement judgement;                     ///< all checked pixels; rms_error: estimated from the random ones
  std::optional<double> bound;             ///< no value: errors are reported, but there is no promise to check
  Tally random;                            ///< all checked pixels, if all pixels of the image are checked
  std::array<Tally, suspicions> chosen{};  ///< indexed by Suspicion
  std::optional<Suspicion> worst;          ///< why the pixel with the largest error was chosen; no value: at random

  [[nodiscard]] bool met() const;
};

/// Judges `count` pixels of an image (choose_pixels()). Every pixel over the bound is examined for an excuse, until a
/// hundred pixels do not have one. `threads` 0: all cores.
Verification verify(const scene::Image& image, const RayReference& reference, std::optional<double> bound,
                    std::size_t count, const Suspects& suspects, int threads = 0);

}  // namespace tessera::reference
