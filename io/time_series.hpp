#pragma once

#include <filesystem>

#include "tessera/time_series.hpp"

namespace tessera::io {

using tessera::is_time_series;
using tessera::read_time_series;
using tessera::TimeStep;

/// Throws Error(bad_input) unless the input is there: a file, or of a time series at least one step. For what must not
/// be said of a file that is not there, such as that it is a mesh.
void require_input(const std::filesystem::path& input);

}  // namespace tessera::io
