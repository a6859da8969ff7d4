// SPDX-License-Identifier: BSD-3-Clause
// No output replaces a file that the run reads: those named on the command line, and those named in these files.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "apps/program.hpp"
#include "support/foam_case.hpp"

namespace tessera::apps {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

/// A run that reads these files, named in one directory.
struct Case {
  Words input;  ///< arguments of render, without outputs
  Words files;  ///< names of all files that it reads
};

std::string raw_samples() {
  std::string bytes;
  for (int i = 0; i < 5 * 5 * 5; ++i) bytes += static_cast<char>(i);
  return bytes;
}

void write(const std::string& file, const std::string& text) { std::ofstream(file) << text; }

/// An EnSight Gold text file: a tetrahedron, at two times.
void write_ensight(const Folder& folder) {
  write(folder / "e.case",
        "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: e.geo\nVARIABLE\nscalar per node: 1 p e.sc*\nTIME\ntime set: 1\n"
        "number of steps: 2\nfilename start number: 0\nfilename increment: 1\ntime values: 0 1\n");
  write(folder / "e.geo",
        "one\ntet\nnode id assign\nelement id assign\npart\n         1\nbody\ncoordinates\n         4\n 0.00000e+00\n"
        " 1.00000e+00\n 0.00000e+00\n 0.00000e+00\n 0.00000e+00\n 0.00000e+00\n 1.00000e+00\n 0.00000e+00\n"
        " 0.00000e+00\n 0.00000e+00\n 0.00000e+00\n 1.00000e+00\ntetra4\n         1\n         1         2"
        "         3         4\n");
  for (const char* file : {"e.sc0", "e.sc1"})
    write(folder / file, "p\npart\n         1\ncoordinates\n 0.00000e+00\n 1.00000e+00\n 2.00000e+00\n 3.00000e+00\n");
}

std::vector<Case> cases_in(const Folder& folder) {
  const std::string mesh = folder.cube();
  EXPECT_EQ(tessera({"convert", mesh, folder / "p.pvtu", "--pieces", "2", "--quiet"}).status, 0);
  write(folder / "d.mhd",
        "ObjectType = Image\nNDims = 3\nDimSize = 5 5 5\nElementType = MET_UCHAR\nElementDataFile = d.raw\n");
  write(folder / "d.raw", raw_samples());
  write(folder / "n.nhdr", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 5 5 5\nencoding: raw\ndata file: n.raw\n");
  write(folder / "n.raw", raw_samples());
  write(folder / "cam.json", R"({"position":[0.5,0.5,9],"focal_point":[0.5,0.5,0.5],"parallel_scale":1})");
  write(folder / "tf.json", R"({"knots":[[0,1,0,0,1],[1,0,0,1,1]]})");
  write(folder / "c.toml", "opacity = 2\n");
  write(folder / "s.pvd",
        "<?xml version=\"1.0\"?><VTKFile type=\"Collection\"><Collection><DataSet timestep=\"0\" file=\"" +
            fs::path(mesh).filename().string() + "\"/></Collection></VTKFile>");
  write(folder / "m.vtm",
        "<?xml version=\"1.0\"?><VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\"><vtkMultiBlockDataSet>"
        "<DataSet index=\"0\" name=\"a\" file=\"" +
            fs::path(mesh).filename().string() + "\"/></vtkMultiBlockDataSet></VTKFile>");
  write(folder / "t.stl",
        "solid t\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
        "endsolid t\n");
  write_ensight(folder);
  io::testing::write_foam(folder / "c", io::testing::Cubes(2), [](int) { return true; });
  io::testing::write_control(folder / "c");
  const std::string cube = fs::path(mesh).filename();
  return {{{mesh, "--camera", folder / "cam.json", "--transfer-function", folder / "tf.json", "--config",
            folder / "c.toml", "--surface", folder / "t.stl"},
           {cube, "cam.json", "tf.json", "c.toml", "t.stl"}},
          {{folder / "p.pvtu"}, {"p.pvtu", "p_0000.vtu", "p_0001.vtu"}},
          {{folder / "d.mhd"}, {"d.mhd", "d.raw"}},
          {{folder / "n.nhdr"}, {"n.nhdr", "n.raw"}},
          {{folder / "s.pvd"}, {"s.pvd", cube}},
          {{folder / "m.vtm"}, {"m.vtm", cube}},
          {{folder / "e.case"}, {"e.case", "e.geo", "e.sc0", "e.sc1"}},
          {{folder / "c"}, {"c/system/controlDict", "c/constant/polyMesh/points", "c/0/p", "c/1/p"}}};
}

std::map<std::string, std::string> all_bytes(const Folder& folder) {
  std::map<std::string, std::string> bytes;
  for (const auto& entry : fs::recursive_directory_iterator(folder / ""))
    if (entry.is_regular_file()) bytes[entry.path()] = contents(entry.path());
  return bytes;
}

Words operator+(Words a, const Words& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

void expect_refused(const Folder& folder, const Words& command) {
  const auto before = all_bytes(folder);
  const Outcome run = tessera(command);
  std::string text;
  for (const std::string& word : command) text += word + ' ';
  EXPECT_EQ(run.status, 2) << text << run.err;
  EXPECT_EQ(run.error_lines(), 1u) << text << run.err;
  EXPECT_NE(run.err.find("would be overwritten"), std::string::npos) << text << run.err;
  EXPECT_EQ(all_bytes(folder), before) << text;
}

TEST(InputProtection, NoOutputReplacesAnInput) {
  const Folder folder, elsewhere;
  const std::vector<Case> cases = cases_in(folder);
  fs::create_directory_symlink(folder / "", elsewhere / "folder");
  std::size_t collisions = 0;
  for (const Case& each : cases) {
    const Words render = Words{"render"} + each.input + Words{"--size", "8x8"};
    const Outcome works = tessera(render + Words{"-o", elsewhere / "works.png"});
    if (works.status == 2 && works.err.find("is not installed") != std::string::npos) continue;  // not installed
    ASSERT_EQ(works.status, 0) << works.err;
    for (const std::string& file : each.files) {
      std::string flat = file;
      std::ranges::replace(flat, '/', '-');
      const std::string link = elsewhere / ("link-" + flat), hard = folder / ("hard-" + flat);
      fs::remove(link);
      fs::create_symlink(folder / file, link);
      fs::create_hard_link(folder / file, hard);
      for (const std::string& name : {folder / file, link, elsewhere / ("folder/" + file), hard})
        for (const char* option : {"--report", "--timing", "--save-config"}) {
          expect_refused(folder, render + Words{"-o", elsewhere / "a.png", option, name});
          ++collisions;
        }
      fs::remove(hard);
      const std::string picture = elsewhere / "link.png";
      fs::remove(picture);
      fs::create_symlink(folder / file, picture);
      expect_refused(folder, render + Words{"-o", picture});
      ++collisions;
    }
  }
  EXPECT_GE(collisions, 100u);
}

TEST(InputProtection, ConversionReplacesNoPartOfItsInput) {
  const Folder folder;
  static_cast<void>(cases_in(folder));
  expect_refused(folder, {"convert", folder / "p.pvtu", folder / "p_0001.vtu"});
  expect_refused(folder, {"convert", folder / "p.pvtu", folder / "p.pvtu", "--pieces", "2"});
  expect_refused(folder, {"convert", folder / "d.mhd", folder / "d.raw"});
  expect_refused(folder, {"convert", folder / "n.nhdr", folder / "n.raw"});
  expect_refused(folder, {"convert", folder / "m.vtm", folder.cube()});
}

// All settings must be examined before the first output is written.
TEST(InputProtection, ARefusedRunWritesNothing) {
  const Folder folder;
  const std::string mesh = folder.cube();
  const auto before = all_bytes(folder);
  for (const Words& wrong : {Words{"--zoom", "0"}, Words{"--size", "0x0"}, Words{"--field", "none"},
                             Words{"--camera", folder / "none.json"}, Words{"--transfer-function", "none"}}) {
    const Outcome run = tessera(Words{"render", mesh, "-o", folder / "a.png", "--save-config", folder / "s.toml",
                                      "--report", folder / "r.json"} +
                                wrong);
    EXPECT_EQ(run.status, 2) << run.err;
    EXPECT_EQ(all_bytes(folder), before) << wrong.front();
  }
}

TEST(InputProtection, OneFileByTwoNamesIsOneOutput) {
  const Folder folder;
  fs::create_directory_symlink(folder / "", folder / "here");
  const Outcome run =
      tessera({"render", folder.cube(), "-o", folder / "a.png", "-o", folder / "here/a.png", "--size", "8x8"});
  EXPECT_EQ(run.status, 2) << run.err;
  EXPECT_NE(run.err.find("given twice as an output"), std::string::npos) << run.err;
}

// Steps of a list that this run does not render are protected too.
TEST(InputProtection, StepsThatAreNotDrawnAreNotReplaced) {
  const Folder folder;
  const std::string mesh = folder.cube();
  fs::copy_file(mesh, folder / "other.vtu");
  write(folder / "s.pvd",
        R"(<?xml version="1.0"?><VTKFile type="Collection"><Collection><DataSet timestep="0" file=")" +
            fs::path(mesh).filename().string() +
            R"("/><DataSet timestep="1" file="other.vtu"/></Collection></VTKFile>)");
  const Words run = {"render", folder / "s.pvd", "--time-step", "0", "-o", folder / "a.png", "--size", "8x8"};
  ASSERT_EQ(tessera(run).status, 0);
  expect_refused(folder, run + Words{"--report", folder / "other.vtu"});
}

// Files that a reader only inspects in a directory do not become inputs.
TEST(InputProtection, ImagesInAnInputDirectoryAreReplaced) {
  const Folder folder;
  fs::create_directories(folder / "case/constant/polyMesh");
  fs::create_directories(folder / "case/system");
  fs::create_directories(folder / "case/0");
  const auto foam = [&](const std::string& name, const std::string& kind, const std::string& text) {
    write(folder / ("case/" + name), "FoamFile { version 2.0; format ascii; class " + kind + "; object x; }\n" + text);
  };
  foam("system/controlDict", "dictionary", "application none;\nstartTime 0;\n");
  foam("constant/polyMesh/points", "vectorField", "8 ((0 0 0)(1 0 0)(1 1 0)(0 1 0)(0 0 1)(1 0 1)(1 1 1)(0 1 1))\n");
  foam("constant/polyMesh/faces", "faceList",
       "6 (4(0 3 2 1) 4(4 5 6 7) 4(0 1 5 4) 4(3 7 6 2) 4(0 4 7 3) 4(1 2 6 5))\n");
  foam("constant/polyMesh/owner", "labelList", "6 (0 0 0 0 0 0)\n");
  foam("constant/polyMesh/neighbour", "labelList", "0 ()\n");
  foam("constant/polyMesh/boundary", "polyBoundaryMesh", "1 (walls { type wall; nFaces 6; startFace 0; })\n");
  foam("0/p", "volScalarField", "dimensions [0 0 0 0 0 0 0];\ninternalField uniform 1;\nboundaryField {}\n");
  const Words run = {"render", folder / "case", "-o", folder / "case/0/a.png", "--size", "8x8"};
  const Outcome first = tessera(run);
  if (first.err.find("is not installed") != std::string::npos) GTEST_SKIP() << "the reader is not installed";
  ASSERT_EQ(first.status, 0) << first.err;
  const Outcome again = tessera(run);
  EXPECT_EQ(again.status, 0) << again.err;
}

// Outputs of a run are not inputs of the next.
TEST(InputProtection, OutputsOfAnEarlierRunAreReplaced) {
  const Folder folder;
  const Words run = {
      "render",          folder.cube(), "-o",  folder / "a.png", "--report",      folder / "r.json", "--timing",
      folder / "t.json", "--size",      "8x8", "--quiet",        "--save-config", folder / "s.toml"};
  ASSERT_EQ(tessera(run).status, 0);
  const auto before = all_bytes(folder);
  const Outcome again = tessera(run);
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(all_bytes(folder).size(), before.size());
  EXPECT_EQ(contents(folder / "a.png"), before.at(folder / "a.png"));
}

}  // namespace
}  // namespace tessera::apps
