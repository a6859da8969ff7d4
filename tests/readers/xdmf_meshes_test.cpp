// SPDX-License-Identifier: BSD-3-Clause
// XDMF whose grids share one mesh: by xi:include, by Reference, or by the same numbers in a separate file.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "io/files/reader_programs.hpp"
#include "support/mesh_checks.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"
#include "support/volume_bytes.hpp"

namespace tessera::io::xdmf_meshes_test {
namespace {

std::string item(const std::string& dimensions, const std::string& numbers, const std::string& format = "XML") {
  return fmt::format("<DataItem DataType=\"Float\" Dimensions=\"{}\" Format=\"{}\" Precision=\"8\">{}</DataItem>",
                     dimensions, format, numbers);
}

std::string attribute(const std::string& name, const std::string& center, const std::string& data) {
  return fmt::format("<Attribute Name=\"{}\" AttributeType=\"Scalar\" Center=\"{}\">{}</Attribute>", name, center,
                     data);
}

const std::string topology =
    "<Topology TopologyType=\"Tetrahedron\" NumberOfElements=\"2\"><DataItem DataType=\"Int\" Dimensions=\"2 4\" "
    "Format=\"XML\" Precision=\"8\">0 1 2 3 1 2 3 4</DataItem></Topology>";
const std::string geometry =
    "<Geometry GeometryType=\"XYZ\">" + item("5 3", "0 0 0 1 0 0 0 1 0 0 0 1 1 1 1") + "</Geometry>";
constexpr double volume = 0.5;  // of both tets
const std::string mesh_grid = "<Grid Name=\"mesh\" GridType=\"Uniform\">" + topology + geometry + "</Grid>";
const std::string included =
    "<ns0:include xpointer=\"xpointer(//Grid[@Name=&quot;mesh&quot;]/*[self::Topology or self::Geometry])\"/>";

std::string timed(double time) { return fmt::format("<Time Value=\"{}\"/>", time); }

std::string values(double first) {
  return fmt::format("{} {} {} {} {}", first, first + 1, first + 2, first + 3, first + 4);
}

/// A step of a function with values from `first` on.
std::string step(const std::string& mesh, const std::string& name, double time, double first) {
  return "<Grid>" + mesh + timed(time) + attribute(name, "Node", item("5", values(first))) + "</Grid>";
}

std::string series(const std::string& name, const std::string& steps) {
  return fmt::format("<Grid Name=\"{}\" GridType=\"Collection\" CollectionType=\"Temporal\">{}</Grid>", name, steps);
}

class XdmfMeshes : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_reader(Reader::xdmf)) GTEST_SKIP() << "tessera-read-xdmf is not installed";
  }
  cells::MeshFile read(const std::string& domain, std::optional<std::size_t> time_step = std::nullopt,
                       const std::string& field = "", const std::vector<std::string>& blocks = {}) const {
    ReadOptions options;
    options.time_step = time_step;
    options.field = field;
    options.blocks = blocks;
    return read_mesh(folder.write("a.xdmf",
                                  "<Xdmf xmlns:ns0=\"http://www.w3.org/2003/XInclude\" Version=\"3.0\">"
                                  "<Domain>" +
                                      domain + "</Domain></Xdmf>"),
                     options);
  }
  /// Expects one mesh with a field whose smallest value this is.
  static void expect_once(const cells::MeshFile& file, double smallest) {
    EXPECT_NEAR(testing::volume(file.mesh), volume, 1e-12);
    EXPECT_EQ(file.counts.cells_read, 2u);
    EXPECT_TRUE(file.blocks.empty());
    EXPECT_EQ(*std::ranges::min_element(file.mesh.scalars), smallest);
  }
  test::TemporaryFolder folder;
};

TEST_F(XdmfMeshes, ASeriesIncludesAMeshWhoseNumbersAreInTheText) {
  // As written by meshio: the mesh comes last, and its series' grids have no names.
  const std::string domain = series("TimeSeries_meshio", step(included, "phi", 0, 0) + step(included, "phi", 0.5, 10) +
                                                             step(included, "phi", 1, 20)) +
                             mesh_grid;
  expect_once(read(domain), 20);
  expect_once(read(domain, 1), 10);
  EXPECT_EQ(read(domain).time_step.count, 3u);
}

