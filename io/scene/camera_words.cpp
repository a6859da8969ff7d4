// SPDX-License-Identifier: BSD-3-Clause
#include "io/scene/camera_words.hpp"

#include <fmt/format.h>

#include <cmath>

#include "io/text/text_file.hpp"
#include "scene/error.hpp"

namespace tessera::io {
namespace {

int pixel_count(double number, const std::string& at) {
  if (number != std::floor(number) || number < 1 || number > scene::max_image_side)
    throw scene::bad_input(fmt::format("{}: size has a side of {}; each is a whole number, 1 to {} pixels", at, number,
                                       scene::max_image_side));
  return static_cast<int>(number);
}

}  // namespace

void CameraWords::set(std::string_view word, std::span<const double> numbers, const std::string& at) {
  const auto expect = [&](std::size_t count, bool present) {
    if (present) throw scene::bad_input(fmt::format("{}: {} is given twice; keep one", at, word));
    if (numbers.size() != count)
      throw scene::bad_input(fmt::format("{}: {} has {} number{}; it takes {}", at, word, numbers.size(),
                                         numbers.size() == 1 ? "" : "s", count));
  };
  const auto set_vector = [&](std::optional<glm::dvec3>& target) {
    expect(3, target.has_value());
    target = {numbers[0], numbers[1], numbers[2]};
  };
  const auto set_number = [&](std::optional<double>& target) {
    expect(1, target.has_value());
    target = numbers[0];
  };
  if (word == "position") {
    set_vector(position_);
  } else if (word == "focal_point") {
    set_vector(focal_point_);
  } else if (word == "view_up") {
    set_vector(view_up_);
  } else if (word == "parallel_scale") {
    set_number(parallel_scale_);
  } else if (word == "view_angle") {
    set_number(view_angle_);
  } else if (word == "clipping_range") {
    expect(2, clipping_range_.has_value());
    clipping_range_ = {numbers[0], numbers[1]};
  } else if (word == "size") {
    expect(2, size_.has_value());
    size_ = {pixel_count(numbers[0], at), pixel_count(numbers[1], at)};
  } else {
    throw scene::bad_input(
        fmt::format("{}: {} is not a setting of a camera; use position, focal_point, view_up, parallel_scale, "
                    "view_angle, clipping_range or size",
                    at, quote(word)));
  }
}

CameraFile CameraWords::finish() const {
  const auto fault = [&](const char* what) { return scene::bad_input(place_ + ": " + what); };
  if (!position_) throw fault("position is missing; give the position of the eye, three numbers");
  if (!focal_point_) throw fault("focal_point is missing, so the camera has no direction; give the point it looks at");
  if (parallel_scale_ && view_angle_)
    throw fault(
        "parallel_scale and view_angle are both given; keep the first for an orthographic view, the second for "
        "a perspective one");
  if (!parallel_scale_ && !view_angle_)
    throw fault(
        "neither parallel_scale nor view_angle is given; give the first for an orthographic view, the second "
        "for a perspective one");
  CameraFile view;
  view.camera.position = *position_;
  view.camera.focal_point = *focal_point_;
  if (view_up_) view.camera.view_up = *view_up_;
  if (parallel_scale_) {
    view.camera.projection = scene::ProjectionKind::orthographic;
    view.camera.parallel_scale = *parallel_scale_;
  } else {
    view.camera.projection = scene::ProjectionKind::perspective;
    view.camera.view_angle = *view_angle_;
  }
  view.camera.clipping_range = clipping_range_;
  view.size = size_;
  try {
    scene::validate(view.camera);
    if (view.size) scene::validate(*view.size);
  } catch (const scene::Error& error) {
    throw scene::Error(error.code(), place_ + ": " + error.what());
  }
  return view;
}

}  // namespace tessera::io
