#pragma once

#include <filesystem>

namespace tessera::io::helper {

/// Refuses I-DEAS universal files of which Gmsh's library would leave out cells or misplace points without a word:
/// solids of third order, points in coordinate systems other than the global one, nodes and elements of versions before
/// datasets 2411 and 2412. Throws Error(bad_input). What is no such file is left to the library.
///
/// Source  datasets 2411, 2412 and 2420 of the I-DEAS test data universal file formats (SDRC). The parabolic elements,
///         which go round the base from each corner to the next middle, are turned into Gmsh's order by its library.
void require_read_unv(const std::filesystem::path& file);

}  // namespace tessera::io::helper
