// SPDX-License-Identifier: BSD-3-Clause
// XDMF's items: selections (HyperSlab) of arrays, number types in binary files, points with one array per axis, sizes
// by NumberOfElements, points numbered from 1. The numbers are in the text, in HDF5 and in binary files.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <string>
#include <vector>

#include "io/files/reader_programs.hpp"
#include "support/changed_bytes.hpp"
#include "support/mesh_checks.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"
#include "support/volume_bytes.hpp"
#include "support/volume_checks.hpp"

namespace tessera::io::xdmf_items_test {
namespace {

using test::all_samples;

const std::string regular =
    "<Topology TopologyType=\"3DCoRectMesh\" Dimensions=\"2 3 4\"/><Geometry GeometryType=\"ORIGIN_DXDYDZ\">"
    "<DataItem Dimensions=\"3\">0 0 0</DataItem><DataItem Dimensions=\"3\">1 1 1</DataItem></Geometry>";

std::string file_of(const std::string& grid, const std::string& values) {
  return "<Xdmf Version=\"2.0\"><Domain><Grid Name=\"g\">" + grid + "<Attribute Name=\"T\" Center=\"Node\">" + values +
         "</Attribute></Grid></Domain></Xdmf>";
}

std::string selection(const std::string& rows, const std::string& of, const std::string& word = "HyperSlab") {
  const auto blanks = static_cast<int>(std::count(rows.begin(), rows.end(), ' '));
  return fmt::format(
      "<DataItem ItemType=\"{}\" Dimensions=\"2 3 4\"><DataItem Dimensions=\"3 {}\" Format=\"XML\">{}</DataItem>{}"
      "</DataItem>",
      word, (blanks + 1) / 3, rows, of);
}

class XdmfItems : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_reader(Reader::xdmf)) GTEST_SKIP() << "tessera-read-xdmf is not installed";
  }

  std::vector<double> values(const std::string& item) const {
    ReadOptions options;
    options.field = "T";
    return all_samples(*open_volume(folder.write("a.xmf", file_of(regular, item)), options).source);
  }
  void expect_refused(const std::string& item, const std::vector<std::string>& words) const {
    std::vector<std::string> all = {"a.xmf: ", "; "};
    all.insert(all.end(), words.begin(), words.end());
    test::expect_bad_input([&] { values(item); }, all);
  }

  /// An array of these lengths, in which each value is its own index, in the text, in HDF5 and in a binary file.
  std::array<std::string, 3> arrays(const std::vector<hsize_t>& lengths) const {
    std::vector<float> numbers(std::accumulate(lengths.begin(), lengths.end(), std::size_t{1}, std::multiplies<>()));
    std::iota(numbers.begin(), numbers.end(), 0.0F);
    const hid_t file = H5Fcreate((folder / "a.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    const hid_t space = H5Screate_simple(static_cast<int>(lengths.size()), lengths.data(), nullptr);
    const hid_t set = H5Dcreate2(file, "a", H5T_IEEE_F32LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    EXPECT_GE(H5Dwrite(set, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()), 0);
    H5Dclose(set), H5Sclose(space), H5Fclose(file);
    folder.write("a.bin", test::bytes_of(numbers));
    const auto item = [&](const char* format, const std::string& text) {
      return fmt::format("<DataItem Format=\"{}\" Precision=\"4\" NumberType=\"Float\" Dimensions=\"{}\">{}</DataItem>",
                         format, fmt::join(lengths, " "), text);
    };
    return {item("XML", fmt::format("{}", fmt::join(numbers, " "))), item("HDF", "a.h5:/a"), item("Binary", "a.bin")};
  }
  test::TemporaryFolder folder;
};

TEST_F(XdmfItems, SelectionsTakeTheSlowestDimensionFirst) {
  std::vector<double> second(24), strided, inner;
  std::iota(second.begin(), second.end(), 24.0);
  for (int z = 0; z < 2; ++z)
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 4; ++x) {
        strided.push_back(2 * (z * 48 + y * 8 + x));
        inner.push_back((z + 1) * 30 + (y + 1) * 6 + x + 1);
      }
  for (const std::string& item : arrays({2, 2, 3, 4}))
    EXPECT_EQ(values(selection("1 0 0 0 1 1 1 1 1 2 3 4", item)), second) << item;
  for (const std::string& item : arrays({4, 6, 8})) {
    EXPECT_EQ(values(selection("0 0 0 2 2 2 2 3 4", item)), strided) << item;
    EXPECT_EQ(values(selection("0 0 0 2 2 2 2 3 4", item, "Hyperslab")), strided) << item;
  }
  for (const std::string& item : arrays({3, 5, 6})) EXPECT_EQ(values(selection("1 1 1 1 1 1 2 3 4", item)), inner);
  for (const std::string& item : arrays({48})) EXPECT_EQ(values(selection("24 1 24", item)), second);
  // A selection from an array that is itself a selection.
  for (const std::string& item : arrays({3, 2, 3, 4}))
    EXPECT_EQ(values(selection("0 0 0 0 1 1 1 1 1 2 3 4", selection("1 0 0 0 1 1 1 1 2 2 3 4", item))), second);
}

TEST_F(XdmfItems, SelectionsOutsideOfTheirArraysAreRefused) {
  const std::string item = arrays({3, 5, 6})[1];
  for (const char* rows : {"2 0 0 1 1 1 2 3 4", "0 0 0 1 1 2 2 3 4", "0 0 0 0 1 1 2 3 4", "0 0 1 1 2 24",
                           "0 0 0 1 1 1 0 3 4", "0 0 -1 1 1 1 2 3 4"})
    expect_refused(selection(rows, item), {"a HyperSlab of start", "does not fit an array of the dimensions 3 5 6"});
  const std::string good = file_of(regular, selection("1 1 1 1 1 1 2 3 4", item));
  test::expect_no_crash_of_changes(folder, "changed.xmf", good, [](const auto& file) { open_volume(file); });
  expect_refused(selection("0 0 0", item, "Coordinates"), {"of the type 'Coordinates' selects single numbers"});
}

std::string binary(const char* type, int precision) {
  return fmt::format(
      "<DataItem Format=\"Binary\" Endian=\"Little\" {} Precision=\"{}\" Dimensions=\"2 3 4\">b.bin</DataItem>",
      *type == 0 ? std::string() : fmt::format("NumberType=\"{}\"", type), precision);
}

template <class T>
std::vector<T> falling(T first) {
  std::vector<T> numbers(24);
  for (std::size_t k = 0; k < numbers.size(); ++k) numbers[k] = static_cast<T>(first - static_cast<T>(k));
  return numbers;
}

TEST_F(XdmfItems, BinaryNumbersHaveTheirBytes) {
  const auto check = [&](auto first, const char* type, int precision) {
    using T = decltype(first);
    const std::vector<T> numbers = falling<T>(first);
    folder.write("b.bin", test::bytes_of(numbers));
    SCOPED_TRACE(fmt::format("{} {}", type, precision));
    EXPECT_EQ(values(binary(type, precision)), std::vector<double>(numbers.begin(), numbers.end()));
  };
  check(std::int8_t{10}, "Int", 1), check(std::int16_t{-3000}, "Int", 2), check(std::int32_t{-300000}, "Int", 4);
  check(std::int64_t{-30000000000}, "Int", 8), check(std::uint8_t{250}, "UInt", 1), check(std::uint8_t{250}, "uint", 1);
  check(std::uint16_t{60000}, "UInt", 2), check(std::uint32_t{4000000000}, "UInt", 4);
  check(std::uint64_t{30000000000}, "UInt", 8), check(0.5F, "Float", 4), check(0.1, "Float", 8);
  check(0.5F, "", 4), check(0.1, "", 8);
  check(std::int8_t{10}, "Char", 1), check(std::uint8_t{250}, "UChar", 1);
  expect_refused(binary("Float", 2), {"binary numbers of the unsupported Precision '2'"});
  expect_refused(binary("Int", 3), {"binary numbers of the unsupported Precision '3'"});
}

TEST_F(XdmfItems, PointsMayBeAnArrayForEachAxisAndCountFromOne) {
  const auto axis = [](const char* numbers) {
    return fmt::format("<DataItem Dimensions=\"8\" Precision=\"8\" Format=\"XML\">{}</DataItem>", numbers);
  };
  const std::string cell =
      "<Topology TopologyType=\"Hexahedron\" NumberOfElements=\"1\" BaseOffset=\"1\"><DataItem Dimensions=\"1 8\" "
      "NumberType=\"Int\">1 2 3 4 5 6 7 8</DataItem></Topology>";
  const std::string points = "<Geometry GeometryType=\"X_Y_Z\">" + axis("0 2 2 0 0 2 2 0") + axis("0 0 3 3 0 0 3 3") +
                             axis("0 0 0 0 5 5 5 5") + "</Geometry>";
  const auto mesh = [&](const std::string& grid) {
    return read_mesh(folder.write("m.xmf", file_of(grid, axis("0 2 5 3 5 7 10 8")))).mesh;
  };
  const auto check = [](const auto& read) {
    EXPECT_NEAR(testing::volume(read), 30, 1e-12);
    for (std::size_t v = 0; v < 8; ++v) {
      const glm::dvec3& p = read.positions[v];
      EXPECT_EQ(read.scalars[v], p.x + p.y + p.z);
    }
  };
  check(mesh(cell + points));
  test::expect_bad_input(
      [&] { mesh(cell + "<Geometry GeometryType=\"X_Y_Z\">" + axis("0 2 2 0 0 2 2 0") + "</Geometry>"); },
      {"m.xmf: its points are given as X_Y_Z, but not by three arrays"});
  // A grid whose points are x fastest, with its size in the other attribute.
  const std::string rows = "<Geometry GeometryType=\"X_Y_Z\">" + axis("0 2 0 2 0 2 0 2") + axis("0 0 3 3 0 0 3 3") +
                           axis("0 0 0 0 5 5 5 5") + "</Geometry>";
  EXPECT_NEAR(testing::volume(mesh("<Topology TopologyType=\"3DSMesh\" NumberOfElements=\"2 2 2\"/>" + rows)), 30,
              1e-12);
}

TEST_F(XdmfItems, NumberOfElementsIsAGridsSize) {
  std::string grid = regular;
  grid.replace(grid.find("Dimensions"), 10, "NumberOfElements");
  const VolumeFile volume = open_volume(folder.write("g.xmf", file_of(grid, arrays({2, 3, 4})[0])));
  EXPECT_EQ(volume.source->geometry().points, (scene::GridIndex{4, 3, 2}));
  EXPECT_EQ(all_samples(*volume.source)[23], 23);
}

}  // namespace
}  // namespace tessera::io::xdmf_items_test
