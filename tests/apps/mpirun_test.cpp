// SPDX-License-Identifier: BSD-3-Clause
// The program on several ranks, started as by users.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "apps/program.hpp"
#include "apps/quadratic_mesh.hpp"
#include "io/files/reader_programs.hpp"
#include "io/mesh/mesh_formats.hpp"
#include "support/some_cases.hpp"

namespace tessera::apps {
namespace {

class Mpirun : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_mpirun()) GTEST_SKIP() << "there is no mpirun";
  }
};

/// The program's own lines on stderr; mpirun may add others.
std::vector<std::string> own_lines(const Outcome& outcome) {
  std::vector<std::string> lines;
  std::istringstream err(outcome.err);
  for (std::string line; std::getline(err, line);)
    if (line.starts_with("tessera: ")) lines.push_back(line);
  return lines;
}

TEST_F(Mpirun, RawSegmentsGiveTheBytesOfOneProcessForEveryPartitionAndShape) {
  const Folder folder;
  const std::string mesh = folder.cube();
  ASSERT_EQ(tessera({"render", mesh, "-o", folder / "one.pfm", "--size", "70x50", "--quiet"}).status, 0);
  const std::vector<std::vector<std::string>> shapes{{"--partition", "file"},
                                                     {"--partition", "random", "--seed", "7"},
                                                     {"--projectors", "1"},
                                                     {"--compositors", "1"},
                                                     {"--without", "sharing"}};
  for (const auto& shape : shapes) {
    std::vector<std::string> arguments{"render",  mesh,         "-o",       folder / "ranks.pfm", "--size", "70x50",
                                       "--quiet", "--exchange", "segments", "--threads",          "1"};
    arguments.insert(arguments.end(), shape.begin(), shape.end());
    const Outcome outcome = mpirun(3, arguments);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_TRUE(own_lines(outcome).empty()) << outcome.err;
    EXPECT_EQ(contents(folder / "ranks.pfm"), contents(folder / "one.pfm")) << shape[0] << " " << shape[1];
  }
}

TEST_F(Mpirun, DuplicateCellsAreCountedAndDroppedAsInOneProcess) {
  const Folder folder;
  const std::string cube = folder.cube(), once = folder / "piece.vtu";
  ASSERT_EQ(tessera({"convert", cube, once, "--quiet"}).status, 0);
  std::filesystem::copy_file(once, folder / "copy.vtu");
  const std::string list =
      folder.file("twice.pvtu",
                  "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid><Piece Source=\"piece.vtu\"/>"
                  "<Piece Source=\"copy.vtu\"/></PUnstructuredGrid></VTKFile>");
  const auto arguments = [&](const std::string& file, std::vector<std::string> others) {
    std::vector<std::string> all{"render", file,        "-o", folder / "a.pfm", "--size",
                                 "40x30",  "--threads", "1",  "--exchange",     "segments"};
    all.insert(all.end(), others.begin(), others.end());
    return all;
  };
  ASSERT_EQ(tessera(arguments(once, {"--quiet"})).status, 0);
  const std::string picture_of_one = contents(folder / "a.pfm");
  for (const int ranks : {1, 2, 3}) {
    SCOPED_TRACE(ranks);
    const auto run = [&](const std::vector<std::string>& words) {
      return ranks == 1 ? tessera(words) : mpirun(ranks, words);
    };
    const Outcome kept = run(arguments(list, {}));
    ASSERT_EQ(kept.status, 0) << kept.err;
    EXPECT_NE(kept.err.find(": 384 cells have the corners of other cells"), std::string::npos) << kept.err;
    EXPECT_NE(kept.err.find("--drop-duplicates draws each cell once"), std::string::npos) << kept.err;
    EXPECT_NE(contents(folder / "a.pfm"), picture_of_one);
    const Outcome dropped = run(arguments(list, {"--drop-duplicates"}));
    ASSERT_EQ(dropped.status, 0) << dropped.err;
    EXPECT_NE(dropped.err.find("384 of 768 cells kept as 384 tets, 384 duplicate dropped"), std::string::npos)
        << dropped.err;
    EXPECT_EQ(dropped.err.find("corners of other cells"), std::string::npos) << dropped.err;
    EXPECT_EQ(contents(folder / "a.pfm"), picture_of_one);
  }
}

