#pragma once

#include <string>

#include "io/surface.hpp"

namespace tessera::io {

/// An STL surface by VTK, each face with points of its own. Throws Error(bad_input, "SOURCE: ...").
Surface read_stl(const std::string& source);

}  // namespace tessera::io
