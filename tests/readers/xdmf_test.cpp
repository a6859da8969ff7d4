// SPDX-License-Identifier: BSD-3-Clause
// XDMF with its numbers inline and in separate binary files; HDF5 is in xdmf_hdf5_test.cpp.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <string>
#include <vector>

#include "io/files/reader_programs.hpp"
#include "io/formats/identify.hpp"
#include "io/volume/volume_formats.hpp"
#include "support/mesh_checks.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"
#include "support/volume_bytes.hpp"
#include "support/volume_checks.hpp"

namespace tessera::io {
namespace {

using scene::GridIndex;
using test::all_samples;

std::string item(const std::string& dimensions, const std::string& numbers, const std::string& type = "Float") {
  return fmt::format("<DataItem Dimensions=\"{}\" NumberType=\"{}\" Precision=\"{}\" Format=\"XML\">{}</DataItem>\n",
                     dimensions, type, type == "Float" ? 8 : 4, numbers);
}

std::string attribute(const std::string& name, const std::string& center, const std::string& data,
                      const std::string& type = "Scalar") {
  return fmt::format("<Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"{}\">\n{}</Attribute>\n", name, type, center,
                     data);
}

std::string file_of(const std::string& domain) {
  return "<?xml version=\"1.0\" ?>\n<!DOCTYPE Xdmf SYSTEM \"Xdmf.dtd\" []>\n<Xdmf Version=\"3.0\" "
         "xmlns:xi=\"http://www.w3.org/2001/XInclude\">\n<Domain>\n" +
         domain + "</Domain>\n</Xdmf>\n";
}

std::string collection(const std::string& name, const std::string& type, const std::string& grids) {
  return fmt::format("<Grid Name=\"{}\" GridType=\"Collection\" CollectionType=\"{}\">\n{}</Grid>\n", name, type,
                     grids);
}

/// Two tets on both sides of a face, moved along x; point field f = scale (x + 2 y + 3 z), cell field c.
std::string two_tets(const std::string& name, double shift, double scale, const std::string& time = "") {
  const double points[5][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -3}};
  std::string places, values;
  for (const auto& p : points) {
    places += fmt::format("{} {} {}\n", p[0] + shift, p[1], p[2]);
    values += fmt::format("{} ", scale * (p[0] + shift + 2 * p[1] + 3 * p[2]));
  }
  return fmt::format("<Grid Name=\"{}\" GridType=\"Uniform\">\n{}", name, time) +
         "<Topology TopologyType=\"Tetrahedron\" NumberOfElements=\"2\">\n" + item("2 4", "0 1 2 3 0 2 1 4", "Int") +
         "</Topology>\n<Geometry GeometryType=\"XYZ\">\n" + item("5 3", places) + "</Geometry>\n" +
         attribute("f", "Node", item("5", values)) + attribute("c", "Cell", item("2", "7 8")) +
         attribute("v", "Node", item("5 3", "0 0 0 3 4 0 0 0 0 0 0 0 0 0 0"), "Vector") + "</Grid>\n";
}

std::string timed(double time) { return fmt::format("<Time Value=\"{}\"/>\n", time); }

class Xdmf : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_reader(Reader::xdmf)) GTEST_SKIP() << "tessera-read-xdmf is not installed";
  }
  cells::MeshFile read(const std::string& domain, const ReadOptions& options = {}) const {
    return read_mesh(folder.write("a.xmf", file_of(domain)), options);
  }
  void expect_refused(const std::string& domain, const std::vector<std::string>& words,
                      const ReadOptions& options = {}) const {
    std::vector<std::string> all = {"a.xmf: ", "; "};
    all.insert(all.end(), words.begin(), words.end());
    test::expect_bad_input([&] { read(domain, options); }, all);
  }
  test::TemporaryFolder folder;
};

