#pragma once

#include "frame/mesh_input.hpp"

namespace tessera::apps {

using frame::diagonal;
using frame::read_input;

}  // namespace tessera::apps
