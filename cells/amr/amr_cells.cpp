// SPDX-License-Identifier: BSD-3-Clause
#include "cells/amr/amr_cells.hpp"

#include <algorithm>
#include <array>

#include "tessera/cell_type.hpp"

namespace tessera::cells {
namespace {

constexpr std::uint8_t tetra = vtk_number(CellType::tetra), voxel = vtk_number(CellType::voxel);

AmrIndex moved(AmrIndex p, std::size_t axis, std::int32_t by) {
  p[axis] += by;
  return p;
}

/// Returns corner k of a cube; x varies fastest with k.
AmrIndex corner_of(const AmrCube& cube, unsigned k) {
  return {cube.low[0] + ((k & 1) != 0 ? cube.size : 0), cube.low[1] + ((k & 2) != 0 ? cube.size : 0),
          cube.low[2] + ((k & 4) != 0 ? cube.size : 0)};
}

glm::dvec3 place_of(const AmrLattice& lattice, int steps, const AmrIndex& p) {
  const auto along = [&](std::size_t a) { return lattice.position(a, static_cast<double>(p[a]) / steps); };
  return {along(0), along(1), along(2)};
}

std::vector<glm::dvec3> places_of(const AmrLattice& lattice, int steps, const AmrVertices& corners) {
  std::vector<glm::dvec3> places;
  places.reserve(corners.size());
  for (std::size_t v = 0; v < corners.size(); ++v) places.push_back(place_of(lattice, steps, corners[v]));
  return places;
}

void add_cell(CellBlock& block, std::uint8_t type, std::span<const std::uint32_t> corners) {
  block.types.push_back(type);
  block.connectivity.insert(block.connectivity.end(), corners.begin(), corners.end());
  block.offsets.push_back(block.connectivity.size());
}

/// Divides cubes that touch finer ones.
class Divider {
 public:
  Divider(const AmrLattice& lattice, int steps, AmrCubes& cubes, CellBlock& block)
      : lattice_(lattice), steps_(steps), cubes_(cubes), block_(block) {}

  void add(const AmrCube& cube) {
    std::array<std::uint32_t, 8> corner;
    for (unsigned k = 0; k < 8; ++k) corner[k] = cubes_.corners.find(corner_of(cube, k));
    if (!has_hanging(cube)) return add_cell(block_, voxel, corner);
    apex_ = add_centre(cube.low, corner_of(cube, 7), corner);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      add_face(cube.low, axis, cube.size);
      add_face(moved(cube.low, axis, cube.size), axis, cube.size);
    }
  }

 private:
  /// Returns the size of the parts into which an edge or face of this length is divided; 0 if it is not divided.
  [[nodiscard]] std::int32_t finer_than(std::int32_t size) const {
    for (const auto& [from, to] : cubes_.finer)
      if (from == size) return to;
    return 0;
  }

  /// Whether corners of other cubes are on an edge of the cube. A corner on a face implies others on the edges of that
  /// face.
  [[nodiscard]] bool has_hanging(const AmrCube& cube) const {
    const std::int32_t part = finer_than(cube.size);
    if (part == 0) return false;
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (unsigned k = 0; k < 8; ++k)
        if ((k & (1u << axis)) == 0 && cubes_.corners.has(moved(corner_of(cube, k), axis, part))) return true;
    return false;
  }

  /// Appends the corners of other cubes inside an edge, without its ends, in order.
  void hanging_on(const AmrIndex& p, std::size_t axis, std::int32_t length, std::vector<std::uint32_t>& out) const {
    const std::int32_t part = finer_than(length);
    if (part == 0 || !cubes_.corners.has(moved(p, axis, part))) return;
    for (std::int32_t at = 0; at < length; at += part) {
      if (at > 0) out.push_back(cubes_.corners.find(moved(p, axis, at)));
      hanging_on(moved(p, axis, at), axis, part, out);
    }
  }