TEST_F(XdmfMeshes, AMeshAndASeriesForEachFunctionAreOneMesh) {
  // As written by FEniCS.
  const std::string domain = mesh_grid + series("u", step(included, "u", 0, 0) + step(included, "u", 1, 10)) +
                             series("v", step(included, "v", 0, 100) + step(included, "v", 1, 200));
  expect_once(read(domain, std::nullopt, "u"), 10);
  expect_once(read(domain, std::nullopt, "v"), 200);
  expect_once(read(domain, 0, "v"), 100);
}

TEST_F(XdmfMeshes, SeriesOfDifferentLengthsGoByTheirTimes) {
  const std::string domain =
      series("u", step(included, "u", 0, 0) + step(included, "u", 2, 10)) +
      series("v", step(included, "v", 0, 100) + step(included, "v", 1, 200) + step(included, "v", 2, 300)) + mesh_grid;
  EXPECT_EQ(read(domain).time_step.count, 3u);
  expect_once(read(domain, 1, "v"), 200);
  expect_once(read(domain, 1, "u"), 0);  // the last one before
  expect_once(read(domain, 2, "u"), 10);
  test::expect_bad_input([&] { read(domain, 3); }, {"no time step 3", "the file has 3"});
}

TEST_F(XdmfMeshes, ReferencesAreReplacedByTheirTargets) {
  const std::string mesh =
      "<Topology Reference=\"/Xdmf/Domain/Grid[@Name='mesh']/Topology\"/>"
      "<Geometry Reference=\"XML\">/Xdmf/Domain/Grid[1]/Geometry</Geometry>";
  expect_once(read(mesh_grid + series("u", step(mesh, "u", 0, 0) + step(mesh, "u", 1, 10))), 10);
  // References to items, and to an item that is itself a reference.
  const std::string items =
      "<DataItem Name=\"places\" Dimensions=\"5 3\" Format=\"XML\">0 0 0 1 0 0 0 1 0 0 0 1 1 1 1</DataItem>"
      "<DataItem Name=\"same\" Reference=\"/Xdmf/Domain/DataItem[@Name='places']\"/>"
      "<Grid Name=\"m\">" +
      topology + "<Geometry GeometryType=\"XYZ\"><DataItem Reference=\"/Xdmf/Domain/DataItem[2]\"/></Geometry>" +
      attribute("f", "Node", item("5", values(3))) + "</Grid>";
  expect_once(read(items), 3);
  const auto refused = [&](const std::string& path, const std::vector<std::string>& words) {
    const std::string text = "<Topology Reference=\"" + path + "\"/>" + geometry;
    test::expect_bad_input([&] { read(mesh_grid + series("u", step(text, "u", 0, 0))); }, words);
  };
  refused("/Xdmf/Domain/Grid[7]/Topology", {"a.xdmf: ", "<Topology>", "by Reference", "Grid[7]", "does not exist"});
  refused("/Xdmf/Domain/Grid[1]/Geometry", {"by Reference", "does not exist"});
  refused("/Xdmf/Domain/Grid/Grid/Topology", {"refers by Reference to itself"});
}

TEST_F(XdmfMeshes, TheSameNumbersInANeighbouringFileAreOneMesh) {
  const std::vector<double> places = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1};
  const std::vector<std::int32_t> cells = {0, 1, 2, 3, 1, 2, 3, 4};
  folder.write("places.bin", test::bytes_of(places));
  folder.write("cells.bin", test::bytes_of(cells));
  const std::string mesh =
      "<Topology TopologyType=\"Tetrahedron\" NumberOfElements=\"2\"><DataItem NumberType=\"Int\" Precision=\"4\" "
      "Dimensions=\"2 4\" Format=\"Binary\">cells.bin</DataItem></Topology><Geometry GeometryType=\"XYZ\">" +
      item("5 3", "places.bin", "Binary") + "</Geometry>";
  const std::string domain = "<Grid Name=\"mesh\">" + mesh + "</Grid>" + series("u", step(mesh, "u", 0, 7));
  expect_once(read(domain), 7);
  // Relative names are also resolved if the text must be rewritten.
  std::string rewritten = domain;
  rewritten.replace(rewritten.find(" Center=\"Node\""), 14, "");
  expect_once(read(rewritten), 7);
}