TEST_F(Mpirun, CellsThatOverlapHaveTheBytesOfOneProcess) {
  const Folder folder;
  const std::string cube = folder.cube(), once = folder / "piece.vtu", moved = folder / "moved.vtu";
  ASSERT_EQ(tessera({"convert", cube, once, "--quiet"}).status, 0);
  ASSERT_EQ(tessera({"convert", cube, moved, "--scale", "0.8,0.9,1.1", "--quiet"}).status, 0);
  const std::string list =
      folder.file("both.pvtu",
                  "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid>"
                  "<Piece Source=\"piece.vtu\"/><Piece Source=\"moved.vtu\"/></PUnstructuredGrid></VTKFile>");
  const auto film = [&](const std::string& name, std::vector<std::string> others) {
    std::vector<std::string> all{"render",  list, "-o",       folder / (name + "_%d.pfm"), "--size", "40x30",
                                 "--orbit", "4",  "--report", folder / (name + ".json")};
    all.insert(all.end(), others.begin(), others.end());
    return all;
  };
  ASSERT_EQ(tessera(film("one", {"--quiet"})).status, 0);
  for (const std::vector<std::string>& exchange : {std::vector<std::string>{}, {"--exchange", "runs"}}) {
    std::vector<std::string> words = film("ranks", exchange);
    for (const char* more : {"--without", "sharing", "--partition", "random", "--threads", "1"})
      words.emplace_back(more);
    const Outcome outcome = mpirun(3, words);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_NE(outcome.err.find("ray segments exchanged, because cells of several ranks overlap"), std::string::npos)
        << outcome.err;
    for (int n = 0; n < 4; ++n)
      EXPECT_EQ(contents(folder / fmt::format("ranks_{}.pfm", n)), contents(folder / fmt::format("one_{}.pfm", n)))
          << n;
    const nlohmann::json report = nlohmann::json::parse(contents(folder / "ranks.json"));
    for (const nlohmann::json& frame : report.at("frames")) EXPECT_TRUE(frame.at("overlapping").get<bool>());
  }
}

TEST_F(Mpirun, ADeepPictureHasTheBytesOfOneProcess) {
  const Folder folder;
  const std::string mesh = folder.cube();
  // A tile may be a part of one square of lattice segments, or consist of several.
  for (const char* tile_size : {"32", "24", "64"})
    for (const bool peeled : {false, true}) {
      SCOPED_TRACE(testing::Message() << tile_size << peeled);
      Names words = {"render", mesh, "--size", "90x70", "--quiet", "--tile-size", tile_size};
      if (peeled) words.insert(words.end(), {"--peel", "0.3:3"});
      const auto writing = [&](const std::string& file) {
        Names all = words;
        all.insert(all.end(), {"-o", file});
        return all;
      };
      ASSERT_EQ(tessera(writing(folder / "one.deep.exr")).status, 0);
      Names on_ranks = writing(folder / "ranks.deep.exr");
      on_ranks.insert(on_ranks.end(), {"--projectors", "2"});
      const Outcome outcome = mpirun(3, on_ranks);
      ASSERT_EQ(outcome.status, 0) << outcome.err;
      EXPECT_EQ(contents(folder / "ranks.deep.exr"), contents(folder / "one.deep.exr"));
    }
}

