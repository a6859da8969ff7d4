// SPDX-License-Identifier: BSD-3-Clause
#include "cells/field_choice.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <span>

#include "support/mesh_checks.hpp"

namespace tessera::io {
namespace {

using scene::Association;
using testing::message_of;

cells::BlockField field(const std::string& name, Association association, std::vector<double> values,
                        int components = 1) {
  return cells::field_of_values(name, "double", association, components, std::move(values));
}

cells::CellBlock block_with(std::vector<cells::BlockField> fields) {
  cells::CellBlock block;
  block.fields = std::move(fields);
  return block;
}

std::vector<cells::FieldSummary> summary(std::span<const cells::CellBlock> blocks) {
  const std::vector<cells::FieldTally> tallies = cells::tally_fields(blocks);
  return cells::summarize_fields(std::span(&tallies, 1));
}

cells::FieldChoice choose(const std::string& requested, const cells::CellBlock& block) {
  const std::vector<cells::CellBlock> blocks = {block};
  return cells::choose_field(requested, summary(blocks), "mesh.vtu");
}

const cells::CellBlock flow = block_with(
    {field("Density", Association::point, {1, 1}), field("Momentum", Association::point, {1, 0, 0, 0, 3, 4}, 3),
     field("StagnationEnergy", Association::point, {-1, 4}), field("ObjectId", Association::cell, {0, 1}),
     field("stress: max", Association::cell, {5, 6})});

TEST(FieldChoice, DefaultSkipsConstantsAndLabels) {
  EXPECT_EQ(choose("", flow).label, "StagnationEnergy");
  const cells::CellBlock labels_first =
      block_with({field("GlobalNodeId", Association::point, {0, 1}), field("speed", Association::cell, {0, 1})});
  EXPECT_EQ(choose("", labels_first).label, "speed");
}

TEST(FieldChoice, DefaultPrefersTheActiveScalarsIfTheyVary) {
  cells::CellBlock block = block_with({field("a", Association::point, {0, 1}), field("b", Association::point, {0, 2})});
  block.fields[1].active = true;
  EXPECT_EQ(choose("", block).label, "b");
  block.fields[1] = field("b", Association::point, {2, 2});
  block.fields[1].active = true;
  EXPECT_EQ(choose("", block).label, "a");
}

TEST(FieldChoice, DefaultTakesPointsBeforeCellsAndScalarsBeforeVectors) {
  const cells::BlockField vector = field("v", Association::point, {0, 0, 0, 1, 1, 1}, 3);
  const cells::BlockField cell = field("c", Association::cell, {0, 1});
  EXPECT_EQ(choose("", block_with({cell, vector})).label, "v:mag");
  EXPECT_EQ(choose("", block_with({cell, vector, field("p", Association::point, {0, 1})})).label, "p");
}

TEST(FieldChoice, IndicesAndPartsAreNotDefaultsWhereShapesAreShown) {
  const cells::CellBlock labels =
      block_with({field("vtkOriginalCellIds", Association::cell, {0, 1}), field("BLOCK_I", Association::cell, {0, 1})});
  const std::vector<cells::FieldSummary> fields = summary({&labels, 1});
  EXPECT_EQ(cells::choose_field("", fields, "mesh.vtu").label, "BLOCK_I");
  const cells::FieldChoice shape = cells::choose_field("", fields, "mesh.vtu", true);
  EXPECT_TRUE(shape.shape);
  EXPECT_TRUE(shape.name.empty());
  ASSERT_EQ(shape.notes.size(), 1u);
  EXPECT_NE(shape.notes.front().find("BLOCK_I"), std::string::npos);
  EXPECT_EQ(cells::choose_field("BLOCK_I", fields, "mesh.vtu", true).label, "BLOCK_I");
  for (const char* name :
       {"rank", "BLOCK_K", "mpi_rank", "material_id", "subdomain", "gid", "NodeNumber", "elem_num", "cell index"})
    EXPECT_TRUE(cells::is_label_name(name));
  for (const char* name : {"mach_number", "refractive_index", "k_eps", "materiality"})
    EXPECT_FALSE(cells::is_label_name(name));
}

TEST(FieldChoice, NamesIndicateLabelsOfWholeNumbersOnly) {
  const cells::BlockField other = field("other", Association::cell, {0.5, 0.75});
  for (const char* name : {"k", "i", "K", "zone", "process", "proc", "block", "region", "rank", "material_id"}) {
    const cells::CellBlock quantity = block_with({field(name, Association::point, {0.25, 3, 7, 7}), other});
    EXPECT_EQ(choose("", quantity).label, name);
    EXPECT_EQ(cells::choose_field("", summary(std::vector{quantity}), "mesh.vtu", true).label, name);
    EXPECT_EQ(choose("", block_with({field(name, Association::point, {0, 3, 7, 7}), other})).label, "other") << name;
    // One part of the file has only integers, the other part also has a fraction.
    const std::vector<cells::CellBlock> parts = {block_with({field(name, Association::point, {0, 3, 7, 7}), other}),
                                                 quantity};
    EXPECT_EQ(cells::choose_field("", summary(parts), "mesh.vtu").label, name);
  }
}

cells::BlockField integers(const std::string& name, std::vector<double> values) {
  return cells::field_of_values(name, "int64", Association::point, 1, std::move(values));
}

/// The numbers first, first + 1, ... in a pseudo-random order.
std::vector<double> shuffled(std::size_t count, double first) {
  std::vector<double> values(count);
  for (std::size_t k = 0; k < count; ++k) values[k * 37 % count] = first + static_cast<double>(k);
  return values;
}

TEST(FieldChoice, NumbersOfPointsAreIdsByAnyName) {
  const cells::BlockField cells = field("porosity", Association::cell, {0.1, 0.2});
  for (const double first : {0.0, 1.0})
    for (const std::size_t count : {std::size_t{4}, std::size_t{64}, std::size_t{1000}})
      for (const cells::BlockField& ids :
           {integers("nr", shuffled(count, first)), field("nr", Association::point, shuffled(count, first))}) {
        const std::vector<cells::FieldSummary> fields = summary(std::vector{block_with({ids, cells})});
        EXPECT_TRUE(fields[0].ids) << count;
        EXPECT_EQ(cells::choose_field("", fields, "mesh.vtu").label, "porosity");
        EXPECT_EQ(cells::choose_field("", fields, "mesh.vtu", true).label, "porosity");
      }
  // Integers may begin anywhere; floats that do not begin at 0 or 1 are pressures.
  EXPECT_EQ(choose("", block_with({integers("nr", shuffled(90, 501)), cells})).label, "porosity");
  EXPECT_EQ(choose("", block_with({field("p", Association::point, shuffled(90, 300)), cells})).label, "p");
  // Values are not ids if one occurs twice, is missing, or is between two integers, or if they are vectors.
  std::vector<double> twice = shuffled(90, 0);
  twice[7] = twice[8];
  EXPECT_EQ(choose("", block_with({integers("n", twice), cells})).label, "n");
  std::vector<double> gap = shuffled(90, 0);
  std::ranges::replace(gap, 50.0, 90.0);
  EXPECT_EQ(choose("", block_with({integers("n", gap), cells})).label, "n");
  std::vector<double> between = shuffled(90, 0);
  between[3] += 0.5;
  EXPECT_EQ(choose("", block_with({field("n", Association::point, between), cells})).label, "n");
  std::vector<double> axis(90 * 3, 0);
  for (std::size_t k = 0; k < 90; ++k) axis[3 * k] = static_cast<double>(k);
  EXPECT_EQ(choose("", block_with({field("v", Association::point, axis, 3), cells})).label, "v:mag");
}

TEST(FieldChoice, RecognizesIdsInBlocksAndParts) {
  const cells::BlockField cells = field("porosity", Association::cell, {0.1, 0.2});
  std::vector<double> whole = shuffled(200, 0);
  const auto block_of = [&](std::size_t first, std::size_t count) {
    const auto begin = whole.begin() + static_cast<std::ptrdiff_t>(first);
    return block_with({integers("nr", {begin, begin + static_cast<std::ptrdiff_t>(count)}), cells});
  };
  const std::vector<cells::CellBlock> blocks = {block_of(0, 60), block_of(60, 90), block_of(150, 50)};
  const std::vector<cells::FieldSummary> together = summary(blocks);
  EXPECT_TRUE(together[0].ids);
  std::vector<std::vector<cells::FieldTally>> parts;
  for (const cells::CellBlock& block : blocks) parts.push_back(cells::tally_fields(std::span(&block, 1)));
  EXPECT_EQ(cells::summarize_fields(parts), together);
  // Each block numbers its own points, beginning at 0.
  const std::vector<cells::CellBlock> own = {block_with({integers("nr", shuffled(20, 0)), cells}),
                                             block_with({integers("nr", shuffled(33, 0)), cells})};
  EXPECT_TRUE(summary(own)[0].ids);
  const std::vector<cells::CellBlock> other = {own[0], block_with({integers("nr", std::vector<double>(33, 5)), cells})};
  EXPECT_FALSE(summary(other)[0].ids);
}

TEST(FieldChoice, IdsAreTheLastChoiceAndAreNoted) {
  const cells::BlockField constant = field("T", Association::point, {300, 300});
  const cells::CellBlock many = block_with({field("nr", Association::point, shuffled(100, 0)), constant});
  EXPECT_TRUE(cells::choose_field("", summary(std::vector{many}), "mesh.vtu", true).shape);
  EXPECT_EQ(choose("nr", many).label, "nr");
  const cells::CellBlock few = block_with({field("p", Association::point, {0, 1, 2, 3, 4, 5, 6, 7}), constant});
  const cells::FieldChoice chosen = cells::choose_field("", summary(std::vector{few}), "mesh.vtu", true);
  EXPECT_EQ(chosen.label, "p");
  ASSERT_EQ(chosen.notes.size(), 2u);
  EXPECT_NE(chosen.notes[1].find("they may be ids"), std::string::npos);
  const cells::CellBlock numbered = block_with({integers("p", {0, 1, 2, 3, 4, 5, 6, 7}), constant});
  EXPECT_TRUE(cells::choose_field("", summary(std::vector{numbered}), "mesh.vtu", true).shape);
  // A field that the file marks as ids is not chosen if there is another field.
  cells::CellBlock marked =
      block_with({field("n", Association::point, {7, 3, 3, 9}), field("c", Association::cell, {0, 5})});
  EXPECT_EQ(choose("", marked).label, "n");
  marked.fields[0].ids = true;
  EXPECT_EQ(choose("", marked).label, "c");
  for (const char* name : {"GLOBAL_IDS_POINTS", "GlobalNodeId", "node_ids_global", "vtkGlobalIds", "PointIds", "id"})
    EXPECT_TRUE(cells::is_label_name(name)) << name;
  for (const char* name : {"fluid", "Solid", "idle", "Humidity", "residual", "grid_x"})
    EXPECT_FALSE(cells::is_label_name(name)) << name;
}

TEST(FieldChoice, NoiseAroundZeroIsShownWithANote) {
  const cells::BlockField noise = field("y", Association::point, {-1e-15, 2e-15});
  EXPECT_EQ(choose("", block_with({noise, field("p", Association::cell, {0, 1})})).label, "p");
  const cells::FieldChoice alone = choose("", block_with({noise}));
  EXPECT_EQ(alone.label, "y");
  ASSERT_EQ(alone.notes.size(), 1u);
  EXPECT_NE(alone.notes.front().find("noise"), std::string::npos);
  // Values that are small but never negative may be a charge or a permeability, so there is no note.
  EXPECT_TRUE(choose("", block_with({field("k", Association::point, {1e-15, 2e-13})})).notes.empty());
}

TEST(FieldChoice, ReportsAFileWithoutFields) {
  const cells::FieldChoice choice = choose("", cells::CellBlock{});
  EXPECT_TRUE(choice.name.empty());
  ASSERT_EQ(choice.notes.size(), 1u);
  EXPECT_NE(message_of([] { choose("x", cells::CellBlock{}); }).find("the file has no fields"), std::string::npos);
}

TEST(FieldChoice, ReadsComponents) {
  EXPECT_EQ(choose("Momentum", flow).component, cells::magnitude);
  EXPECT_EQ(choose("Momentum:mag", flow).label, "Momentum:mag");
  EXPECT_EQ(choose("Momentum:y", flow).component, 1);
  EXPECT_EQ(choose("Momentum:2", flow).label, "Momentum:z");
  EXPECT_EQ(choose("point:Momentum:x", flow).component, 0);
  EXPECT_NE(message_of([] { choose("Momentum:3", flow); }).find("use :mag or :0 to :2"), std::string::npos);
  EXPECT_NE(message_of([] { choose("Momentum:w", flow); }).find("has 3 components, but not 'w'"), std::string::npos);
  EXPECT_NE(message_of([] { choose("Density:y", flow); }).find("use the name alone"), std::string::npos);
}

TEST(FieldChoice, NamesMayHoldColonsAndSpaces) {
  EXPECT_EQ(choose("stress: max", flow).name, "stress: max");
  EXPECT_EQ(choose("cell:stress: max", flow).association, Association::cell);
  const cells::CellBlock odd =
      block_with({field("a", Association::point, {0, 0, 0, 1, 1, 1}, 3), field("a:x", Association::point, {7, 8})});
  EXPECT_EQ(choose("a:x", odd).name, "a:x");
  EXPECT_EQ(choose("a:y", odd).name, "a");
}

TEST(FieldChoice, APrefixChoosesBetweenPointAndCell) {
  const cells::CellBlock both =
      block_with({field("s", Association::cell, {0, 1}), field("s", Association::point, {0, 1})});
  EXPECT_EQ(choose("s", both).association, Association::point);
  EXPECT_EQ(choose("s", both).notes.size(), 1u);
  EXPECT_EQ(choose("cell:s", both).association, Association::cell);
  EXPECT_TRUE(choose("point:s", both).notes.empty());
  EXPECT_NE(message_of([] { choose("cell:Density", flow); }), "");
}

TEST(FieldChoice, AWrongNameListsAllNames) {
  const std::string message = message_of([] { choose("Temperature", flow); });
  EXPECT_EQ(message,
            "mesh.vtu: there is no field 'Temperature'; it has point:'Density', point:'Momentum' (3 components), "
            "point:'StagnationEnergy', cell:'ObjectId', cell:'stress: max'");
}

TEST(FieldChoice, RecognizesLabelsByTheirNames) {
  for (const char* name :
       {"GlobalNodeId", "ObjectId", "vtkOriginalCellIds", "vtkGhostType", "IBlank", "node_id", "Material #", "PartIDs"})
    EXPECT_TRUE(cells::is_label_name(name)) << name;
  for (const char* name : {"Fluid", "Solid", "Void", "Temp", "acid", "Grid velocity", "MID"})
    EXPECT_FALSE(cells::is_label_name(name)) << name;
}

TEST(FieldSummary, CountsNaNAndInfiniteAndLeavesThemOutOfTheRange) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const std::vector<cells::CellBlock> blocks = {block_with({field("s", Association::point, {nan, -2, inf, 5, -inf}),
                                                            field("v", Association::point, {3, 4, 0, nan, 0, 0}, 3),
                                                            field("large", Association::point, {3e200, 4e200, 0}, 3)})};
  const std::vector<cells::FieldSummary> fields = summary(blocks);
  EXPECT_EQ(fields[0].nan_count, 3u);
  EXPECT_EQ(fields[0].low, -2);
  EXPECT_EQ(fields[0].high, 5);
  EXPECT_EQ(fields[1].nan_count, 1u);
  EXPECT_EQ(fields[1].high, 5);
  EXPECT_DOUBLE_EQ(fields[2].high, 5e200);
}

}  // namespace
}  // namespace tessera::io
