#include "io/foreign_geometry.hpp"

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>

#include "io/volume_formats.hpp"

namespace tessera::io {

void set_image_geometry(const ForeignPart& image, scene::GridGeometry& g) {
  std::array<glm::dvec3, 3> steps;
  for (std::size_t axis = 0; axis < 3; ++axis)
    steps[axis] =
        glm::dvec3(image.direction[axis], image.direction[3 + axis], image.direction[6 + axis]) * image.spacing[axis];
  set_axes(g, steps);
  g.origin = {image.origin[0], image.origin[1], image.origin[2]};
  for (std::size_t axis = 0; axis < 3; ++axis)  // origin is that of index 0, which need not be in the extent
    if (image.extent[2 * axis] != 0) g.origin += steps[axis] * static_cast<double>(image.extent[2 * axis]);
}

}  // namespace tessera::io
