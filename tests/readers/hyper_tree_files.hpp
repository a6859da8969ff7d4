// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "support/amr_files.hpp"

/// HyperTreeGrids as text, written according to the format.
namespace tessera::io::testing {

/// A cell of a tree.
struct TreeCell {
  glm::dvec3 low{}, high{};
  int level = 0;
  std::size_t first_child = 0;  ///< 0: a leaf

  [[nodiscard]] glm::dvec3 centre() const { return 0.5 * (low + high); }
  [[nodiscard]] bool holds(const glm::dvec3& p) const;
};

struct TreeScene {
  std::array<std::vector<double>, 3> axes;  ///< coordinates of the roots' corners
  int branching = 2;
  std::function<bool(const TreeCell&)> is_divided;
  std::function<bool(const TreeCell&)> is_masked = [](const TreeCell&) { return false; };

  /// The cells of one root, level by level. Masked ones are not divided.
  [[nodiscard]] std::vector<TreeCell> tree(const std::array<std::size_t, 3>& root) const;
  /// The leaves of all roots that are not masked.
  [[nodiscard]] std::vector<TreeCell> leaves() const;
  [[nodiscard]] glm::dvec3 sides() const;
};

/// Optional properties of a file.
struct TreeWish {
  int version = 2;
  bool transposed = false;
  std::function<bool(const std::array<std::size_t, 3>&)> has_root = [](const auto&) { return true; };
  /// Bits of vtkGhostType; null: none.
  std::function<int(const TreeCell&)> ghost{};
};

/// The text of a file with the field "f" and the vectors "v", whose second component is the field too. Divided cells
/// have 1e30.
std::string htg_text(const TreeScene& scene, const Field& at, const TreeWish& wish = {});

}  // namespace tessera::io::testing
