// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "readers/gmsh/gmsh_cells.hpp"

namespace tessera::readers {

/// Volume elements of one type.
struct GmshElements {
  const GmshCell* cell = nullptr;
  std::size_t nodes_a_cell = 0;
  std::vector<std::size_t> tags, nodes;
  std::vector<std::uint32_t> members;  ///< for each element, the index of its GmshMembership
};

/// The groups and partition of an element.
struct GmshMembership {
  std::vector<int> groups;  ///< numbers of the element's physical groups, ascending
  int partition = 0;        ///< 0: none
  bool operator<(const GmshMembership& other) const {
    return std::tie(groups, partition) < std::tie(other.groups, other.partition);
  }
};

/// All volume elements that Gmsh has read, each once. Ghosts of other partitions are left out. An element that the file
/// lists once for each of its physical groups becomes one element that belongs to all these groups.
struct GmshVolumes {
  std::map<int, GmshCell> cells;  ///< the key is Gmsh's type
  std::vector<GmshElements> elements;
  std::vector<GmshMembership> memberships;
  /// Pairs of element numbers: the second is another number under which the file lists the first. Sorted by the first
  /// member.
  std::vector<std::pair<std::size_t, std::size_t>> other_tags;
};

/// Returns the volume elements. `file` is empty, or an .msh file of MSH 1 or 2, whose list of elements assigns groups
/// to individual elements. Throws Error(bad_input) for cells that are not rendered.
GmshVolumes gmsh_volumes(const std::filesystem::path& file, const std::string& source, std::vector<std::string>& notes);

}  // namespace tessera::readers
