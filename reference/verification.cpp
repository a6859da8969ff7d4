// SPDX-License-Identifier: BSD-3-Clause
#include "reference/verification.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace tessera::reference {

bool Verification::met() const {
  if (!std::isfinite(judgement.max_error)) return false;
  return !bound || judgement.passed;
}

Verification verify(const scene::Image& image, const RayReference& reference, std::optional<double> bound,
                    std::size_t count, const Suspects& suspects, int threads) {
  const std::vector<ChosenPixel> pixels = choose_pixels(image.size, count, suspects);
  std::vector<PixelIndex> places;
  places.reserve(pixels.size());
  for (const ChosenPixel& pixel : pixels) places.push_back(pixel.at);
  // Without a bound, no pixel exceeds it, so none is examined for an excuse.
  const double most = bound.value_or(std::numeric_limits<double>::infinity());
  const std::vector<PixelJudgement> judged = judge_each(image, reference, most, places, threads, places.size());

  Verification found;
  found.bound = bound;
  Judgement& all = found.judgement;
  all.pixels_checked = pixels.size();
  double sum_of_squares = 0;
  for (std::size_t i = 0; i < judged.size(); ++i) {
    const PixelJudgement& pixel = judged[i];
    Tally& tally = pixels[i].why ? found.chosen[static_cast<std::size_t>(*pixels[i].why)] : found.random;
    ++tally.pixels;
    tally.max_error = std::max(tally.max_error, pixel.error);
    tally.over_bound += pixel.over_bound ? 1 : 0;
    tally.excused += pixel.excused ? 1 : 0;
    all.over_bound += pixel.over_bound ? 1 : 0;
    all.excused += pixel.excused ? 1 : 0;
    if (!pixel.excused) all.max_error_not_excused = std::max(all.max_error_not_excused, pixel.error);
    if (!pixels[i].why)
      for (std::size_t c = 0; c < 4; ++c)
        sum_of_squares += (pixel.value[c] - pixel.truth[c]) * (pixel.value[c] - pixel.truth[c]);
    if (i == 0 || pixel.error > all.max_error) {
      all.max_error = pixel.error;
      all.worst_x = pixels[i].at.x, all.worst_y = pixels[i].at.y;
      all.worst_value = pixel.value, all.worst_reference = pixel.truth;
      found.worst = pixels[i].why;
    }
  }
  if (found.random.pixels > 0)
    all.rms_error = std::sqrt(sum_of_squares / (4 * static_cast<double>(found.random.pixels)));
  const bool sample = found.random.pixels < image.depth.size();
  all.passed = all.over_bound == all.excused && found.random.excused <= most_excused(found.random.pixels, sample);
  return found;
}

}  // namespace tessera::reference
