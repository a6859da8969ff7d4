// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "io/foreign/messages/foreign_data.hpp"
#include "readers/common/holdings.hpp"

namespace tessera::readers {

/// Reads a CGNS file by the CGNS library if VTK's reader would misidentify its cells or refuse it: if faces are
/// numbered before or among the cells, sections are not in the order of their numbers, or there are sections of mixed
/// elements, polyhedra or elements of order 2; if coordinates are R, Theta and Z, solutions cover only some points or
/// cells, or several solutions at a location have fields of one name. Otherwise, and if the library cannot open the
/// file, no value. The request's `time_step` and share of the zones (`part` of `parts`) as in other readers. Throws
/// Error(bad_input).
std::optional<io::ForeignContents> read_cgns_zones(Holdings& holdings, const std::filesystem::path& file,
                                                   const nlohmann::json& request);

}  // namespace tessera::readers
