// SPDX-License-Identifier: BSD-3-Clause
// `tessera info`, `convert` and `generate`.

#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <tuple>

#include "apps/program.hpp"
#include "apps/quadratic_mesh.hpp"
#include "io/files/reader_programs.hpp"
#include "io/mesh/mesh_formats.hpp"
#include "scene/mesh_facts.hpp"
#include "support/read_files.hpp"

namespace tessera::apps {
namespace {

TEST(Info, PrintsTheContentsAsTextAndAsJson) {
  const Folder folder;
  const auto mesh = folder.cube();
  const auto text = tessera({"info", mesh});
  EXPECT_EQ(text.status, 0) << text.err;
  for (const char* word : {"384 of 384 cells", "125", "bounds", "fields", "renders", "unit distance", "orthographic"})
    EXPECT_NE(text.out.find(word), std::string::npos) << word << " in " << text.out;

  const auto machine = tessera({"info", "--json", mesh});
  ASSERT_EQ(machine.status, 0) << machine.err;
  const auto json = nlohmann::json::parse(machine.out);
  EXPECT_EQ(json.at("cells").at("read"), 384);
  EXPECT_EQ(json.at("points").at("read"), 125);
  EXPECT_EQ(json.at("fields").size(), 1u);
  EXPECT_TRUE(json.at("renders").at("view").contains("parallel_scale"));
}

TEST(Info, CountsInfiniteNumbers) {
  const Folder folder;
  const auto mesh = folder / "a.vtu";
  const auto array = [](const std::string& type, const std::string& name, const std::string& numbers) {
    return "<DataArray type=\"" + type + "\" Name=\"" + name + "\"" +
           (name == "Points" ? " NumberOfComponents=\"3\"" : "") + " format=\"ascii\">" + numbers + "</DataArray>";
  };
  std::ofstream(mesh)
      << "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\"><UnstructuredGrid>"
         "<Piece NumberOfPoints=\"5\" NumberOfCells=\"2\"><PointData>"
      << array("Float64", "f", "0 1 2 3 inf") << "</PointData><Points>"
      << array("Float64", "Points", "0 0 0 1 0 0 0 1 0 0 0 1 1 1 1") << "</Points><Cells>"
      << array("Int64", "connectivity", "0 1 2 3 4 2 1 3") << array("Int64", "offsets", "4 8")
      << array("UInt8", "types", "10 10") << "</Cells></Piece></UnstructuredGrid></VTKFile>";
  const auto text = tessera({"info", mesh});
  EXPECT_EQ(text.status, 0) << text.err;
  EXPECT_NE(text.out.find("1 of 2 cells kept as 1 tets, 1 dropped for NaN, infinite or missing numbers"),
            std::string::npos)
      << text.out;
  EXPECT_NE(text.out.find("0 to 3, 1 NaN or infinite"), std::string::npos) << text.out;
}

// A terminal would interpret them as commands.
TEST(Info, ShowsNoControlCharactersOfNames) {
  const Folder folder;
  const auto mesh = folder / "a\x1b[2J\nb.vtu";
  ASSERT_EQ(tessera({"generate", "cube", folder / "c.vtu", "n=2"}).status, 0);
  std::ifstream made(folder / "c.vtu", std::ios::binary);
  std::string text(std::istreambuf_iterator<char>(made), {});
  const std::string name =
      "\"\xc2\x9b"
      "31m&#10;tessera: f\xe2\x80\xae\"";
  for (std::size_t at = text.find("\"f\""); at != std::string::npos; at = text.find("\"f\"", at))
    text.replace(at, 3, name);
  ASSERT_NE(text.find(name), std::string::npos) << text.substr(0, 1000);
  std::ofstream(mesh, std::ios::binary) << text;
  const auto expect_plain = [](const std::string& printed) {
    for (const char* const mark : {"\x1b", "\xc2\x9b", "\xe2\x80\xae", "\ntessera: f"})
      EXPECT_EQ(printed.find(mark), std::string::npos) << printed;
  };
  const auto info = tessera({"info", mesh});
  EXPECT_EQ(info.status, 0) << info.err;
  EXPECT_NE(info.out.find("31m tessera: f"), std::string::npos) << info.out;
  expect_plain(info.out);
  const auto picture = tessera({"render", mesh, "-o", folder / "o.pfm", "--size", "16x16"});
  EXPECT_EQ(picture.status, 0) << picture.err;
  EXPECT_NE(picture.err.find("31m tessera: f"), std::string::npos) << picture.err;
  expect_plain(picture.err);
  const auto wrong = tessera({"render", mesh, "-o", folder / "o.pfm", "--size", "16x16", "--field", "none\xc2\x9b"});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_EQ(wrong.error_lines(), 1u) << wrong.err;
  expect_plain(wrong.err);
  const auto json = tessera({"info", "--json", mesh});
  EXPECT_EQ(nlohmann::json::parse(json.out).at("fields").at(0).at("name"),
            "\xc2\x9b"
            "31m\ntessera: f\xe2\x80\xae")
      << "what is meant for programs has names as they are";
}

TEST(Info, CutsNamesOfMegabytesShort) {
  const Folder folder;
  const auto list = folder.file("p.pvtu", "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid><Piece Source=\"" +
                                              std::string(3'000'000, 'y') + "\"/></PUnstructuredGrid></VTKFile>");
  const auto refused = tessera({"info", list});
  EXPECT_EQ(refused.status, 2);
  EXPECT_EQ(refused.error_lines(), 1u);
  EXPECT_LT(refused.err.size(), 5000u);
}

TEST(Info, ListsTheBlocksThatBlockChoosesFrom) {
  const Folder folder;
  const auto zone = [](int number, int x) {
    return "IZONE= " + std::to_string(number) + "\nNDIME= 3\nNELEM= 1\n10 0 1 2 3\nNPOIN= 4\n" + std::to_string(x) +
           " 0 0\n9 0 0\n9 1 0\n9 0 1\n";
  };
  const auto mesh = folder / "a.su2";
  std::ofstream(mesh) << "NZONE= 2\n" << zone(1, 0) << zone(2, 5);
  const auto text = tessera({"info", mesh, "--block", "zone 2"});
  EXPECT_EQ(text.status, 0) << text.err;
  EXPECT_NE(text.out.find("blocks    zone 1, zone 2\n"), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("1 of 1 cells"), std::string::npos) << text.out;
  const auto both = tessera({"info", mesh, "--json", "--block", "zone 2", "--block", "zone 1"});
  ASSERT_EQ(both.status, 0) << both.err;
  EXPECT_EQ(nlohmann::json::parse(both.out).at("tets"), 2);
  const auto none = tessera({"convert", mesh, folder / "b.tets", "--block", "zone 3"});
  EXPECT_EQ(none.status, 2);
  EXPECT_NE(none.err.find("no block 'zone 3'; it has 'zone 1', 'zone 2'"), std::string::npos) << none.err;
}

TEST(Info, HigherOrderCellsAreWarnedOfInALineOfTheirOwn) {
  if (!io::has_reader(io::Reader::vtk)) GTEST_SKIP() << "tessera-read-vtk is not installed";
  const Folder folder;
  const auto mesh = folder / "a.vtk";
  std::ofstream(mesh) << "# vtk DataFile Version 3.0\na\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 10 float\n"
                         "0 0 0 1 0 0 0 1 0 0 0 1 .5 0 0 .5 .5 0 0 .5 0 0 0 .5 .5 0 .5 0 .5 .5\nCELLS 1 11\n"
                         "10 0 1 2 3 4 5 6 7 8 9\nCELL_TYPES 1\n24\nPOINT_DATA 10\nSCALARS a float 1\n"
                         "LOOKUP_TABLE default\n0 1 2 3 4 5 6 7 8 8.5\n";
  const auto info = tessera({"info", mesh, "--higher-order-tets", "0"});
  EXPECT_NE(info.out.find("\nwarning   1 higher-order cells"), std::string::npos) << info.out;
  const auto render = tessera({"render", mesh, "-o", folder / "a.png", "--size", "16x16", "--higher-order-tets", "0"});
  EXPECT_EQ(render.status, 0) << render.err;
  EXPECT_TRUE(render.err.starts_with("tessera: warning: ")) << render.err;
  EXPECT_EQ(render.error_lines(), 2u) << render.err;
  const auto quiet =
      tessera({"render", mesh, "-o", folder / "a.png", "--size", "16x16", "--higher-order-tets", "0", "--quiet"});
  EXPECT_TRUE(quiet.err.starts_with("tessera: warning: ")) << quiet.err;
  EXPECT_EQ(quiet.error_lines(), 1u) << quiet.err;
}

TEST(Render, DividesHigherOrderCellsAsFinelyAsTheAccuracyNeeds) {
  const Folder folder;
  const auto mesh = folder.file("a.vtu", test::quadratic_tet_text(true));
  const auto report_of = [&](const std::vector<std::string>& more, Outcome& outcome) {
    std::vector<std::string> arguments{"render", mesh,    "-o",       folder / "a.png",
                                       "--size", "16x16", "--report", folder / "a.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    outcome = tessera(arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return nlohmann::json::parse(contents(folder / "a.json")).at("mesh").at("higher_order");
  };
  Outcome outcome;
  std::uint64_t before = 0;
  for (const auto& [words, accuracy] : {std::pair{"1e-1", 1e-1}, std::pair{"1e-2", 1e-2}, std::pair{"1e-3", 1e-3}}) {
    const auto cells = report_of({"--accuracy", words}, outcome);
    EXPECT_LE(cells.at("pixel_error").get<double>(), accuracy);
    EXPECT_GT(cells.at("tets").get<std::uint64_t>(), before);
    EXPECT_EQ(outcome.err.find("warning"), std::string::npos) << outcome.err;
    before = cells.at("tets").get<std::uint64_t>();
  }
  const auto few = report_of({"--accuracy", "1e-2", "--higher-order-tets", "50"}, outcome);
  EXPECT_GT(few.at("pixel_error").get<double>(), 1e-2);
  const std::string one_line = std::regex_replace(outcome.err, std::regex("\n +"), " ");  // lines break anywhere
  for (const char* words : {"--accuracy 0.01", "--higher-order-tets allows more"})
    EXPECT_NE(one_line.find(words), std::string::npos) << outcome.err;
  const auto fixed = report_of({"--higher-order-tolerance", "0.05"}, outcome);
  EXPECT_EQ(fixed.at("tolerance"), 0.05);
}

TEST(Convert, KeepsThePicture) {
  const Folder folder;
  const auto mesh = folder.cube();
  const auto converted = tessera({"convert", mesh, folder / "again.vtu"});
  ASSERT_EQ(converted.status, 0) << converted.err;
  EXPECT_EQ(converted.error_lines(), 1u);
  ASSERT_EQ(tessera({"render", mesh, "-o", folder / "a.exr", "--size", "32x32"}).status, 0);
  ASSERT_EQ(tessera({"render", folder / "again.vtu", "-o", folder / "b.exr", "--size", "32x32"}).status, 0);
  EXPECT_TRUE(contents(folder / "a.exr") == contents(folder / "b.exr"));
}

TEST(Convert, WritesTetsThatReadBack) {
  const Folder folder;
  ASSERT_EQ(tessera({"convert", folder.cube(), folder / "c.tets", "--quiet"}).status, 0);
  EXPECT_EQ(contents(folder / "c.tets").size(), 16u + 125 * 16 + 384 * 16);
  const auto info = tessera({"info", "--json", folder / "c.tets"});
  EXPECT_EQ(nlohmann::json::parse(info.out).at("tets"), 384);
}

TEST(Convert, SubdividingCutsEveryTetIntoEightAndKeepsTheField) {
  const Folder folder;
  ASSERT_EQ(tessera({"convert", folder.cube(), folder / "fine.tets", "--subdivide", "1"}).status, 0);
  const auto coarse = nlohmann::json::parse(tessera({"info", "--json", folder.cube()}).out);
  const auto fine = nlohmann::json::parse(tessera({"info", "--json", folder / "fine.tets"}).out);
  EXPECT_EQ(fine.at("tets"), 8 * 384);
  EXPECT_EQ(fine.at("bounds"), coarse.at("bounds"));
  EXPECT_EQ(fine.at("field").at("range"), coarse.at("field").at("range"));
  const auto refused = tessera({"convert", folder.cube(), folder / "no.tets", "--subdivide", "9"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_EQ(refused.error_lines(), 1u);
}

TEST(Convert, PiecesHoldEveryTetOnceAndFileOrderKeepsThePicture) {
  const Folder folder;
  const auto cube = folder.cube(), few = folder / "few.vtu";
  ASSERT_EQ(tessera({"generate", "cube", few, "n=1"}).status, 0);
  for (const char* partition : {"file", "curve", "random"})
    for (const auto& [mesh, pieces, tets] :
         {std::tuple{cube, "1", 384}, {cube, "3", 384}, {few, "8", 6}}) {  // two of eight have no tets
      SCOPED_TRACE(testing::Message() << partition << " in " << pieces);
      const auto run = tessera({"convert", mesh, folder / "p.pvtu", "--pieces", pieces, "--partition", partition});
      ASSERT_EQ(run.status, 0) << run.err;
      EXPECT_EQ(run.error_lines(), 1u) << run.err;
      EXPECT_EQ(nlohmann::json::parse(tessera({"info", "--json", folder / "p.pvtu"}).out).at("tets"), tets);
      ASSERT_EQ(tessera({"render", folder / "p.pvtu", "-o", folder / "p.exr", "--size", "48x48"}).status, 0);
      if (partition == std::string("file")) {
        ASSERT_EQ(tessera({"render", mesh, "-o", folder / "whole.exr", "--size", "48x48"}).status, 0);
        EXPECT_TRUE(contents(folder / "whole.exr") == contents(folder / "p.exr"));
      }
      const cells::MeshFile read = io::read_mesh(folder / "p.pvtu"), whole = io::read_mesh(mesh);
      std::multiset<std::array<double, 16>> expected, found;
      for (const auto* file : {&read, &whole})
        for (const scene::Tet& tet : file->mesh.tets) {
          std::array<double, 16> corners;
          for (std::size_t k = 0; k < 4; ++k) {
            const glm::dvec3& p = file->mesh.positions[tet[k]];
            corners[4 * k] = p.x, corners[4 * k + 1] = p.y, corners[4 * k + 2] = p.z;
            corners[4 * k + 3] = file->mesh.scalars[tet[k]];
          }
          (file == &read ? found : expected).insert(corners);
        }
      EXPECT_TRUE(found == expected);
      EXPECT_EQ(scene::facts_of(read.mesh), scene::facts_of(whole.mesh));
    }
}

TEST(Convert, PiecesThatCannotBeWrittenLeaveNothing) {
  const Folder folder;
  const auto mesh = folder.cube();
  const auto names = folder.names();
  for (const std::vector<std::string>& words : {std::vector<std::string>{"o.vtu", "--pieces", "2"},
                                                {"o.pvtu"},
                                                {"o.pvtu", "--pieces", "0"},
                                                {"o.pvtu", "--pieces", "two"},
                                                {"o.pvtu", "--pieces", "2", "--partition", "space"},
                                                {"o.vtu", "--partition", "file"},
                                                {"no/o.pvtu", "--pieces", "2"}}) {
    std::vector<std::string> arguments = {"convert", mesh, folder / words[0]};
    arguments.insert(arguments.end(), words.begin() + 1, words.end());
    const auto run = tessera(arguments);
    EXPECT_EQ(run.status, 2) << words[0];
    EXPECT_EQ(run.error_lines(), 1u) << run.err;
    EXPECT_EQ(folder.names(), names);
  }
  // A directory instead of a piece: detected when pieces are renamed.
  std::filesystem::create_directory(folder / "o_0002.vtu");
  const auto run = tessera({"convert", mesh, folder / "o.pvtu", "--pieces", "4"});
  EXPECT_NE(run.status, 0);
  EXPECT_EQ(run.error_lines(), 1u) << run.err;
  std::filesystem::remove(folder / "o_0002.vtu");
  EXPECT_EQ(folder.names(), names);
}

TEST(Convert, PiecesNeverReplaceTheInput) {
  const Folder folder;
  ASSERT_EQ(tessera({"convert", folder.cube(), folder / "a.pvtu", "--pieces", "3"}).status, 0);
  const auto before = contents(folder / "a_0001.vtu");
  const auto itself = tessera({"convert", folder / "a.pvtu", folder / "a.pvtu", "--pieces", "2"});
  EXPECT_EQ(itself.status, 2);
  // Another list of the same pieces.
  std::filesystem::copy_file(folder / "a.pvtu", folder / "b.pvtu");
  const auto run = tessera({"convert", folder / "b.pvtu", folder / "a.pvtu", "--pieces", "2"});
  EXPECT_EQ(run.status, 2);
  EXPECT_NE(run.err.find("is an input"), std::string::npos) << run.err;
  EXPECT_EQ(contents(folder / "a_0001.vtu"), before);
}

TEST(Generate, MakesEveryKindThatItsHelpLists) {
  const Folder folder;
  const auto run = tessera({"generate", "tet", folder / "tet.vtu"});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.err.find("1 tets"), std::string::npos) << run.err;
}

}  // namespace
}  // namespace tessera::apps
