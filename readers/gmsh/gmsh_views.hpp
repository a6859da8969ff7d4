// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "scene/time_step_read.hpp"

namespace tessera::readers {

/// A list of tags (numbers that a file gives, in any order and with gaps) turned round.
class TagIndex {
 public:
  static constexpr std::size_t none = ~std::size_t{0};

  TagIndex() = default;
  explicit TagIndex(const std::vector<std::size_t>& tags);
  /// The place of a tag in the list, the first if it is there twice; none if it is not there.
  [[nodiscard]] std::size_t find(std::size_t tag) const;

 private:
  std::vector<std::size_t> places_;                          ///< by tag, where tags are dense enough
  std::vector<std::pair<std::size_t, std::size_t>> sorted_;  ///< tag and place
};

/// A field of Gmsh's at one time step.
struct GmshView {
  enum class Of { nodes, elements, element_nodes };

  std::string name;
  Of of = Of::nodes;
  std::size_t components = 1;
  TagIndex places;                               ///< of nodes' or elements' tags in what follows
  std::vector<double> values;                    ///< of nodes and elements
  std::vector<std::vector<double>> node_values;  ///< of the nodes of each element
};

/// The views of what Gmsh has read at a time step counted from 0, or the last one. `read` says which it is, notes
/// what is left out. Throws Error(bad_input) for a step that there is not.
std::vector<GmshView> gmsh_views(std::optional<std::size_t> time_step, const std::string& source,
                                 std::vector<std::string>& notes, scene::TimeStepRead& read);

}  // namespace tessera::readers
