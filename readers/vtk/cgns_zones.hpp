// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "io/foreign/messages/foreign_data.hpp"
#include "readers/common/holdings.hpp"

namespace tessera::readers {

/// Reads a CGNS file by the CGNS library if VTK's reader would misidentify cells or refuse the file. This is the case
/// if faces are numbered before or among the cells, if sections are not in the order of their numbers, or if there are
/// sections of mixed elements, polyhedra or elements of order 2. It is also the case if coordinates are R, Theta and Z,
/// if solutions have values for only some points or cells, or if several solutions at a location have fields of the
/// same name. No value for other files, and for files that the library cannot open. The request's `time_step` and share
/// of the zones (`part` of `parts`) are as in other readers. Throws Error(bad_input).
std::optional<io::ForeignContents> read_cgns_zones(Holdings& holdings, const std::filesystem::path& file,
                                                   const nlohmann::json& request);

}  // namespace tessera::readers
