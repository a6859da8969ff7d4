// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tessera::readers {

/// One element as MSH 1 or 2 lists it. Gmsh writes an element once for each physical group that it is in, under
/// another number each time, and its library keeps groups by geometric entity only.
struct GmshElementTags {
  std::size_t element = 0;
  int group = 0;      ///< physical group; 0: none
  int partition = 0;  ///< that it belongs to, of those that have it as a ghost none; 0: not partitioned
};

/// The elements of a file of MSH 1 or 2, text or binary, by their numbers; none of other versions, nor where the list
/// cannot be followed (then groups are those of the entities).
std::optional<std::vector<GmshElementTags>> gmsh_element_tags(const std::filesystem::path& file);

/// The text of a binary file of MSH 2 with elements in no partitions; empty for others, and where the list of elements
/// cannot be followed.
std::string binary_without_partitions(std::string_view text);

}  // namespace tessera::readers