  void add_face(const AmrIndex& low, std::size_t axis, std::int32_t size) {
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    const std::int32_t part = finer_than(size);
    if (part != 0 && cubes_.corners.has(moved(moved(low, u, part), v, part))) {
      for (std::int32_t j = 0; j < size; j += part)
        for (std::int32_t i = 0; i < size; i += part) add_face(moved(moved(low, u, i), v, j), axis, part);
      return;
    }
    const std::array<std::uint32_t, 4> corner{cubes_.corners.find(low), cubes_.corners.find(moved(low, u, size)),
                                              cubes_.corners.find(moved(moved(low, u, size), v, size)),
                                              cubes_.corners.find(moved(low, v, size))};
    round_.clear();
    const auto add_side = [&](std::uint32_t begin, const AmrIndex& from, std::size_t along, bool backwards) {
      round_.push_back(begin);
      const auto first = static_cast<std::ptrdiff_t>(round_.size());
      hanging_on(from, along, size, round_);
      if (backwards) std::reverse(round_.begin() + first, round_.end());
    };
    add_side(corner[0], low, u, false);
    add_side(corner[1], moved(low, u, size), v, false);
    add_side(corner[2], moved(low, v, size), u, true);
    add_side(corner[3], low, v, true);
    if (round_.size() == 4) {
      // The lowest corner has the smallest position, and split_cell() cuts from the smallest.
      add_tet(corner[0], corner[1], corner[2]);
      add_tet(corner[0], corner[2], corner[3]);
      return;
    }
    // The corners are added in the order of the axes, so that the mean does not depend on which cube the face belongs
    // to.
    const std::uint32_t centre = add_centre(low, moved(moved(low, u, size), v, size), corner);
    for (std::size_t k = 0; k < round_.size(); ++k) add_tet(centre, round_[k], round_[(k + 1) % round_.size()]);
  }

  /// Adds the centre between two opposite corners. Where steps are not uniform, it is not the middle of the lattice
  /// cell.
  std::uint32_t add_centre(const AmrIndex& low, const AmrIndex& high, std::span<const std::uint32_t> corners) {
    double sum = 0;
    for (const std::uint32_t c : corners) sum += cubes_.values[c];
    cubes_.values.push_back(sum / static_cast<double>(corners.size()));
    block_.positions.push_back(0.5 * (place_of(lattice_, steps_, low) + place_of(lattice_, steps_, high)));
    return static_cast<std::uint32_t>(block_.positions.size() - 1);
  }

  void add_tet(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const std::array<std::uint32_t, 4> corners{a, b, c, apex_};
    add_cell(block_, tetra, corners);
  }

  const AmrLattice& lattice_;
  int steps_;
  AmrCubes& cubes_;
  CellBlock& block_;
  std::uint32_t apex_ = 0;
  std::vector<std::uint32_t> round_;
};

CellBlock empty_block(const AmrLattice& lattice, int steps, const AmrCubes& cubes) {
  CellBlock block;
  block.positions = places_of(lattice, steps, cubes.corners);
  block.types.reserve(cubes.cubes.size());
  block.offsets.reserve(cubes.cubes.size() + 1);
  block.connectivity.reserve(8 * cubes.cubes.size());
  block.offsets.push_back(0);
  return block;
}

}  // namespace

CellBlock voxels_of(const AmrLattice& lattice, int steps, AmrCubes cubes, const std::string& field) {
  CellBlock block = empty_block(lattice, steps, cubes);
  std::array<std::uint32_t, 8> corner{};
  for (const AmrCube& cube : cubes.cubes) {
    for (unsigned k = 0; k < 8; ++k) corner[k] = cubes.corners.find(corner_of(cube, k));
    add_cell(block, voxel, corner);
  }
  block.fields.push_back(field_of_values(field, "double", scene::Association::cell, 1, std::move(cubes.values)));
  return block;
}

CellBlock conforming_cells(const AmrLattice& lattice, int steps, AmrCubes cubes, const std::string& field) {
  CellBlock block = empty_block(lattice, steps, cubes);
  Divider divider(lattice, steps, cubes, block);
  for (const AmrCube& cube : cubes.cubes) divider.add(cube);
  block.fields.push_back(field_of_values(field, "double", scene::Association::point, 1, std::move(cubes.values)));
  return block;
}

}  // namespace tessera::cells