TEST_F(Xdmf, TetsHaveTheirPositionsAndFields) {
  const cells::MeshFile mesh = read(two_tets("m", 0, 1));
  EXPECT_FALSE(is_volume(folder / "a.xmf"));
  EXPECT_EQ(mesh.format, "XDMF");
  EXPECT_NEAR(testing::volume(mesh.mesh), 4.0 / 6, 1e-12);
  ASSERT_EQ(mesh.mesh.scalars.size(), 5u);
  for (std::size_t v = 0; v < 5; ++v) {
    const glm::dvec3& p = mesh.mesh.positions[v];
    EXPECT_EQ(mesh.mesh.scalars[v], p.x + 2 * p.y + 3 * p.z);
  }
  ReadOptions options;
  options.field = "c";
  const cells::MeshFile cells = read(two_tets("m", 0, 1), options);
  EXPECT_EQ(cells.mesh.scalars, (std::vector<double>{7, 8}));
  options.field = "v";
  const cells::MeshFile vectors = read(two_tets("m", 0, 1), options);
  EXPECT_EQ(*std::max_element(vectors.mesh.scalars.begin(), vectors.mesh.scalars.end()), 5);
}

TEST_F(Xdmf, TimeStepsAreInTheOrderOfTheirTimes) {
  // The second grid shares the first one's topology and points, as solvers write it.
  const std::string later =
      "<Grid Name=\"later\" GridType=\"Uniform\">\n" + timed(2) +
      "<xi:include xpointer=\"xpointer(//Grid[@Name='early']/*[self::Topology or self::Geometry])\"/>\n" +
      attribute("f", "Node", item("5", "0 10 20 30 -90")) + "</Grid>\n";
  const std::string series = collection("s", "Temporal", two_tets("early", 0, 1, timed(1)) + later);
  const auto range = [&](std::optional<std::size_t> step) {
    ReadOptions options;
    options.time_step = step;
    options.field = "f";
    const cells::MeshFile mesh = read(series, options);
    return *std::max_element(mesh.mesh.scalars.begin(), mesh.mesh.scalars.end());
  };
  EXPECT_EQ(range(std::nullopt), 30);
  EXPECT_EQ(read(series).time_step.times, (std::vector<double>{1, 2}));
  EXPECT_EQ(range(0), 3);
  EXPECT_EQ(range(1), 30);
  ReadOptions options;
  options.time_step = 2;
  expect_refused(series, {"there is no time step 2, the file has 2"}, options);
}

TEST_F(Xdmf, AGridOfOneTimeHasIt) {
  EXPECT_EQ(read(two_tets("m", 0, 1, timed(2.5))).time_step.times, std::vector{2.5});
  EXPECT_EQ(read(collection("s", "Spatial", two_tets("m", 0, 1, timed(2.5)))).time_step.times, std::vector{2.5});
  EXPECT_TRUE(read(two_tets("m", 0, 1)).time_step.times.empty());
}

TEST_F(Xdmf, GridsInSpaceAreBlocks) {
  const std::string parts = collection("engine", "Spatial", two_tets("left", 0, 1) + two_tets("right", 5, 1));
  const cells::MeshFile both = read(parts);
  EXPECT_EQ(both.blocks, (std::vector<std::string>{"left", "right"}));
  EXPECT_NEAR(testing::volume(both.mesh), 8.0 / 6, 1e-12);
  ReadOptions options;
  options.blocks = {"right"};
  const cells::MeshFile one = read(parts, options);
  EXPECT_NEAR(testing::volume(one.mesh), 4.0 / 6, 1e-12);
  for (const glm::dvec3& p : one.mesh.positions) EXPECT_GE(p.x, 5);
}

TEST_F(Xdmf, MixedCellsAreIdentifiedByTheirNumbers) {
  // A unit cube, a wedge and a pyramid on its sides, and a triangle, which is not a volume cell.
  const std::string topology = "<Topology TopologyType=\"Mixed\" NumberOfElements=\"4\">\n" +
                               item("26", "9 0 1 2 3 4 5 6 7  8 1 8 5 2 9 6  7 4 5 6 7 10  4 0 1 2", "Int") +
                               "</Topology>\n";
  const std::string points = "<Geometry GeometryType=\"XYZ\">\n" +
                             item("11 3", "0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1  2 0 0 2 1 0  0.5 0.5 2.5") +
                             "</Geometry>\n";
  const cells::MeshFile mesh = read("<Grid Name=\"m\" GridType=\"Uniform\">\n" + topology + points +
                                    attribute("f", "Node", item("11", "0 1 2 3 4 5 6 7 8 9 10")) + "</Grid>\n");
  EXPECT_EQ(mesh.counts.cells_read, 4u);
  EXPECT_NEAR(testing::volume(mesh.mesh), 1 + 0.5 + 0.5, 1e-12);
}

