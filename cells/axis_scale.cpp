// SPDX-License-Identifier: BSD-3-Clause
#include "cells/axis_scale.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <span>

namespace tessera::cells {
namespace {

constexpr double thinnest = 1.0 / 20;

/// Returns the box around the finite points of cells.
Box box_of_points(std::span<const CellBlock> blocks) {
  Box box;
  for (const CellBlock& block : blocks)
    for (const glm::dvec3& p : block.positions)
      if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z))
        box = {glm::min(box.low, p), glm::max(box.high, p)};
  return box;
}

/// Returns the largest number that is 1, 2 or 5 times a power of ten and not above `number`.
double round_factor(double number) {
  const double unit = std::pow(10.0, std::floor(std::log10(number)));
  const double digits = number / unit;
  return (digits >= 5 ? 5 : digits >= 2 ? 2 : 1) * unit;
}

}  // namespace

glm::dvec3 scale_for_degrees(const Box& box) {
  const glm::dvec3 side = box.high - box.low;
  const double wide = std::max(side.x, side.y), narrow = std::min(side.x, side.y);
  if (box.empty() || !(wide > 0) || !(side.z > 0)) return glm::dvec3(1);
  const double longest = std::max(wide, side.z);
  // Longitude and latitude are not scaled relative to each other, whatever their ratio.
  const bool is_thin = side.z < thinnest * longest || (wide < longest && narrow < thinnest * longest);
  if (!is_thin) return glm::dvec3(1);
  return {1, 1, round_factor(wide / 4 / side.z)};
}

glm::dvec3 chosen_scale(const std::optional<glm::dvec3>& asked, bool xy_in_degrees, const Box& box,
                        std::vector<std::string>& notes) {
  if (asked) return *asked;
  const glm::dvec3 scale = xy_in_degrees ? scale_for_degrees(box) : glm::dvec3(1);
  if (scale != glm::dvec3(1))
    notes.push_back(
        fmt::format("x and y are in degrees, but z is not: z is multiplied by {:g}, because the box was thinner than "
                    "1:20; `scale` 1,1,1 leaves z unchanged",
                    scale.z));
  return scale;
}

void scale_points(MeshBlocks& mesh, const std::optional<glm::dvec3>& asked) {
  const Box box = mesh.xy_in_degrees ? box_of_points(mesh.blocks) : Box();
  mesh.axis_scale = chosen_scale(asked, mesh.xy_in_degrees, box, mesh.notes);
  if (mesh.axis_scale == glm::dvec3(1)) return;
  for (CellBlock& block : mesh.blocks)
    for (glm::dvec3& position : block.positions) position *= mesh.axis_scale;
}

}  // namespace tessera::cells
