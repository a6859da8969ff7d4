// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <glm/vec3.hpp>
#include <vector>

#include "scene/tet_mesh.hpp"
#include "support/temporary_folder.hpp"

/// Files with refinement levels, and checks that apply to all of them.
namespace tessera::io::testing {

/// A block of cells of size 1 / `parts`, given by the first and last of them along each axis.
struct Block {
  int level, parts;
  std::array<int, 3> first, last;

  [[nodiscard]] bool holds(const glm::dvec3& p) const;
  /// Number of cells along an axis.
  [[nodiscard]] int cells(std::size_t axis) const { return last[axis] - first[axis] + 1; }
};

using Field = std::function<double(const glm::dvec3&)>;

double linear(const glm::dvec3& p);
double wavy(const glm::dvec3& p);

/// Blocks whose origin is not a multiple of the spacing.
struct AmrScene {
  static constexpr double origin = 0.3, unit = 0.7;
  std::vector<Block> blocks;

  /// The deepest block that contains a place.
  [[nodiscard]] const Block& block_at(const glm::dvec3& p) const;
  /// The centre of the cell that contains a place.
  [[nodiscard]] glm::dvec3 centre_at(const glm::dvec3& p) const;
  static double spacing(const Block& block) { return unit / block.parts; }
  static glm::dvec3 low(const Block& block);
  /// A field at the centres of a block's cells, or at their corners, x fastest.
  static std::vector<double> values(const Block& block, bool points, const Field& at);
};

/// Four cells a side; in it a block of the next level, a block in that, and one two levels finer than the cells around
/// it, which touches the boundary.
AmrScene nested_blocks();

/// As VTK's list of image data; the field is called f.
std::filesystem::path write_vth(const test::TemporaryFolder& folder, const AmrScene& scene, bool points,
                                const Field& at);

/// Optional properties of an AMReX plot file.
struct AmrexWish {
  bool single = false, big_endian = false;
  int first_cell = 0;  ///< of the coarsest level's domain along each axis
  int around = 0;      ///< cells around each box, whose values are meaningless
  bool two_files = false;
};

/// As an AMReX plot file with the fields "other one" and "f". Levels are those of the blocks, with ratio 2 or 4.
std::filesystem::path write_amrex(const test::TemporaryFolder& folder, const AmrScene& scene, const Field& at,
                                  const AmrexWish& wish = {});

/// The mesh fills a box exactly once: no gaps, every inner triangle belongs to two tets, and every place has one value.
void expect_conforming(const scene::TetMesh& mesh, const glm::dvec3& sides);

/// The mesh of cell data has the scene's values: for each tet the one at its centre.
void expect_cells(const scene::TetMesh& mesh, const AmrScene& scene, double side, const Field& at, double tolerance);

/// The mesh of smoothed cell data keeps the values at cells' centres; a linear field is reproduced everywhere except in
/// the outermost half cells of the coarsest level. `side` in cells of that level.
void expect_smooth(const scene::TetMesh& mesh, const AmrScene& scene, double side, const Field& at, bool is_linear,
                   double tolerance);

/// `named` is read, or refused in one line with a remedy, with random bytes of `changed` changed and with that file
/// truncated; afterwards the file is restored.
void expect_read_or_refused(const std::filesystem::path& named, const std::filesystem::path& changed, unsigned seeds);

}  // namespace tessera::io::testing
