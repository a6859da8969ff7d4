// SPDX-License-Identifier: BSD-3-Clause
// .vtu files as read by this process and by VTK's reader: the same cells and values to the bit. In addition to our own
// files, those in a directory named by the environment variable TESSERA_VTU_FILES.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <nlohmann/json.hpp>

#include "io/files/input_file.hpp"
#include "io/mesh/vtu_checks.hpp"
#include "io/mesh/vtu_writing.hpp"
#include "support/mesh_checks.hpp"
#include "support/polyhedral_meshes.hpp"
#include "support/some_cases.hpp"
#include "support/temporary_folder.hpp"
#include "support/vtk_or_skip.hpp"

namespace tessera::io {
namespace {

using test::vtu_file_text;
using test::VtuPiece;

cells::CellBlock block_by_vtk(const std::filesystem::path& file) {
  const ForeignFile opened =
      open_foreign(std::make_shared<HelperProcess>(), file, {{"reader", "vtk_xml"}, {"type", "UnstructuredGrid"}});
  std::vector<std::string> notes;
  std::vector<cells::CellBlock> blocks = blocks_of(opened, notes);
  EXPECT_EQ(blocks.size(), 1u);
  return std::move(blocks.at(0));
}

enum class Outcome : std::uint8_t { same, refused_by_both, left_to_vtk, refused_here, refused_by_vtk };

Outcome compare(const std::filesystem::path& file, std::string& line) {
  bool known = true;
  cells::CellBlock here, there;
  const auto of_here = test::fault_of([&] {
    const auto opened = open_vtk_xml(file);
    known = opened.has_value();
    std::vector<std::string> notes;
    if (opened) here = std::move(blocks_of(*opened, notes).at(0));
  });
  const auto of_vtk = test::fault_of([&] { there = block_by_vtk(file); });
  line = of_here.message + of_vtk.message;
  if (of_here.code) return of_vtk.code ? Outcome::refused_by_both : Outcome::refused_here;
  if (!known) return Outcome::left_to_vtk;
  if (of_vtk.code) return Outcome::refused_by_vtk;
  test::expect_same_blocks(here, there);
  return Outcome::same;
}

class VtuComparison : public ::testing::Test {
 protected:
  void SetUp() override { TESSERA_VTK_OR_SKIP(); }
  void expect_same(const std::string& text) const {
    std::string line;
    EXPECT_EQ(compare(folder.write("m.vtu", text), line), Outcome::same) << line;
  }