TEST_F(Mpirun, RunsMatchTheReferenceAndTheReportHasTheJobsShape) {
  const Folder folder;
  const Outcome outcome = mpirun(4, {"render",       folder.cube(),
                                     "-o",           folder / "a.exr",
                                     "--size",       "64x64",
                                     "--threads",    "1",
                                     "--projectors", "3",
                                     "--integrator", "exact",
                                     "--verify",     "300",
                                     "--without",    "sharing",
                                     "--report",     folder / "report.json",
                                     "--timing",     folder / "trace.json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 1) << outcome.out;
  EXPECT_EQ(outcome.error_lines(), 1u) << outcome.err;
  const auto report = nlohmann::json::parse(contents(folder / "report.json"));
  EXPECT_EQ(report.at("job").at("projectors"), nlohmann::json({0, 1, 2}));
  EXPECT_EQ(report.at("job").at("compositors"), nlohmann::json({3}));
  EXPECT_EQ(report.at("mesh").at("tets"), 4 * 4 * 4 * 6);
  const auto& counters = report.at("frames").at(0).at("counters");
  EXPECT_EQ(counters.at("tets_total"), 4 * 4 * 4 * 6);
  // A run takes 24 bytes, or 16 if it is one segment; headers are extra.
  EXPECT_GE(counters.at("exchange_bytes").get<std::uint64_t>(), 16 * counters.at("fragments").get<std::uint64_t>());

  // The trace contains all ranks, and the projectors' sends account for the bytes in the report.
  const auto trace = nlohmann::json::parse(contents(folder / "trace.json"));
  std::set<int> ranks;
  std::set<int> peers, projected, composited;  // destination ranks, tiles
  std::uint64_t sent = 0;
  for (const auto& event : trace.at("traceEvents")) {
    ranks.insert(event.at("pid").get<int>());
    if (event.at("name") == "project") projected.insert(event.at("args").at("tile").get<int>());
    if (event.at("name") == "composite") composited.insert(event.at("args").at("tile").get<int>());
    if (event.at("name") == "send" && event.at("args").value("frame", -1) == 0)
      peers.insert(event.at("args").at("peer").get<int>());
    if (event.at("name") == "send" && event.at("args").value("frame", -1) == 0 && event.at("pid") != 3)
      sent += event.at("args").at("bytes").get<std::uint64_t>();
  }
  EXPECT_EQ(ranks, (std::set<int>{0, 1, 2, 3}));
  EXPECT_EQ(sent, counters.at("exchange_bytes").get<std::uint64_t>());
  EXPECT_EQ(peers, (std::set<int>{3}));
  EXPECT_EQ(projected, (std::set<int>{0, 1, 2, 3}));
  EXPECT_EQ(composited, projected);
}

TEST_F(Mpirun, BadInputIsOneLineInAllAndStatusTwo) {
  const Folder folder;
  const std::string mesh = folder.cube();
  const std::vector<std::vector<std::string>> wrong{
      {"render", folder / "missing.vtu", "-o", folder / "a.png"},
      {"render", mesh, "-o", folder / "a.png", "--projectors", "9"},
      {"render", mesh, "-o", folder / "no/such/folder/a.png"},
      {"render", mesh, "-o", folder / "a.png", "--camera", folder.file("view.txt", "position 1 2\n")},
      {"render", mesh, "-o", folder / "a.png", "--field", "nothing"},
      {"render", mesh, "-o", folder / "a.png", "--exchange", "pigeons"},
      {"render", folder.file("cut.tets", std::string(20, 'x')), "-o", folder / "a.png"},
      {"info", folder / "missing.vtu"},
      {"render"}};
  for (const auto& arguments : wrong) {
    const Outcome outcome = mpirun(3, arguments);
    EXPECT_EQ(outcome.status, 2) << outcome.err;
    EXPECT_EQ(own_lines(outcome).size(), 1u) << outcome.err;
  }
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"cube.vtu", "cut.tets", "view.txt"}));
}

TEST_F(Mpirun, RanksWithDifferentArgumentsEndInOneLine) {
  using Words = std::vector<std::string>;
  const Folder folder;
  const std::string mesh = folder.cube(), a = folder / "a.pfm", b = folder / "b.pfm";
  const Words first{"render", mesh, "-o", a, "--quiet"};
  for (const auto& [other, message] : std::vector<std::pair<Words, std::string>>{
           {{"render", mesh, "-o", b, "--quiet"}, "argument 4: rank 2 of 3 was given '" + b},
           {{"render", mesh, "-o", a},
            "argument 5: rank 2 of 3 was given nothing where the first rank was given '--qui"},
           {{"info", mesh, "-o", a, "--quiet"}, "argument 1: rank 2 of 3 was given 'info'"},
           {{"render", mesh, "-o", a, "--quiet", "--size", "9x9"},
            "'--size' where the first rank was given nothing"}}) {
    Words command = mpirun_command(2, first);
    command.insert(command.end(), {":", "-n", "1", TESSERA_PROGRAM});
    command.insert(command.end(), other.begin(), other.end());
    const Outcome outcome = Running(command).wait();
    EXPECT_EQ(outcome.status, 2) << outcome.err;
    ASSERT_EQ(own_lines(outcome).size(), 1u) << outcome.err;
    EXPECT_NE(own_lines(outcome)[0].find(message), std::string::npos) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(a) || std::filesystem::exists(b));
  }
}