TEST_F(Xdmf, RegularGridsAreVolumes) {
  const std::string grid =
      "<Grid Name=\"g\" GridType=\"Uniform\">\n<Topology TopologyType=\"3DCoRectMesh\" Dimensions=\"2 3 4\"/>\n"
      "<Geometry GeometryType=\"ORIGIN_DXDYDZ\">\n" +
      item("3", "30 20 10") + item("3", "3 2 1") + "</Geometry>\n" +
      attribute("s", "Node", item("2 3 4", "0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23", "Int")) +
      attribute("c", "Cell", item("1 2 3", "0 1 2 3 4 5")) + "</Grid>\n";
  const auto file = folder.write("g.xdmf", file_of(grid));
  ASSERT_TRUE(is_volume(file));
  ReadOptions options;
  options.field = "s";
  const VolumeFile volume = open_volume(file, options);
  EXPECT_EQ(volume.source->geometry().points, (GridIndex{4, 3, 2}));
  // Dimensions, origin and spacing are in the order z, y, x.
  EXPECT_EQ(scene::world_of_index(volume.source->geometry(), {0, 0, 0}), glm::dvec3(10, 20, 30));
  EXPECT_EQ(scene::world_of_index(volume.source->geometry(), {3, 2, 1}), glm::dvec3(13, 24, 33));
  EXPECT_EQ(all_samples(*volume.source)[5], 5);
  EXPECT_EQ(volume.source->grid().type, scene::SampleType::int32);
  options.field = "c";
  EXPECT_EQ(open_volume(file, options).range, (scene::ValueRange{0, 5, 0}));
}

TEST_F(Xdmf, RectilinearGridsAreVolumesAndCurvilinearOnesMeshes) {
  const std::string rectilinear =
      "<Grid Name=\"g\" GridType=\"Uniform\">\n<Topology TopologyType=\"3DRectMesh\" Dimensions=\"2 2 3\"/>\n"
      "<Geometry GeometryType=\"VXVYVZ\">\n" +
      item("3", "0 1 5") + item("2", "0 2") + item("2", "7 3") + "</Geometry>\n" +
      attribute("s", "Node", item("2 2 3", "0 1 2 3 4 5 6 7 8 9 10 11")) + "</Grid>\n";
  const auto file = folder.write("r.xmf", file_of(rectilinear));
  ASSERT_TRUE(is_volume(file));
  const VolumeFile volume = open_volume(file);
  EXPECT_EQ(scene::world_of_index(volume.source->geometry(), {2, 1, 0}), glm::dvec3(5, 2, 7));
  EXPECT_EQ(scene::world_of_index(volume.source->geometry(), {1, 0, 1}), glm::dvec3(1, 0, 3));
  EXPECT_EQ(all_samples(*volume.source)[11], 11);

  const std::string curvilinear =
      "<Grid Name=\"g\" GridType=\"Uniform\">\n<Topology TopologyType=\"3DSMesh\" Dimensions=\"2 2 3\"/>\n"
      "<Geometry GeometryType=\"XYZ\">\n" +
      item("12 3", "0 0 0 1 0 0 2 0 0  1 1 0 2 1 0 3 1 0  0 0 1 1 0 1 2 0 1  1 1 1 2 1 1 3 1 1") + "</Geometry>\n" +
      attribute("s", "Node", item("2 2 3", "0 1 2 3 4 5 6 7 8 9 10 11")) + "</Grid>\n";
  const cells::MeshFile mesh = read(curvilinear);
  EXPECT_EQ(mesh.counts.cells_read, 2u);
  EXPECT_NEAR(testing::volume(mesh.mesh), 2, 1e-12);
}