  test::TemporaryFolder folder;
};

TEST_F(VtuComparison, EveryStorageIsReadAsVtkReadsIt) {
  for (const test::VtuStorage& storage : test::all_storages())
    expect_same(vtu_file_text(storage, {test::sample_piece()}));
  for (const char* type : {"Int8", "UInt8", "Int16", "UInt16", "Int32", "UInt32", "Int64", "UInt64"})
    expect_same(vtu_file_text({}, {test::sample_piece("Float32", type, type)}));
}

TEST_F(VtuComparison, SeveralPiecesAreReadAsVtkReadsThem) {
  VtuPiece empty = test::sample_piece();
  empty.points = empty.cells = 0;
  for (auto* list : {&empty.point_data, &empty.cell_data, &empty.coordinates, &empty.topology})
    for (test::VtuArray& array : *list) array.numbers.clear();
  for (const test::VtuStorage& storage : test::all_storages())
    expect_same(vtu_file_text(storage, {test::sample_piece(), empty, test::sample_piece()}));
  expect_same(vtu_file_text({}, {empty, test::sample_piece(), test::sample_piece()}));
}

TEST_F(VtuComparison, OurMeshesAreReadAsVtkReadsThem) {
  expect_same(testing::vtu_text(testing::mixed_mesh(4, 3, false)));
  expect_same(testing::vtu_text(testing::voronoi_mesh(3, 5)));
}

// Without -inf, which VTK 9.1 reads as inf, and without -nan and infinity, which it does not read.
TEST_F(VtuComparison, NumbersAreSpelledAsVtkReadsThem) {
  test::SomeCases some(5);
  for (const char* numbers :
       {"nan inf 1 NaN", "INF Inf +1 NAN", "1e-400 -0 .5 5.", "1e400 0 0 0", "+nan 0 0 0", "1.5e 0 0 0", "0x10 0 0 0",
        "1d3 0 0 0", "- 1 2 3", "1,2 3 4 5", "1-2 +-3 4", "++1 0 0 0"})
    for (const char* type : {"Float32", "Float64", "Int8", "UInt8", "UInt16", "Int32", "UInt64"}) {
      if (!some.next()) continue;
      SCOPED_TRACE(fmt::format("{} as {}", numbers, type));
      VtuPiece piece = test::sample_piece();
      piece.point_data = {{type, "n", 1, {}}};
      std::string text = vtu_file_text({}, {piece});
      const std::string last = "format=\"ascii\">\n";
      text.insert(text.find(last, text.find("Name=\"n\"")) + last.size(), std::string(numbers) + " 1 2 3 4 5 6 7 8");
      std::string line;
      const Outcome outcome = compare(folder.write("m.vtu", text), line);
      EXPECT_TRUE(outcome == Outcome::same || outcome == Outcome::refused_by_both)
          << static_cast<int>(outcome) << ": " << line;
    }
}

// A byte has eight bits, the first one highest. Each piece begins with a new byte.
TEST_F(VtuComparison, BitsAreReadPieceByPiece) {
  for (const bool is_text : {false, true}) {
    std::string text = vtu_file_text({}, {test::sample_piece(), test::sample_piece()});
    std::size_t at = 0;
    for (const char* bits :
         {is_text ? "0 1 0 1 1 1 0 0 1 0 1 0" : "AgAAAFyg", is_text ? "1 0 1 0 0 0 1 1 0 1 0 1" : "AgAAAKNQ"}) {
      at = text.find("<PointData", at);
      at = text.find('>', at) + 1;
      text.insert(at, fmt::format("<DataArray type=\"Bit\" Name=\"b\" format=\"{}\">{}</DataArray>\n",
                                  is_text ? "ascii" : "binary", bits));
    }
    expect_same(text);
    const cells::CellBlock block = test::vtu_block(folder / "m.vtu");
    const auto field = std::ranges::find(block.fields, "b", &cells::BlockField::name);
    ASSERT_NE(field, block.fields.end());
    std::vector<double> values(field->tuples);
    field->read(0, 0, values);
    EXPECT_EQ(values, (std::vector<double>{0, 1, 0, 1, 1, 1, 0, 0, 1, 0, 1, 0, 1, 0, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1}));
  }
}

TEST_F(VtuComparison, FilesOfOtherProgramsAreReadAsVtkReadsThem) {
  const char* const named = std::getenv("TESSERA_VTU_FILES");
  std::vector<std::filesystem::path> folders = {std::filesystem::path(TESSERA_SOURCE_DIR) / ".." / "shared" / "data"};
  if (named != nullptr) folders.emplace_back(named);
  std::erase_if(folders, [](const auto& path) { return !std::filesystem::exists(path); });
  if (folders.empty()) GTEST_SKIP() << "no folder of such files; name one by TESSERA_VTU_FILES";
  std::map<Outcome, std::size_t> counts;
  for (const std::filesystem::path& of : folders)
    for (const auto& entry : std::filesystem::recursive_directory_iterator(of)) {
      if (!entry.is_regular_file() || system::lower_extension(entry.path()) != ".vtu") continue;
      SCOPED_TRACE(entry.path());
      std::string line;
      const Outcome outcome = compare(entry.path(), line);
      ++counts[outcome];
      if (outcome != Outcome::same)
        std::cout << static_cast<int>(outcome) << " " << entry.path() << ": " << line << '\n';
      EXPECT_NE(outcome, Outcome::refused_here) << line;
    }
  EXPECT_GT(counts[Outcome::same], 0u);
  std::cout << fmt::format("{} files the same, {} refused by both, {} left to VTK, {} read here alone\n",
                           counts[Outcome::same], counts[Outcome::refused_by_both], counts[Outcome::left_to_vtk],
                           counts[Outcome::refused_by_vtk]);
}

}  // namespace
}  // namespace tessera::io
