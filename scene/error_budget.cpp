#include "scene/error_budget.hpp"

#include <fmt/format.h>

#include <cmath>

#include "scene/error.hpp"

namespace tessera::scene {

void check_accuracy(double accuracy) {
  if (!(accuracy > 0) || !std::isfinite(accuracy))
    throw bad_input(fmt::format("`accuracy` {}: it must be positive", accuracy));
  if (accuracy < error_budget::least_accuracy)
    throw bad_input(fmt::format("`accuracy` {}: pictures are of 32-bit numbers, which keep {} at best; give no less",
                                accuracy, error_budget::least_accuracy));
}

}  // namespace tessera::scene
