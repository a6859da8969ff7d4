// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tessera::readers {

/// One element as listed in MSH 1 or 2. Gmsh writes an element once for each of its physical groups, each time under
/// another number, and its library stores groups only by geometric entity.
struct GmshElementTags {
  std::size_t element = 0;
  int group = 0;      ///< physical group; 0: none
  int partition = 0;  ///< its partition, not those that have it as a ghost; 0: not partitioned
};

/// The elements of a file of MSH 1 or 2, text or binary, by number. No value for other versions, or if the list cannot
/// be parsed (then groups are those of the entities).
std::optional<std::vector<GmshElementTags>> gmsh_element_tags(const std::filesystem::path& file);

/// The text of a binary MSH 2 file with elements without partitions; empty for other files, and if the list of elements
/// cannot be parsed.
std::string binary_without_partitions(std::string_view text);

}  // namespace tessera::readers
