// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/nastran_systems.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <numbers>

#include "scene/error.hpp"
#include "tessera/program/text.hpp"

namespace tessera::io {
namespace {

constexpr std::size_t no_point = std::numeric_limits<std::size_t>::max();
/// Cosine and sine of an angle in degrees, exact for multiples of 90 degrees.
glm::dvec2 direction(double degrees) {
  const double within = std::remainder(degrees, 360), angle = within * std::numbers::pi / 180;
  if (within == 90 || within == -90) return {0, within / 90};
  if (within == 180 || within == -180) return {-1, 0};
  return {std::cos(angle), std::sin(angle)};
}

constexpr std::size_t most_systems_deep = 1000;  // nesting limit, so that a damaged file cannot overflow the stack

}  // namespace

bool NastranSystems::is_used(std::string_view entry) {
  return entry == "GRID" || entry == "GRDSET" || entry.starts_with("CORD");
}

void NastranSystems::add(const NastranEntry& entry) {
  const std::string& name = entry.name();
  if (name == "GRID") return add_point(entry);
  if (name == "GRDSET") {
    default_system_ = entry.whole_number(1).value_or(0);
    return;
  }
  const std::string_view form = std::string_view(name).substr(4);
  const bool is_read =
      form.size() == 2 && (form[0] == '1' || form[0] == '2') && (form[1] == 'R' || form[1] == 'C' || form[1] == 'S');
  const std::int64_t id = entry.whole_number(0).value_or(0);
  if (!is_read) {
    unread_[id] = name;
    return;
  }
  System system{};
  system.kind = static_cast<Kind>(form[1]);
  if (form[0] == '2') {
    system.reference = entry.whole_number(1).value_or(0);
    for (std::size_t c = 0; c < 9; ++c) system.corners[c / 3][static_cast<int>(c % 3)] = entry.real(2 + c);
    systems_[id] = system;
    return;
  }
  system.of_points = true;
  for (std::size_t first = 0; first < 8 && !entry.is_blank(first); first += 4) {  // an entry defines one or two systems
    for (std::size_t k = 0; k < 3; ++k) system.points[k] = entry.whole_number(first + 1 + k).value_or(0);
    systems_[entry.whole_number(first).value_or(0)] = system;
  }
}

void NastranSystems::add_point(const NastranEntry& entry) {
  const auto id = entry.whole_number(0);
  if (!id) entry.refuse("GRID has no number; correct it");
  Point point{.id = *id, .system = entry.whole_number(1).value_or(0), .has_system = !entry.is_blank(1)};
  for (std::size_t a = 0; a < 3; ++a) point.given[static_cast<int>(a)] = entry.real(2 + a);
  if (points_.size() >= std::numeric_limits<std::uint32_t>::max() - 1)
    entry.refuse("the file has 2^32 points or more; split it");
  points_.push_back(point);
}

std::size_t NastranSystems::find(std::int64_t id) const {
  const auto at = std::ranges::lower_bound(points_, id, {}, &Point::id);
  return at == points_.end() || at->id != id ? no_point : static_cast<std::size_t>(at - points_.begin());
}

std::optional<std::uint32_t> NastranSystems::point(std::int64_t id) const {
  const std::size_t at = find(id);
  return at == no_point ? std::nullopt : std::optional(static_cast<std::uint32_t>(at));
}

const NastranSystems::System& NastranSystems::system(std::int64_t id, const std::string& user) {
  const auto refuse = [&](const std::string& what) {
    return scene::bad_input(fmt::format("{}: {} is in the coordinate system {}, {}", source_, user, id, what));
  };
  const auto found = systems_.find(id);
  if (found == systems_.end()) {
    const auto unread = unread_.find(id);
    throw unread == unread_.end()
        ? refuse("which the file does not have; add it, or add the file that contains it")
        : refuse(
              fmt::format("a {}, which is not supported; write the points in the basic system", quote(unread->second)));
  }
  System& system = found->second;
  if (system.progress == Progress::done) return system;
  if (system.progress == Progress::begun || depth_ >= most_systems_deep)
    throw refuse("which refers back to itself, or refers to a chain of a thousand others; correct it");
  system.progress = Progress::begun;
  ++depth_;
  const std::string own = fmt::format("coordinate system {}", id);
  std::array<glm::dvec3, 3> corners{};
  for (std::size_t k = 0; k < 3; ++k) {
    if (!system.of_points) {
      corners[k] = in_basic(system.reference, system.corners[k], own);
      continue;
    }
    const std::size_t point = find(system.points[k]);
    if (point == no_point)
      throw refuse(fmt::format("which uses GRID {}, which the file does not have; add it", system.points[k]));
    corners[k] = place(point);
  }
  --depth_;
  const glm::dvec3 up = corners[1] - corners[0], y = glm::cross(up, corners[2] - corners[0]);
  if (!(glm::dot(up, up) > 0) || !(glm::dot(y, y) > 0)) throw refuse("whose three points are on one line; correct it");
  system.origin = corners[0];
  system.axes[2] = glm::normalize(up);
  system.axes[1] = glm::normalize(y);
  system.axes[0] = glm::cross(system.axes[1], system.axes[2]);
  system.progress = Progress::done;
  return system;
}

glm::dvec3 NastranSystems::in_basic(std::int64_t id, const glm::dvec3& p, const std::string& user) {
  if (id == 0) return p;
  const System& of = system(id, user);
  glm::dvec3 own = p;
  if (of.kind == Kind::cylindrical) {  // coordinates: radius, angle from x, height
    const glm::dvec2 around = p.x * direction(p.y);
    own = {around.x, around.y, p.z};
  }
  if (of.kind == Kind::spherical) {  // coordinates: radius, angle from z, angle from x
    const glm::dvec2 up = p.x * direction(p.y), around = up.y * direction(p.z);
    own = {around.x, around.y, up.x};
  }
  return of.origin + of.axes * own;
}

const glm::dvec3& NastranSystems::place(std::size_t point) {
  Point& p = points_[point];
  if (p.progress == Progress::done) return positions_[point];
  if (p.progress == Progress::begun)
    throw scene::bad_input(
        fmt::format("{}: GRID {} is in a coordinate system that it defines itself; correct it", source_, p.id));
  p.progress = Progress::begun;
  positions_[point] = in_basic(p.has_system ? p.system : default_system_, p.given, fmt::format("GRID {}", p.id));
  p.progress = Progress::done;
  return positions_[point];
}

void NastranSystems::place_points(const std::string& source) {
  source_ = source;
  std::ranges::stable_sort(points_, {}, &Point::id);
  const auto repeated = std::ranges::adjacent_find(points_, [](const Point& a, const Point& b) {
    return a.id == b.id && (a.given != b.given || a.system != b.system);
  });
  if (repeated != points_.end())
    throw scene::bad_input(
        fmt::format("{}: GRID {} is given twice, at different places; remove one", source, repeated->id));
  const auto is_same = [](const Point& a, const Point& b) { return a.id == b.id; };
  points_.erase(std::unique(points_.begin(), points_.end(), is_same), points_.end());
  positions_.assign(points_.size(), glm::dvec3(0));
  for (std::size_t v = 0; v < points_.size(); ++v) place(v);
}

}  // namespace tessera::io
