// SPDX-License-Identifier: BSD-3-Clause
// Fill values do not determine what files show.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "api/communicator.hpp"
#include "exchange/loopback_transport.hpp"
#include "support/temporary_folder.hpp"
#include "support/volume_bytes.hpp"
#include "tessera/dataset.hpp"

namespace tessera::fill_values_test {
namespace {

/// 64 samples with the values 0 to 63, except that the first 4 have the fill value.
std::filesystem::path volume_with(const test::TemporaryFolder& folder, float fill) {
  std::vector<float> samples = test::counting<float>(64);
  std::fill_n(samples.begin(), 4, fill);
  return folder.write("a_4x4x4_float32.raw", test::bytes_of(samples));
}

const char* const mesh_with_fill =
    "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\"><UnstructuredGrid><Piece "
    "NumberOfPoints=\"5\" NumberOfCells=\"3\"><Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" "
    "format=\"ascii\">0 0 0 1 0 0 0 1 0 0 0 1 1 1 1</DataArray></Points><Cells><DataArray type=\"Int32\" "
    "Name=\"connectivity\" format=\"ascii\">0 1 2 3 1 2 3 4 0 1 2 4</DataArray><DataArray type=\"Int32\" "
    "Name=\"offsets\" format=\"ascii\">4 8 12</DataArray><DataArray type=\"UInt8\" Name=\"types\" "
    "format=\"ascii\">10 10 10</DataArray></Cells><CellData><DataArray type=\"Float64\" Name=\"p\" "
    "format=\"ascii\">2 4 -9999</DataArray></CellData><PointData><DataArray type=\"Float64\" Name=\"q\" "
    "format=\"ascii\">2 4 3 5 -9999</DataArray></PointData></Piece></UnstructuredGrid></VTKFile>";

std::string note_with(const Dataset& data, const std::string& words) {
  for (const std::string& note : data.notes())
    if (note.find(words) != std::string::npos) return note;
  return "";
}

TEST(FillValues, HugeFillValuesOfVolumesAreBlank) {
  const test::TemporaryFolder folder;
  for (const float fill : {-3.4028235e38F, 1e20F, 9.96921e36F}) {
    const Dataset data = Dataset::open(volume_with(folder, fill));
    EXPECT_EQ(data.range(), (std::array<double, 2>{4, 63}));
    EXPECT_EQ(data.blank_samples(), 4u);
    EXPECT_EQ(data.fields().front().low, 4);
    EXPECT_NE(note_with(data, "4 samples have the value"), "");
  }
}

TEST(FillValues, UsualFillValuesAreNotedWithAThreshold) {
  const test::TemporaryFolder folder;
  const auto file = volume_with(folder, -9999);
  const Dataset data = Dataset::open(file);
  EXPECT_EQ(data.range(), (std::array<double, 2>{-9999, 63}));
  EXPECT_NE(note_with(data, "4 samples have the value -9999, ").find("`threshold` 3.41,63.59 leaves"),
            std::string::npos);
  ReadOptions options;
  options.selection.threshold = {{3.41, 63.59}};
  const Dataset without = Dataset::open(file, options);
  EXPECT_EQ(without.range(), (std::array<double, 2>{4, 63}));
  EXPECT_EQ(note_with(without, "fill value"), "");
  // Other values that are left out do not change any colour.
  options.selection.threshold = {{20, 30}};
  EXPECT_EQ(Dataset::open(file, options).range(), (std::array<double, 2>{4, 63}));
  EXPECT_EQ(note_with(Dataset::open(volume_with(folder, -70)), "fill value"), "");
}

TEST(RawVolumes, InTheOtherOrderOfBytesGetANote) {
  const test::TemporaryFolder folder;
  ReadOptions big;
  big.big_endian = true;
  std::string floats = test::bytes_of(test::counting<float>(64)),
              shorts = test::bytes_of(test::counting<std::int16_t>(64));
  const auto small = folder.write("a_4x4x4_float32.raw", floats);
  EXPECT_EQ(note_with(Dataset::open(small), "byte order"), "");
  EXPECT_NE(note_with(Dataset::open(small, big), "byte order: try `endian` little"), "");
  for (std::size_t k = 0; k < floats.size(); k += 4) std::reverse(floats.begin() + k, floats.begin() + k + 4);
  const auto swapped = folder.write("b_4x4x4_float32.raw", floats);
  EXPECT_NE(note_with(Dataset::open(swapped), "byte order: try `endian` big"), "");
  EXPECT_EQ(note_with(Dataset::open(swapped, big), "byte order"), "");
  EXPECT_EQ(note_with(Dataset::open(folder.write("c_4x4x4_int16.raw", shorts), big), "byte order"), "");
}

TEST(FillValues, OfMeshesAreNotedToo) {
  const test::TemporaryFolder folder;
  ReadOptions options;
  options.field = "p";
  const Dataset data = Dataset::open(folder.write("m.vtu", mesh_with_fill), options);
  EXPECT_NE(note_with(data, "1 tets have the value -9999, ").find("`threshold` 1.98,4.02 leaves"), std::string::npos);
  for (const std::array<double, 2>& threshold : {std::array{1.98, 4.02}, std::array{3.5, 4.5}}) {
    options.selection.threshold = threshold;
    EXPECT_EQ(Dataset::open(folder / "m.vtu", options).range(), (std::array{2.0, 4.0}));
  }
}

TEST(FillValues, OfMeshesInPartsAreNotedOnceForTheWhole) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("m.vtu", mesh_with_fill);
  for (const bool of_points : {false, true}) {
    ReadOptions options;
    options.field = of_points ? "q" : "p";
    const std::string whole = note_with(Dataset::open(file, options), "fill value");
    EXPECT_EQ(whole.find(of_points ? "1 points have" : "1 tets have"), 0u) << whole;
    exchange::run_ranks(3, [&](exchange::Transport& transport) {
      const Dataset data =
          Dataset::open(std::span(&file, 1), options, api::communicator_over(transport), RankSettings{});
      EXPECT_EQ(std::ranges::count_if(
                    data.notes(), [](const std::string& note) { return note.find("fill value") != std::string::npos; }),
                1);
      // Points on the boundary between parts are in both parts, so the number of points is not stated.
      EXPECT_EQ(note_with(data, "fill value"), of_points ? "some" + whole.substr(1) : whole);
    });
  }
}

}  // namespace
}  // namespace tessera::fill_values_test
