// SPDX-License-Identifier: BSD-3-Clause
#include "reference/curved/curved_inversion.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tessera::reference {
namespace {

constexpr double found_inside = 1e-12;    // in coordinates of the domain, which has size one
constexpr double followed_inside = 1e-6;  // for places that are inside except for rounding in almost flat cells

/// Number of lattice places, the nearest ones, that are tried for a point if no other method finds its place.
constexpr std::size_t most_tried = 8;

std::optional<glm::dvec3> from_lattice(const CellOnRay& cell, double depth, BasisValues& room) {
  const BernsteinBasis seeds(cell.basis->domain(), {4, 4, 4});
  std::vector<std::pair<double, glm::dvec3>> by_distance;
  for (const glm::dvec3& place : seeds.lattice())
    by_distance.emplace_back(glm::length(point_of(cell, place, room).at - glm::dvec3(0, 0, depth)), place);
  std::sort(by_distance.begin(), by_distance.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  by_distance.resize(std::min(by_distance.size(), most_tried));
  for (const auto& seed : by_distance)
    if (const auto place = place_on_ray(cell, depth, seed.second, room);
        place && holds(cell.basis->domain(), *place, found_inside))
      return place;
  return std::nullopt;
}

/// Returns the place of the point halfway between two crossings; no value if the point is not inside.
std::optional<glm::dvec3> middle_place(const CellOnRay& cell, const Crossing& front, const Crossing& back,
                                       BasisValues& room) {
  const double depth = front.depth + (back.depth - front.depth) / 2;
  const auto is_inside = [&](const std::optional<glm::dvec3>& place) {
    return place && holds(cell.basis->domain(), *place, found_inside);
  };
  if (const auto place = place_on_ray(cell, depth, (front.place + back.place) * 0.5, room); is_inside(place))
    return place;
  constexpr int steps = 8;
  for (const Crossing& from : {front, back}) {
    std::optional<glm::dvec3> place = from.place;
    for (int n = 1; n <= steps && place; ++n)
      place = place_on_ray(cell, from.depth + (depth - from.depth) * n / steps, *place, room);
    if (is_inside(place)) return place;
  }
  return from_lattice(cell, depth, room);
}

}  // namespace

InnerPath::InnerPath(const CellOnRay& cell, const Crossing& front, const Crossing& middle, const Crossing& back)
    : cell_(cell) {
  for (const Crossing& c : {front, middle, back}) known_.emplace(c.depth, c.place);
}

glm::dvec3 InnerPath::place(double depth) {
  depth = std::clamp(depth, front(), back());
  const auto after = known_.lower_bound(depth);
  if (after->first == depth) return after->second;
  const auto before = std::prev(after);
  const auto& nearest = depth - before->first < after->first - depth ? *before : *after;
  const glm::dvec3 found = follow(nearest.first, nearest.second, depth, 0);
  known_.emplace(depth, found);
  return found;
}

glm::dvec3 InnerPath::follow(double from, glm::dvec3 place, double to, int halvings) {
  constexpr int most_halvings = 6, most_failures = 8;
  const glm::dvec3 ahead = change_of_place(point_of(cell_, place, room_), glm::dvec3(0, 0, to - from));
  const glm::dvec3 start = std::isfinite(glm::length(ahead)) ? place + ahead : place;
  if (const auto found = place_on_ray(cell_, to, start, room_);
      found && holds(cell_.basis->domain(), *found, followed_inside))
    return *found;
  if (halvings == most_halvings || failures_ == most_failures) {
    failures_ = std::min(failures_ + 1, most_failures);
    return place;
  }
  const double between = from + (to - from) / 2;
  return follow(between, follow(from, place, between, halvings + 1), to, halvings + 1);
}

std::vector<InnerPath> inner_paths(const CellOnRay& cell, std::vector<Crossing> crossings) {
  std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) { return a.depth < b.depth; });
  std::vector<InnerPath> paths;
  BasisValues room;
  for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
    const Crossing &front = crossings[i], &back = crossings[i + 1];
    const double depth = front.depth + (back.depth - front.depth) / 2;
    if (!(depth > front.depth && depth < back.depth)) continue;
    if (const auto place = middle_place(cell, front, back, room))
      paths.emplace_back(cell, front, Crossing{depth, *place}, back);
  }
  return paths;
}

}  // namespace tessera::reference
