#pragma once

#include "io/foreign_data.hpp"
#include "scene/grid.hpp"

namespace tessera::io {

/// Origin, spacing and direction of an image.
void set_image_geometry(const ForeignPart& image, scene::GridGeometry& geometry);

}  // namespace tessera::io
