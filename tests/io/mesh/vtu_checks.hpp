// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "cells/cell_block.hpp"
#include "io/foreign/client/foreign_file.hpp"
#include "io/vtk/vtk_xml_file.hpp"

namespace tessera::test {

/// All values of a block's field, in order.
inline std::vector<double> values_of(const cells::BlockField& field, int component) {
  std::vector<double> values(field.tuples);
  field.read(component, 0, values);
  return values;
}

/// A text cannot store the sign and payload of a NaN.
inline bool is_same(double a, double b) {
  return (std::isnan(a) && std::isnan(b)) || std::memcmp(&a, &b, sizeof a) == 0;
}

/// Expects the same bits, and reports the first values that differ.
inline void expect_same_values(const std::vector<double>& a, const std::vector<double>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) ASSERT_TRUE(is_same(a[k], b[k])) << k << ": " << a[k] << " and " << b[k];
}

/// Expects blocks to have the same cells, fields and values, to the bit.
inline void expect_same_blocks(const cells::CellBlock& a, const cells::CellBlock& b) {
  EXPECT_EQ(a.name, b.name);
  ASSERT_EQ(a.positions.size(), b.positions.size());
  for (std::size_t v = 0; v < a.positions.size(); ++v)
    for (int axis = 0; axis < 3; ++axis)
      ASSERT_TRUE(is_same(a.positions[v][axis], b.positions[v][axis]))
          << "point " << v << ": " << a.positions[v][axis] << " and " << b.positions[v][axis];
  EXPECT_EQ(a.types, b.types);
  EXPECT_EQ(a.offsets, b.offsets);
  EXPECT_EQ(a.connectivity, b.connectivity);
  EXPECT_EQ(a.tets, b.tets);
  EXPECT_EQ(a.faces, b.faces);
  EXPECT_EQ(a.face_locations, b.face_locations);
  EXPECT_EQ(a.point_ghost, b.point_ghost);
  EXPECT_EQ(a.cell_ghost, b.cell_ghost);
  ASSERT_EQ(a.fields.size(), b.fields.size());
  for (std::size_t k = 0; k < a.fields.size(); ++k) {
    const cells::BlockField &x = a.fields[k], &y = b.fields[k];
    SCOPED_TRACE("field " + x.name);
    EXPECT_EQ(x.name, y.name);
    EXPECT_EQ(x.association, y.association);
    EXPECT_EQ(x.components, y.components);
    EXPECT_EQ(x.type, y.type);
    EXPECT_EQ(x.active, y.active);
    ASSERT_EQ(x.tuples, y.tuples);
    ASSERT_TRUE(x.tally && y.tally);
    EXPECT_EQ(x.tally->any_finite, y.tally->any_finite);
    EXPECT_EQ(x.tally->not_finite, y.tally->not_finite);
    EXPECT_TRUE(is_same(x.tally->low, y.tally->low) && is_same(x.tally->high, y.tally->high));
    for (int c = 0; c < x.components; ++c) {
      SCOPED_TRACE(c);
      expect_same_values(values_of(x, c), values_of(y, c));
    }
  }
}

/// The only block of a .vtu that this process reads.
inline cells::CellBlock vtu_block(const std::filesystem::path& file) {
  const auto opened = io::open_vtk_xml(file);
  EXPECT_TRUE(opened.has_value()) << file << " is left to VTK's reader";
  if (!opened) return {};
  std::vector<std::string> notes;
  std::vector<cells::CellBlock> blocks = io::blocks_of(*opened, notes);
  EXPECT_TRUE(notes.empty());
  EXPECT_EQ(blocks.size(), 1u);
  return blocks.empty() ? cells::CellBlock() : std::move(blocks.front());
}

}  // namespace tessera::test
