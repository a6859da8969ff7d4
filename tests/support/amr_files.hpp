// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <glm/vec3.hpp>
#include <vector>

#include "scene/tet_mesh.hpp"
#include "support/temporary_folder.hpp"

/// Files with levels of refinement, and what holds of all that is read of them.
namespace tessera::io::testing {

/// A block of cells of size 1 / `parts`, by the first and last of them along each axis.
struct Block {
  int level, parts;
  std::array<int, 3> first, last;

  [[nodiscard]] bool holds(const glm::dvec3& p) const;
  /// Cells along an axis.
  [[nodiscard]] int cells(std::size_t axis) const { return last[axis] - first[axis] + 1; }
};

using Field = std::function<double(const glm::dvec3&)>;

double linear(const glm::dvec3& p);
double wavy(const glm::dvec3& p);

/// Blocks whose origin is not a whole number of spacings.
struct AmrScene {
  static constexpr double origin = 0.3, unit = 0.7;
  std::vector<Block> blocks;

  /// The deepest block at a place.
  [[nodiscard]] const Block& block_at(const glm::dvec3& p) const;
  /// The centre of the cell at a place.
  [[nodiscard]] glm::dvec3 centre_at(const glm::dvec3& p) const;
  static double spacing(const Block& block) { return unit / block.parts; }
  static glm::dvec3 low(const Block& block);
  /// A field at the centres of a block's cells, or at their corners, x first.
  static std::vector<double> values(const Block& block, bool points, const Field& at);
};

/// Four cells a side; in it a block of the next level, a block in that, and one two levels finer than the cells around
/// it, which touches the boundary.
AmrScene nested_blocks();

/// As VTK's list of image data; the field is called f.
std::filesystem::path write_vth(const test::TemporaryFolder& folder, const AmrScene& scene, bool points,
                                const Field& at);

/// What else an AMReX plot file may be like.
struct AmrexWish {
  bool single = false, big_endian = false;
  int first_cell = 0;  ///< of the coarsest level's domain along each axis
  int around = 0;      ///< cells beside each box, whose values are nonsense
  bool two_files = false;
};

/// As an AMReX plot file with the fields "other one" and "f". Levels are those of the blocks, of ratio 2 or 4.
std::filesystem::path write_amrex(const test::TemporaryFolder& folder, const AmrScene& scene, const Field& at,
                                  const AmrexWish& wish = {});

/// The mesh fills a box once: no gaps, every triangle inside belongs to two tets, and every place has one value.
void expect_conforming(const scene::TetMesh& mesh, const glm::dvec3& sides);

/// The mesh of cell data has the scene's values: of each tet the one at its centre.
void expect_cells(const scene::TetMesh& mesh, const AmrScene& scene, double side, const Field& at, double tolerance);

/// The mesh of smoothed cell data keeps the values at cells' centres; a linear field is met everywhere but in the
/// outermost half cells of the coarsest level. `side` in cells of that level.
void expect_smooth(const scene::TetMesh& mesh, const AmrScene& scene, double side, const Field& at, bool is_linear,
                   double tolerance);

/// What `named` stands for is read, or refused in one line with a remedy, with bytes of `changed` changed at random and
/// that file cut short; after it the file is as before.
void expect_read_or_refused(const std::filesystem::path& named, const std::filesystem::path& changed, unsigned seeds);

}  // namespace tessera::io::testing
