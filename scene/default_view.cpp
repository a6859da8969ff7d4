// SPDX-License-Identifier: BSD-3-Clause
#include "tessera/default_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>
#include <vector>

#include "scene/directions.hpp"
#include "scene/error.hpp"

namespace tessera {
inline namespace v0_1 {
namespace {

using scene::bad_input;
using scene::finite;
using scene::largest;
using scene::rotated;
using scene::unit;
using std::numbers::pi;

constexpr double degree = pi / 180;

/// The direction from the centre of the box to the eye, and the up direction.
struct Direction {
  glm::dvec3 to_eye, up;
};

struct Extent {
  glm::dvec3 center, half;
  double radius;  ///< > 0
};

Extent extent_of(const Box& box) {
  const glm::dvec3 center = box.low + (box.high - box.low) * 0.5;
  const glm::dvec3 half = (box.high - box.low) * 0.5;
  double radius = glm::length(half / std::max(largest(half), 1e-300)) * largest(half);
  if (!(radius > 0)) radius = largest(center) > 0 ? largest(center) * 1e-6 : 1;
  return {center, half, radius};
}

Camera framed(const Box& box, ImageSize size, const glm::dvec3& to_eye, const glm::dvec3& upward,
              ProjectionKind projection, bool turning) {
  Camera camera;
  camera.projection = projection;
  const auto [center, half, radius] = extent_of(box);
  camera.focal_point = center;
  camera.position = center + to_eye * (3 * radius);
  camera.view_up = upward;

  std::vector<glm::dvec3> outline;  // offsets, from the centre, of points that must be in the image
  outline.reserve(8);
  for (int corner = 0; corner < 8; ++corner)
    outline.emplace_back((corner & 1) ? half.x : -half.x, (corner & 2) ? half.y : -half.y,
                         (corner & 4) ? half.z : -half.z);
  if (turning) {
    constexpr int steps = 72;  // between two steps a corner moves outwards by at most 0.1 %, much less than the margin
    for (int step = 1; step < steps; ++step)
      for (int corner = 0; corner < 8; ++corner)
        outline.push_back(rotated(outline[static_cast<std::size_t>(corner)], upward, step * 2 * pi / steps));
  }

  constexpr double margin = 1.05;
  const ViewBasis basis = view_basis(camera);
  const double aspect = static_cast<double>(size.width) / size.height;
  const double slope = std::tan(camera.view_angle / 2 * pi / 180) / margin;
  double fit = 0, distance = margin * radius;
  for (const glm::dvec3& offset : outline) {
    const double needed =
        std::max(std::abs(glm::dot(offset, basis.up)), std::abs(glm::dot(offset, basis.right)) / aspect);
    fit = std::max(fit, needed);
    // Perspective: at depth distance + z the half height of the view is (distance + z) times the tangent.
    distance = std::max(distance, needed / slope - glm::dot(offset, basis.forward));
  }
  camera.parallel_scale = margin * (fit > 0 ? fit : radius);
  if (projection == ProjectionKind::perspective) camera.position = center + to_eye * distance;
  return camera;
}

void check(const ViewRequest& request) {
  if (request.up && (!finite(*request.up) || !(largest(*request.up) > 0)))
    throw bad_input("`up` is not a direction; give three numbers that are not all zero");
  if (!std::isfinite(request.azimuth)) throw bad_input("`azimuth` is not finite; give degrees");
  if (!std::isfinite(request.elevation)) throw bad_input("`elevation` is not finite; give degrees");
  if (!(request.zoom > 0) || !std::isfinite(request.zoom))
    throw bad_input(fmt::format("`zoom` is {}; it must be above 0", request.zoom));
}

/// Half of the box's extent along a unit vector.
double extent_along(const glm::dvec3& half, const glm::dvec3& axis) {
  return half.x * std::abs(axis.x) + half.y * std::abs(axis.y) + half.z * std::abs(axis.z);
}

Direction default_direction(const Box& box, const std::optional<glm::dvec3>& asked_up, BodyAxes axes) {
  const glm::dvec3 up = asked_up ? unit(*asked_up) : glm::dvec3(0, 0, 1);
  // The side towards the eye, at the level of the horizon; if y is up, it is the side at +z.
  const glm::dvec3 face = std::abs(up.y) > 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, axes == BodyAxes::ras ? 1 : -1, 0);
  glm::dvec3 front = unit(face - up * glm::dot(face, up));
  glm::dvec3 right = glm::cross(up, front);
  const glm::dvec3 half = box.empty() ? glm::dvec3(1) : extent_of(box).half;
  const double height = extent_along(half, up), width = extent_along(half, right), depth = extent_along(half, front);
  if (axes == BodyAxes::none && depth > 1.5 * width) front = std::exchange(right, -front);
  const bool flat = height < 0.2 * std::min(width, depth);
  const double azimuth = 30 * degree, elevation = (flat ? 60 : 25) * degree;
  return {(front * std::cos(azimuth) + right * std::sin(azimuth)) * std::cos(elevation) + up * std::sin(elevation), up};
}

Direction direction_of(const ViewRequest& request, const Box& box, BodyAxes axes) {
  const auto along = [&](const glm::dvec3& to_eye, const glm::dvec3& up) {
    return Direction{to_eye, request.up ? unit(*request.up) : up};
  };
  const glm::dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  // Directions to the front and to the left of a patient; for other data, the file's -y and -x.
  const glm::dvec3 front = axes == BodyAxes::ras ? y : -y, left = axes == BodyAxes::lps ? x : -x;
  switch (request.view) {
    case StandardView::front:
      return along(front, z);
    case StandardView::back:
      return along(-front, z);
    case StandardView::left:
      return along(left, z);
    case StandardView::right:
      return along(-left, z);
    case StandardView::along_x:
      return along(-x, z);
    case StandardView::against_x:
      return along(x, z);
    case StandardView::along_y:
      return along(-y, z);
    case StandardView::against_y:
      return along(y, z);
    case StandardView::top:
    case StandardView::against_z:
      return along(z, y);
    case StandardView::bottom:
    case StandardView::along_z:
      return along(-z, y);
    case StandardView::iso:
      return along(unit(x - y + z), z);
    case StandardView::automatic:
      break;
  }
  return default_direction(box, request.up, axes);
}

/// Applies vtkCamera's Azimuth and then its Elevation. At a pole, vtkCamera's view up would be along the view
/// direction; here the up direction turns with the view.
Direction turned(Direction direction, const ViewRequest& request) {
  if (request.azimuth != 0) direction.to_eye = rotated(direction.to_eye, direction.up, request.azimuth * degree);
  if (request.elevation != 0) {
    const glm::dvec3 right = unit(glm::cross(direction.up, direction.to_eye));
    direction.to_eye = rotated(direction.to_eye, right, -request.elevation * degree);
    if (glm::length(glm::cross(direction.up, unit(direction.to_eye))) < 1e-3)
      direction.up = rotated(direction.up, right, -request.elevation * degree);
  }
  return direction;
}

Camera zoomed(Camera camera, double zoom) {
  if (zoom == 1) return camera;
  if (camera.projection == ProjectionKind::orthographic) {
    camera.parallel_scale /= zoom;
  } else {
    // The tangent is divided, so that sizes in the image grow exactly by `zoom`. vtkCamera divides the angle.
    camera.view_angle = 2 * std::atan(std::tan(camera.view_angle / 2 * degree) / zoom) / degree;
  }
  try {
    validate(camera);
  } catch (const Error&) {
    throw bad_input(
        fmt::format("`zoom` is {}: pixels of that size cannot be computed; give a value nearer to 1", zoom));
  }
  return camera;
}

}  // namespace

std::optional<StandardView> standard_view(std::string_view word) {
  using enum StandardView;
  constexpr std::array<std::pair<std::string_view, StandardView>, 13> words{{{"front", front},
                                                                             {"back", back},
                                                                             {"left", left},
                                                                             {"right", right},
                                                                             {"top", top},
                                                                             {"bottom", bottom},
                                                                             {"iso", iso},
                                                                             {"+x", along_x},
                                                                             {"-x", against_x},
                                                                             {"+y", along_y},
                                                                             {"-y", against_y},
                                                                             {"+z", along_z},
                                                                             {"-z", against_z}}};
  const auto* const found = std::ranges::find(words, word, &std::pair<std::string_view, StandardView>::first);
  return found == words.end() ? std::nullopt : std::optional(found->second);
}

Camera frame_box(const Box& box, ImageSize size, ProjectionKind projection, bool turning) {
  if (box.empty()) {
    Camera camera;
    camera.projection = projection;
    return camera;
  }
  // The two longest sides are seen from the front, a little from above and from the right. The shortest side points
  // approximately to the eye, so that plates show their large face, and the longest side is along the width of the
  // image.
  const glm::dvec3 half = extent_of(box).half;
  std::array<int, 3> axes{0, 1, 2};
  std::stable_sort(axes.begin(), axes.end(), [&](int a, int b) { return half[a] > half[b]; });
  glm::dvec3 along{0}, upward{0}, toward{0};
  along[axes[0]] = 1;
  upward[axes[1]] = 1;
  toward[axes[2]] = 1;
  return framed(box, size, unit(toward + 0.45 * upward + 0.6 * along), upward, projection, turning);
}

Camera frame_box_along(const Box& box, ImageSize size, const glm::dvec3& to_eye, const glm::dvec3& up,
                       ProjectionKind projection, bool turning) {
  Camera checked;
  checked.position = to_eye, checked.focal_point = glm::dvec3(0), checked.view_up = up;
  validate(checked);
  if (!box.empty()) return framed(box, size, unit(to_eye), unit(up), projection, turning);
  checked.projection = projection;
  return checked;
}

Camera view_of_box(const Box& box, ImageSize size, const ViewRequest& request, ProjectionKind projection, BodyAxes axes,
                   bool turning) {
  check(request);
  const Direction named = direction_of(request, box, axes);
  if (request.up && !(glm::length(glm::cross(named.to_eye, named.up)) > 1e-9))
    throw bad_input("`up` is parallel to the view direction; turn it away from it");
  const Direction direction = turned(named, request);
  return zoomed(frame_box_along(box, size, direction.to_eye, direction.up, projection, turning), request.zoom);
}

Camera adjusted_view(const Camera& camera, const Box& box, ImageSize size, const ViewRequest& request) {
  check(request);
  if (request.view != StandardView::automatic || request.up)
    throw bad_input("`view` and `up`: the camera already defines them; leave them out");
  Camera seen = camera;
  if (request.azimuth != 0 || request.elevation != 0) {
    const glm::dvec3 offset = camera.position - camera.focal_point;
    const Direction direction = turned({offset, unit(camera.view_up)}, request);
    seen.position = camera.focal_point + direction.to_eye;
    seen.view_up = direction.up;
  }
  if (request.fit) seen = frame_box_along(box, size, seen.position - seen.focal_point, seen.view_up, camera.projection);
  return zoomed(seen, request.zoom);
}

}  // namespace v0_1
}  // namespace tessera
