// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace tessera::readers {

/// Refuses I-DEAS universal files whose cells or points Gmsh's library would silently lose or misplace: solids of third
/// order, points in coordinate systems other than the global one, nodes and elements of versions before datasets 2411
/// and 2412. Throws Error(bad_input). Other files are left to the library.
///
/// Source  datasets 2411, 2412 and 2420 of the I-DEAS test data universal file formats (SDRC). The library converts the
///         parabolic elements, which go around the base from each corner to the next midpoint, to Gmsh's order.
void require_read_unv(const std::filesystem::path& file);

}  // namespace tessera::readers
