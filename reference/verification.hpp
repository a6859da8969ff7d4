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

/// What was found in the pixels chosen for one reason.
struct Tally {
  std::size_t pixels = 0;
  double max_error = 0;  ///< excused pixels included
  std::size_t over_bound = 0, excused = 0;
};

/// Whether a picture keeps what its method promises, as some of its pixels tell.
///
/// Passed  no pixel is over the bound but the excused ones, and of those chosen at random no more are excused than a
///         sample may hold (most_excused()). Those chosen because they are suspicious may all be excused: they were
///         looked for where that is likely.
struct Verification {
  Judgement judgement;          ///< of all pixels; but rms_error is of the random ones, an estimate of the picture's
  std::optional<double> bound;  ///< none: errors are reported, nothing is promised
  Tally random;                 ///< all of them, if all pixels of the picture were checked
  std::array<Tally, suspicions> chosen{};  ///< by Suspicion
  std::optional<Suspicion> worst;          ///< why the worst pixel was chosen; none: at random

  [[nodiscard]] bool met() const;
};

/// Judges `count` pixels of an image (choose_pixels()). Every pixel over the bound is examined for an excuse, until a
/// hundred have none. `threads` 0: all cores.
Verification verify(const scene::Image& image, const RayReference& reference, std::optional<double> bound,
                    std::size_t count, const Suspects& suspects, int threads = 0);

}  // namespace tessera::reference
