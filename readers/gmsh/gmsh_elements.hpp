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
  std::vector<std::uint32_t> members;  ///< index of each element's GmshMembership
};

/// The groups and partition of an element.
struct GmshMembership {
  std::vector<int> groups;  ///< numbers of its physical groups, ascending
  int partition = 0;        ///< 0: none
  bool operator<(const GmshMembership& other) const {
    return std::tie(groups, partition) < std::tie(other.groups, other.partition);
  }
};

/// All volume elements that Gmsh has read, each once: ghosts of other partitions are left out, and an element that the
/// file lists for each of its physical groups becomes one element of all these groups.
struct GmshVolumes {
  std::map<int, GmshCell> cells;  ///< by Gmsh's type
  std::vector<GmshElements> elements;
  std::vector<GmshMembership> memberships;
  /// Numbers of elements that are also listed under another number, which is the first; in their order.
  std::vector<std::pair<std::size_t, std::size_t>> other_tags;
};

/// `file` is empty, or an .msh file of MSH 1 or 2, whose list of elements assigns groups element by element. Throws
/// Error(bad_input) for cells that are not rendered.
GmshVolumes gmsh_volumes(const std::filesystem::path& file, const std::string& source, std::vector<std::string>& notes);

}  // namespace tessera::readers
