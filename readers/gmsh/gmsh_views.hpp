// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "scene/time_step_read.hpp"

namespace tessera::readers {

/// Finds the index of a tag in a list of tags. Tags are numbers from a file, in any order and with gaps.
class TagIndex {
 public:
  static constexpr std::size_t none = ~std::size_t{0};

  TagIndex() = default;
  explicit TagIndex(const std::vector<std::size_t>& tags);
  /// Returns the index of a tag in the list, the first one if the tag occurs twice; `none` if it is absent.
  [[nodiscard]] std::size_t find(std::size_t tag) const;

 private:
  std::vector<std::size_t> places_;                          ///< indices by tag, if tags are dense enough
  std::vector<std::pair<std::size_t, std::size_t>> sorted_;  ///< pairs of tag and index, if tags are not dense
};

/// A Gmsh field at one time step.
struct GmshView {
  enum class Of { nodes, elements, element_nodes };

  std::string name;
  Of of = Of::nodes;
  std::size_t components = 1;
  TagIndex places;                               ///< index, in the following arrays, of a node's or element's tag
  std::vector<double> values;                    ///< one entry per node or element
  std::vector<std::vector<double>> node_values;  ///< values for the nodes of each element
};

/// Returns the views that Gmsh has read, at a time step counted from 0, or at the last one. `read` receives the step,
/// `notes` describes views that are left out. Throws Error(bad_input) for a step that does not exist.
std::vector<GmshView> gmsh_views(std::optional<std::size_t> time_step, const std::string& source,
                                 std::vector<std::string>& notes, scene::TimeStepRead& read);

}  // namespace tessera::readers
