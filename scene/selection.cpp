// SPDX-License-Identifier: BSD-3-Clause
#include "scene/selection.hpp"

#include <fmt/format.h>

#include <glm/common.hpp>

#include "scene/directions.hpp"
#include "scene/error.hpp"

namespace tessera {
inline namespace v0_1 {
std::array<HalfSpace, 6> half_spaces_of(const Box& box) {
  std::array<HalfSpace, 6> sides;
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 normal(0);
    normal[axis] = 1;
    sides[static_cast<std::size_t>(2 * axis)] = {box.low, normal};
    sides[static_cast<std::size_t>(2 * axis + 1)] = {box.high, -normal};
  }
  return sides;
}

void validate(const Selection& selection) {
  for (const HalfSpace& h : selection.clip) {
    if (!scene::finite(h.point) || !scene::finite(h.normal))
      throw scene::bad_input("`clip`: a plane's numbers are not all finite; give a point and a normal");
    if (h.normal == glm::dvec3(0))
      throw scene::bad_input(
          "`clip`: a normal of 0,0,0 has no direction; give a normal that points to the side to keep");
  }
  if (!selection.threshold) return;
  const auto [low, high] = *selection.threshold;
  if (!(low <= high))
    throw scene::bad_input(
        fmt::format("`threshold`: {:g} to {:g} is not a range; give the smaller number first", low, high));
}

}  // namespace v0_1
}  // namespace tessera