TEST_F(Mpirun, ResumeRendersOnlyMissingFrames) {
  const Folder folder;
  const std::string mesh = folder.cube();
  const std::vector<std::string> film{"render",  mesh,         "-o",      folder / "f_%02d.pfm", "--size",
                                      "40x40",   "--orbit",    "5",       "--threads",           "1",
                                      "--quiet", "--exchange", "segments"};
  ASSERT_EQ(mpirun(3, film).status, 0);
  const std::string third = contents(folder / "f_03.pfm");
  std::filesystem::remove(folder / "f_03.pfm");
  std::filesystem::remove(folder / "f_00.pfm");
  const auto untouched = std::filesystem::last_write_time(folder / "f_02.pfm");
  auto again = film;
  again.emplace_back("--resume");
  ASSERT_EQ(mpirun(2, again).status, 0);
  EXPECT_EQ(contents(folder / "f_03.pfm"), third);
  EXPECT_EQ(std::filesystem::last_write_time(folder / "f_02.pfm"), untouched);
  EXPECT_EQ(folder.names().size(), 6u);
}

TEST_F(Mpirun, OtherCommandsPrintOnce) {
  const Folder folder;
  const Outcome outcome = mpirun(3, {"info", folder.cube()});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.out, tessera({"info", folder.cube()}).out);
  const Outcome help = mpirun(3, {"--help"});
  EXPECT_EQ(help.status, 0);
  EXPECT_EQ(help.out.find("Usage"), help.out.rfind("Usage"));
}

TEST_F(Mpirun, TheScanlineRasterizerGivesItsBytesOfOneProcess) {
  const Folder folder;
  const std::string mesh = folder.cube();
  const std::vector<std::string> common{"--size",       "60x60",     "--rasterizer", "scanline",
                                        "--integrator", "sampled:4", "--quiet"};
  std::vector<std::string> one{"render", mesh, "-o", folder / "one.pfm"},
      ranks{"render", mesh, "-o", folder / "ranks.pfm"};
  one.insert(one.end(), common.begin(), common.end());
  ranks.insert(ranks.end(), common.begin(), common.end());
  ASSERT_EQ(tessera(one).status, 0);
  ASSERT_EQ(mpirun(3, ranks).status, 0);
  EXPECT_EQ(contents(folder / "ranks.pfm"), contents(folder / "one.pfm"));
}

TEST_F(Mpirun, PiecesOfCurvedCellsGiveTheBytesOfOneProcess) {
  if (!io::has_reader(io::Reader::vtk)) GTEST_SKIP() << "tessera-read-vtk is not installed";
  const Folder folder;
  ASSERT_NE(folder.file("below.vtu", test::quadratic_tet_text(false)), "");
  ASSERT_NE(folder.file("above.vtu", test::quadratic_tet_text(true)), "");
  std::vector<std::string> arguments{"render",
                                     folder.file("pair.pvtu", test::quadratic_pair_text()),
                                     "-o",
                                     folder / "one.pfm",
                                     "--size",
                                     "60x50",
                                     "--quiet",
                                     "--threads",
                                     "1",
                                     "--exchange",
                                     "segments",
                                     "--accuracy",
                                     "5e-2",
                                     "--report",
                                     folder / "one.json"};
  ASSERT_EQ(tessera(arguments).status, 0);
  const auto cells_of = [&](const char* report) {
    return nlohmann::json::parse(contents(folder / report)).at("mesh").at("higher_order");
  };
  EXPECT_EQ(cells_of("one.json").at("divided"), 2);
  arguments[3] = folder / "ranks.pfm", arguments.back() = folder / "ranks.json";
  for (const int ranks : {1, 2, 3}) {
    const Outcome outcome = mpirun(ranks, arguments);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(contents(folder / "ranks.pfm"), contents(folder / "one.pfm")) << ranks;
    EXPECT_EQ(cells_of("ranks.json"), cells_of("one.json")) << ranks;
  }
}

