// SPDX-License-Identifier: BSD-3-Clause
// Surfaces in the volume on the command line.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/program.hpp"
#include "io/image/image_file.hpp"

namespace tessera::apps {
namespace {

TEST(Surfaces, OfValuesAreRenderedVerifiedAndReported) {
  const Folder folder;
  const auto run =
      tessera({"render", folder.cube(), "-o", folder / "a.exr", "--size", "64x48", "--iso", "0.3:red:0.4", "--iso",
               "0.5:#4080ff", "--iso=0.7::0.5", "--verify", "500", "--report", folder / "r.json"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_NE((run.out + run.err).find(" met"), std::string::npos) << run.out << run.err;
  const auto image = io::read_image(folder / "a.exr");
  EXPECT_EQ(image.rgba[4 * image.index(32, 24) + 3], 1.0f);
  const auto report = nlohmann::json::parse(contents(folder / "r.json"));
  const auto text = report.dump();
  EXPECT_NE(text.find(R"("iso":[{"color":[1.0,0.0,0.0],"opacity":)"), std::string::npos) << text;
}

/// Two triangles that intersect [-1, 1]^3 and extend beyond it.
std::string write_sheet(const Folder& folder) {
  return folder.file("sheet.ply",
                     "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                     "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                     "-1.5 -1.5 0.1\n1.5 -1.5 0.2\n1.5 1.5 0.3\n-1.5 1.5 0.2\n4 0 1 2 3\n");
}

TEST(Surfaces, OfTheBoundaryAndOfFilesAreRenderedVerifiedAndReported) {
  const Folder folder;
  const auto run = tessera({"render", folder.cube(), "-o", folder / "a.exr", "--size", "64x48", "--surface",
                            "boundary::0.3", "--surface", write_sheet(folder) + ":red:0.5", "--clip", "0.2,0,0,1,0.3,0",
                            "--iso", "0.5", "--verify", "500", "--report", folder / "r.json"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_NE((run.out + run.err).find(" met"), std::string::npos) << run.out << run.err;
  const auto text = nlohmann::json::parse(contents(folder / "r.json")).dump();
  EXPECT_NE(text.find(R"("what":"boundary")"), std::string::npos) << text;
  EXPECT_NE(text.find(R"("what":"2 triangles")"), std::string::npos) << text;
}

TEST(Surfaces, OfBlocksMayHaveColonsInTheirNames) {
  const Folder folder;
  const std::string cube = std::filesystem::path(folder.cube()).filename();
  const auto list = [&](const std::string& file, const std::string& name) {
    return folder.file(file,
                       "<VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\"><vtkMultiBlockDataSet>"
                       "<DataSet index=\"0\" name=\"" +
                           name + "\" file=\"" + cube + "\"/></vtkMultiBlockDataSet></VTKFile>");
  };
  const auto picture = [&](const std::string& input, const std::string& surface) {
    const Outcome run = tessera({"render", input, "-o", folder / "a.png", "--size", "64x64", "--surface", surface});
    EXPECT_EQ(run.status, 0) << run.err;
    return contents(folder / "a.png");
  };
  const std::string plain = list("plain.vtm", "block"), name = "links: Gehause/left #1: x";
  const std::string odd = list("odd.vtm", name);
  for (const char* look : {"", ":red", ":red:0.5", "::0.25"})
    EXPECT_EQ(picture(odd, name + look), picture(plain, std::string("block") + look)) << look;
  const Outcome wrong = tessera({"render", odd, "-o", folder / "a.png", "--surface", name + ":rde"});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_NE(wrong.err.find("'rde'"), std::string::npos) << wrong.err;
}

TEST(Surfaces, ThatTheFieldDoesNotReachAreWarnedOf) {
  const Folder folder;
  const auto run = tessera({"render", folder.cube(), "-o", folder / "a.png", "--size", "8x8", "--iso", "5"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.err.find("--iso 5: it shows nothing, because the field's values are from 0.03"), std::string::npos)
      << run.err;
}

// The warning is printed even with --quiet, because it changes the meaning of the image.
TEST(Surfaces, PrintsWarningsWithQuiet) {
  const Folder folder;
  const Outcome run =
      tessera({"render", folder.cube(), "-o", folder / "a.png", "--size", "8x8", "--iso", "5000", "--quiet"});
  EXPECT_EQ(run.status, 0);
  ASSERT_EQ(run.error_lines(), 1u) << run.err;
  EXPECT_NE(run.err.find("warning"), std::string::npos) << run.err;
}

TEST(Surfaces, OfGridsAreVerifiedAndTheSameOnAnyNumberOfRanks) {
  const Folder folder;
  ASSERT_EQ(tessera({"generate", "ripples", folder / "grid.vti", "n=24", "--quiet"}).status, 0);
  const auto render = [&](const std::string& out, std::vector<std::string> more) {
    std::vector<std::string> arguments{"render", folder / "grid.vti", "-o",    folder / out,    "--size", "70x50",
                                       "--iso",  "0.5:red",           "--iso", "0.3:white:0.4", "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
  const auto one = tessera(render("one.pfm", {"--verify", "500", "--clip", "0,0,0,1,1,0"}));
  EXPECT_EQ(one.status, 0) << one.err;
  const auto plain = tessera(render("plain.pfm", {"--clip", "0,0,0,1,1,0", "--integrator", "exact", "--shade"}));
  EXPECT_EQ(plain.status, 0) << plain.err;
  if (!has_mpirun()) GTEST_SKIP() << "there is no mpirun";
  const Outcome ranks = mpirun(3, render("ranks.pfm", {"--threads", "1", "--clip", "0,0,0,1,1,0"}));
  ASSERT_EQ(ranks.status, 0) << ranks.err;
  EXPECT_EQ(contents(folder / "ranks.pfm"), contents(folder / "one.pfm"));
}

TEST(Surfaces, OfSeveralRanksHaveTheBytesOfOne) {
  if (!has_mpirun()) GTEST_SKIP() << "there is no mpirun";
  const Folder folder;
  const std::string mesh = folder.cube(), sheet = write_sheet(folder);
  const auto render = [&](const std::string& out, std::vector<std::string> more) {
    std::vector<std::string> arguments{"render",
                                       mesh,
                                       "-o",
                                       folder / out,
                                       "--size",
                                       "70x50",
                                       "--iso",
                                       "0.5",
                                       "--iso=0.3::0.4",
                                       "--surface",
                                       "boundary::0.2",
                                       "--surface",
                                       sheet + "::0.3",
                                       "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
  ASSERT_EQ(tessera(render("one.pfm", {})).status, 0);
  const Outcome ranks =
      mpirun(3, render("ranks.pfm", {"--exchange", "segments", "--partition", "random", "--threads", "1"}));
  ASSERT_EQ(ranks.status, 0) << ranks.err;
  EXPECT_EQ(contents(folder / "ranks.pfm"), contents(folder / "one.pfm"));
  ASSERT_EQ(tessera(render("one.deep.exr", {})).status, 0);
  const Outcome deep = mpirun(3, render("ranks.deep.exr", {"--threads", "1"}));
  ASSERT_EQ(deep.status, 0) << deep.err;
  EXPECT_EQ(contents(folder / "ranks.deep.exr"), contents(folder / "one.deep.exr"));
}

}  // namespace
}  // namespace tessera::apps