TEST_F(XdmfMeshes, SeveralBlocksShareTheirPoints) {
  const auto part = [](const std::string& name, const std::string& points, const std::string& corners) {
    return "<Grid Name=\"" + name +
           "\"><Topology TopologyType=\"Tetrahedron\" NumberOfElements=\"1\"><DataItem NumberType=\"Int\" "
           "Dimensions=\"1 4\" Format=\"XML\">" +
           corners + "</DataItem></Topology>" + points + attribute("f", "Node", item("5", values(0))) + "</Grid>";
  };
  const std::string shared = "<ns0:include xpointer=\"xpointer(//Grid[@Name='one']/Geometry)\"/>";
  const std::string domain = "<Grid Name=\"all\" GridType=\"Collection\" CollectionType=\"Spatial\">" +
                             part("one", geometry, "0 1 2 3") + part("other", shared, "1 2 3 4") + "</Grid>";
  const cells::MeshFile both = read(domain);
  EXPECT_NEAR(testing::volume(both.mesh), volume, 1e-12);
  EXPECT_EQ(both.blocks, (std::vector<std::string>{"one", "other"}));
  EXPECT_NEAR(testing::volume(read(domain, std::nullopt, "", {"other"}).mesh), volume * 2 / 3, 1e-12);
}

TEST_F(XdmfMeshes, ReportsMoreTextThanTheLibraryAccepts) {
  std::string places = "0 0 0 1 0 0 0 1 0 0 0 1 1 1 1";
  places.append(10'000'000, ' ');
  test::expect_bad_input(
      [&] {
        read("<Grid Name=\"m\">" + topology + "<Geometry GeometryType=\"XYZ\">" + item("5 3", places) +
             "</Geometry></Grid>");
      },
      {"a.xdmf: ", "10000029 bytes of numbers in the text", "write its numbers to HDF5"});
}

TEST_F(XdmfMeshes, FiniteElementFunctionsAreNamedAsNotRead) {
  for (const char* kind : {"ItemType=\"FiniteElementFunction\" AttributeType=\"Scalar\" Center=\"Other\"",
                           "AttributeType=\"FiniteElementFunction\" Center=\"Node\""}) {
    const std::string function = fmt::format(
        "<Attribute Name=\"p\" ElementFamily=\"CG\" ElementDegree=\"2\" {}>{}{}"
        "</Attribute>",
        kind, item("2", "0 1"), item("3", "4 5 6"));
    const cells::MeshFile file = read("<Grid Name=\"m\">" + topology + geometry + function +
                                      attribute("f", "Node", item("5", values(3))) + "</Grid>");
    expect_once(file, 3);
    const auto notes = std::ranges::count_if(file.notes, [](const std::string& note) {
      return note.find("'p' is a finite-element function (CG of degree 2)") != std::string::npos;
    });
    EXPECT_EQ(notes, 1) << kind;
  }
}

TEST_F(XdmfMeshes, OmittedPartsHaveTheFormatsDefaults) {
  // Numbers in the text, at the nodes; times as a list, and as first, step and count.
  const auto bare = [](double first) {
    return "<Grid>" + included + "<Attribute Name=\"u\"><DataItem Dimensions=\"5\">" + values(first) +
           "</DataItem></Attribute></Grid>";
  };
  for (const char* times : {"<Time TimeType=\"List\"><DataItem Dimensions=\"3\">4 2 3</DataItem></Time>",
                            "<Time TimeType=\"HyperSlab\"><DataItem Dimensions=\"3\">4 -1 3</DataItem></Time>"}) {
    const bool is_list = std::string(times).find("List") != std::string::npos;
    const std::string domain = mesh_grid + series("u", times + bare(0) + bare(10) + bare(20));
    expect_once(read(domain, 0), is_list ? 10 : 20);
    expect_once(read(domain, 2), 0);
  }
}

}  // namespace
}  // namespace tessera::io::xdmf_meshes_test
