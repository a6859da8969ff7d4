// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tessera::readers {

/// One element as listed in MSH 1 or 2. Gmsh writes an element once for each of its physical groups, with a different
/// number each time. Gmsh's library stores the groups only for geometric entities.
struct GmshElementTags {
  std::size_t element = 0;
  int group = 0;      ///< physical group; 0: none
  int partition = 0;  ///< partition of the element, not one that has the element as a ghost; 0: not partitioned
};

/// Returns the elements of a file of MSH 1 or 2, text or binary, sorted by number. No value for other versions, or if
/// the list cannot be parsed (groups are then those of the entities).
std::optional<std::vector<GmshElementTags>> gmsh_element_tags(const std::filesystem::path& file);

/// Returns the text of a binary MSH 2 file after removing the partitions of its elements. Empty for other files, and if
/// the list of elements cannot be parsed.
std::string binary_without_partitions(std::string_view text);

}  // namespace tessera::readers