TEST_F(Xdmf, ReadsBinaryNumbersFromNeighbouringFiles) {
  const std::vector<double> points = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const std::vector<float> values = {1, 2, 3, 4};
  const auto grid = [&](const std::string& name) {
    const auto binary = [&](const char* dimensions, int precision, int seek) {
      return fmt::format(
          "<DataItem Dimensions=\"{}\" NumberType=\"Float\" Precision=\"{}\" Format=\"Binary\" Endian=\"Little\" "
          "Seek=\"{}\">{}</DataItem>\n",
          dimensions, precision, seek, name);
    };
    return "<Grid Name=\"m\" GridType=\"Uniform\">\n<Topology TopologyType=\"Tetrahedron\" NumberOfElements=\"1\">\n" +
           item("1 4", "0 1 2 3", "Int") + "</Topology>\n<Geometry GeometryType=\"XYZ\">\n" + binary("4 3", 8, 0) +
           "</Geometry>\n" + attribute("f", "Node", binary("4", 4, 96)) + "</Grid>\n";
  };
  std::filesystem::create_directory(folder / "data");
  folder.write("data/a.bin", test::bytes_of(points) + test::bytes_of(values));
  const cells::MeshFile mesh = read(grid("data/a.bin"));
  EXPECT_NEAR(testing::volume(mesh.mesh), 1.0 / 6, 1e-12);
  std::vector<double> scalars = mesh.mesh.scalars;
  std::ranges::sort(scalars);
  EXPECT_EQ(scalars, (std::vector<double>{1, 2, 3, 4}));
  // Files elsewhere are not opened, and files that are too short are refused.
  const test::TemporaryFolder other;
  other.write("a.bin", test::bytes_of(points) + test::bytes_of(values));
  expect_refused(grid((other / "a.bin").string()), {"neither in its directory nor below"});
  expect_refused(grid("absent.bin"), {"'absent.bin', which does not exist"});
  folder.write("data/a.bin", test::bytes_of(points));
  expect_refused(grid("data/a.bin"), {});
}

TEST_F(Xdmf, InAGzipFileHaveTheirNumbersInTheText) {
  const auto packed = [&](const std::string& text) {
    const auto file = folder / "a.xmf.gz";
    gzFile out = gzopen(file.c_str(), "wb");
    EXPECT_EQ(gzwrite(out, text.data(), static_cast<unsigned>(text.size())), static_cast<int>(text.size()));
    gzclose(out);
    return file;
  };
  EXPECT_NEAR(testing::volume(read_mesh(packed(file_of(two_tets("m", 0, 1)))).mesh), 4.0 / 6, 1e-12);
  const auto other = folder.write("a.bin", std::string(200, '\0'));
  std::string text = two_tets("m", 0, 1);
  const std::size_t at = text.find("<DataItem Dimensions=\"5 3\"");
  text.replace(at, text.find("</DataItem>", at) - at,
               fmt::format("<DataItem Dimensions=\"5 3\" NumberType=\"Float\" Precision=\"8\" Format=\"Binary\">{}",
                           other.string()));
  test::expect_bad_input([&] { read_mesh(packed(file_of(text))); }, {"a.xmf.gz: it refers to other files"});
}

TEST_F(Xdmf, RefusesDamagedAndUnusualFilesInOneLine) {
  expect_refused(two_tets("m", 0, 1).substr(0, 300), {});
  std::string text = two_tets("m", 0, 1);
  text.replace(text.find("0 2 1 4"), 7, "0 2 1 9");
  expect_refused(text, {"uses point 9"});
  text = two_tets("m", 0, 1);
  text.replace(text.find("Tetrahedron"), 11, "Hexahedron_64");
  expect_refused(text, {"Hexahedron_64"});
  text = two_tets("m", 0, 1);
  text.replace(text.find("<Topology "), 10, "<Topology Reference=\"/Xdmf\" ");
  expect_refused(text, {"by Reference"});
  text = two_tets("m", 0, 1);
  text.replace(text.find("Dimensions=\"5 3\""), 16, "Dimensions=\"500000 300000\"");
  expect_refused(text, {"'500000 300000' holds 15 numbers"});
  const auto entities = folder.write(
      "e.xmf",
      "<!DOCTYPE Xdmf [<!ENTITY a \"aaaaaaaaaa\"><!ENTITY b \"&a;&a;&a;&a;&a;&a;&a;&a;\">]>\n<Xdmf><Domain>&b;"
      "</Domain></Xdmf>");
  test::expect_bad_input([&] { read_mesh(entities); }, {"e.xmf: it defines its own XML entities"});
  expect_refused("<xi:include href=\"/etc/passwd\" parse=\"text\"/>\n" + two_tets("m", 0, 1), {"another file"});
}

}  // namespace
}  // namespace tessera::io
