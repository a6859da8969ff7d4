// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>

#include "annotation/drawing.hpp"
#include "tessera/annotation.hpp"

namespace tessera::annotation {

/// Colours of a style, in the image's own values (linear light, or display values).
class Ink {
 public:
  explicit Ink(const AnnotationStyle& style);

  [[nodiscard]] glm::dvec3 color(Pen pen) const;
  /// The colour that surrounds all ink, so that text and lines are readable over any image.
  [[nodiscard]] glm::dvec3 halo() const { return halo_; }

 private:
  [[nodiscard]] double light(const glm::dvec3& color) const;

  glm::dvec3 ink_, halo_;
  bool display_, dark_;
};

}  // namespace tessera::annotation
