// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "io/foreign/messages/foreign_data.hpp"
#include "readers/common/holdings.hpp"

namespace tessera::readers {

/// Reads a CGNS file by the CGNS library where VTK's reader would take other elements for its cells, or refuse it:
/// where faces are numbered before or among the cells, sections come in another order than their numbers, or there are
/// sections of mixed elements, polyhedra or elements of order 2; where coordinates are R, Theta and Z, solutions are of
/// some points or cells alone, or several at a location have fields of one name. Otherwise, and where the library
/// cannot open the file, nothing. The request's `time_step` and share of the zones (`part` of `parts`) as of other
/// readers. Throws Error(bad_input).
std::optional<io::ForeignContents> read_cgns_zones(Holdings& holdings, const std::filesystem::path& file,
                                                   const nlohmann::json& request);

}  // namespace tessera::readers
