#pragma once

#include <nlohmann/json_fwd.hpp>

#include "cells/surface.hpp"

namespace tessera::io {

/// A surface as the helper is handed it, and back. surface_of() throws std::exception for what is none.
nlohmann::json json_of(const Surface& surface);
Surface surface_of(const nlohmann::json& json);

}  // namespace tessera::io