/// Image data with `cells` cells along each axis, as the text of a .vti.
std::string image_text(int cells, double low, double spacing) {
  std::string values;
  for (int c = 0; c < cells * cells * cells; ++c) values += fmt::format("{} ", (c * 7) % 11);
  return fmt::format(
      "<VTKFile type=\"ImageData\" version=\"0.1\" byte_order=\"LittleEndian\"><ImageData WholeExtent=\"0 {0} 0 {0} 0 "
      "{0}\" Origin=\"{1} {1} {1}\" Spacing=\"{2} {2} {2}\"><Piece Extent=\"0 {0} 0 {0} 0 {0}\"><CellData><DataArray "
      "type=\"Float64\" Name=\"f\" format=\"ascii\">{3}</DataArray></CellData></Piece></ImageData></VTKFile>",
      cells, low, spacing, values);
}

/// Two cells, the first divided twice.
constexpr const char* trees_text =
    R"(<VTKFile type="HyperTreeGrid" version="2.0" byte_order="LittleEndian"><HyperTreeGrid BranchFactor="2"
TransposedRootIndexing="0" Dimensions="3 2 2"><Grid>
<DataArray type="Float64" Name="XCoordinates" NumberOfTuples="3" format="ascii">0 1 3</DataArray>
<DataArray type="Float64" Name="YCoordinates" NumberOfTuples="2" format="ascii">0 1</DataArray>
<DataArray type="Float64" Name="ZCoordinates" NumberOfTuples="2" format="ascii">0 1</DataArray></Grid><Trees>
<DataArray type="Bit" Name="Descriptors" NumberOfTuples="9" format="ascii">1 0 1 0 0 0 0 0 0</DataArray>
<DataArray type="Int64" Name="NumberOfVerticesPerDepth" NumberOfTuples="4" format="ascii">1 8 8 1</DataArray>
<DataArray type="Int64" Name="TreeIds" NumberOfTuples="2" format="ascii">0 1</DataArray>
<DataArray type="UInt32" Name="DepthPerTree" NumberOfTuples="2" format="ascii">3 1</DataArray></Trees><CellData>
<DataArray type="Float64" Name="f" NumberOfTuples="18" format="ascii">0 3 1 4 1 5 9 2 6 5 3 5 8 9 7 9 3 2</DataArray>
</CellData></HyperTreeGrid></VTKFile>
)";

TEST_F(Mpirun, MeshesWithLevelsGiveTheBytesOfOneProcess) {
  if (!io::has_reader(io::Reader::vtk)) GTEST_SKIP() << "tessera-read-vtk is not installed";
  const Folder folder;
  const std::string trees = folder.file("t.htg", trees_text);
  ASSERT_NE(folder.file("coarse.vti", image_text(4, 0, 1)), "");
  ASSERT_NE(folder.file("fine.vti", image_text(8, 1, 0.25)), "");
  const std::string blocks = folder.file(
      "a.vth",
      "<VTKFile type=\"vtkOverlappingAMR\" version=\"1.1\"><vtkOverlappingAMR><Block level=\"0\"><DataSet index=\"0\" "
      "file=\"coarse.vti\"/></Block><Block level=\"1\"><DataSet index=\"0\" file=\"fine.vti\"/></Block>"
      "</vtkOverlappingAMR></VTKFile>");
  test::SomeCases some(2);
  for (const std::string& file : {trees, blocks})
    for (const bool smooth : {false, true}) {
      std::vector<std::string> arguments{"render",  file,        "-o", folder / "one.pfm", "--size",  "60x50",
                                         "--quiet", "--threads", "1",  "--exchange",       "segments"};
      if (smooth) arguments.emplace_back("--smooth");
      ASSERT_EQ(tessera(arguments).status, 0) << file;
      arguments[3] = folder / "ranks.pfm";
      for (const int ranks : {2, 3, 1}) {
        if (!some.next()) continue;
        const Outcome outcome = mpirun(ranks, arguments);
        ASSERT_EQ(outcome.status, 0) << outcome.err;
        EXPECT_EQ(contents(folder / "ranks.pfm"), contents(folder / "one.pfm"))
            << file << ' ' << smooth << ' ' << ranks;
      }
    }
}

}  // namespace
}  // namespace tessera::apps
