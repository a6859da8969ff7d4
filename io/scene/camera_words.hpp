// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "io/scene/camera_file.hpp"

namespace tessera::io {

/// Collects the words of one view, independently of the format of the file, and checks that they define a view.
class CameraWords {
 public:
  /// `place` begins every message: the file and the position of the view in the file.
  explicit CameraWords(std::string place) : place_(std::move(place)) {}

  /// Throws Error(bad_input, "AT: ...") for an unknown or repeated word, or for a wrong count of numbers.
  void set(std::string_view word, std::span<const double> numbers, const std::string& at);

  /// Returns the view. Throws Error(bad_input) if a word is missing, if both or neither of parallel_scale and
  /// view_angle are given, or if scene::validate refuses the view.
  [[nodiscard]] CameraFile finish() const;

 private:
  std::string place_;
  std::optional<glm::dvec3> position_, focal_point_, view_up_;
  std::optional<double> parallel_scale_, view_angle_;
  std::optional<scene::ClippingRange> clipping_range_;
  std::optional<scene::ImageSize> size_;
};

}  // namespace tessera::io
