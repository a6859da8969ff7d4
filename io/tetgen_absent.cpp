#include <fmt/format.h>

#include "io/surface.hpp"
#include "scene/error.hpp"

namespace tessera::io {

bool can_fill_surfaces() { return false; }

FilledMesh fill_surface(const Surface&, const FillSize&, const std::string& source) {
  throw scene::bad_input(fmt::format(
      "{}: this build does not fill surfaces; build with -DTESSERA_TETGEN=ON or fill it elsewhere", source));
}

}  // namespace tessera::io
