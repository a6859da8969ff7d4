// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace tessera::readers {

/// Throws Error(bad_input) for I-DEAS universal files whose cells or points Gmsh's library would lose or misplace
/// without an error: solids of third order, points in coordinate systems other than the global one, nodes and elements
/// of versions before datasets 2411 and 2412. The library checks other files itself.
///
/// Source  datasets 2411, 2412 and 2420 of the I-DEAS test data universal file formats (SDRC). In these, the nodes of
///         parabolic elements go around the base from each corner to the next midpoint; the library converts them to
///         Gmsh's order.
void require_read_unv(const std::filesystem::path& file);

}  // namespace tessera::readers
