// SPDX-License-Identifier: BSD-3-Clause
// `tessera render` and `tessera info` of a mesh that changes with time.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/program.hpp"

namespace tessera::apps {
namespace {

using Names = std::vector<std::string>;

class Series : public ::testing::Test {
 protected:
  /// Three different cubes, numbered with a gap: m_0001.vtu, m_0002.vtu, m_0010.vtu.
  void SetUp() override {
    for (const int step : {1, 2, 10}) {
      meshes.push_back(folder / fmt::format("m_{:04}.vtu", step));
      // The last is twice as large, so that its own default view would differ.
      ASSERT_EQ(tessera({"generate", "cube", meshes.back(), "n=3", fmt::format("seed={}", step),
                         fmt::format("scale={}", step == 10 ? 2 : 1), "--quiet"})
                    .status,
                0);
    }
    pattern = folder / "m_%04d.vtu";
    function = folder.file("f.txt", "0 1 0 0 0.2\n0.5 0 1 0 2\n1 0 0 1 1\n");
    camera = folder.file("c.txt", "position 4 3 5\nfocal_point 0 0 0\nparallel_scale 2.5\n");
  }

  Names arguments(const Names& inputs, const std::string& output, const Names& more = {}) const {
    Names all = {"render"};
    all.insert(all.end(), inputs.begin(), inputs.end());
    for (const std::string& word : {std::string("-o"), folder / output, std::string("--size"), std::string("24x24")})
      all.push_back(word);
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  std::string pvd(const std::string& text) const {
    return folder.file("film.pvd", "<VTKFile type=\"Collection\"><Collection>" + text + "</Collection></VTKFile>");
  }

  Folder folder;
  Names meshes;
  std::string pattern, function, camera;
};

TEST_F(Series, EachFrameIsThePictureOfItsMesh) {
  const Names looks = {"--transfer-function", function, "--camera", camera};
  std::vector<std::string> expected;
  for (const std::string& mesh : meshes) {
    ASSERT_EQ(tessera(arguments({mesh}, "one.pfm", looks)).status, 0);
    expected.push_back(contents(folder / "one.pfm"));
  }
  EXPECT_NE(expected[0], expected[1]);
  const std::string film =
      pvd("<DataSet timestep=\"3\" file=\"m_0010.vtu\"/><DataSet timestep=\"1\" file=\"m_0001.vtu\"/>"
          "<DataSet timestep=\"2.5\" file=\"m_0002.vtu\"/>");
  for (const Names& inputs : {Names{pattern}, Names{film}, meshes}) {
    const auto run = tessera(arguments(inputs, "f_%d.pfm", looks));
    ASSERT_EQ(run.status, 0) << run.err;
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_TRUE(contents(folder / fmt::format("f_{}.pfm", k)) == expected[k]) << inputs[0] << " frame " << k;
    EXPECT_EQ(run.error_lines(), 5u) << run.err;
    EXPECT_NE(run.err.find("note: field f is chosen by time steps 0, 1 and 2 of 0 to 2"), std::string::npos) << run.err;
    EXPECT_NE(run.err.find("; 3 time steps\n"), std::string::npos) << run.err;
    EXPECT_NE(run.err.find("frame 3 of 3: m_0010.vtu, 162 tets projected, "), std::string::npos) << run.err;
  }
  EXPECT_EQ(tessera(arguments(meshes, "f_%d.pfm", {"--quiet"})).err, "");
}

TEST_F(Series, TheViewIsTheFirstStepsForAll) {
  const auto run = tessera(arguments({pattern}, "f_%d.pfm", {"--report", folder / "report.json"}));
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.err.find("; the view of the first of 3 time steps, "), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("note: field f and its colours are chosen by time steps 0, 1 and 2 of 0 to 2"),
            std::string::npos);
  const auto report = nlohmann::json::parse(contents(folder / "report.json"));
  ASSERT_EQ(report.at("frames").size(), 3u);
  for (const auto& frame : report.at("frames")) EXPECT_EQ(frame.at("view"), report.at("frames")[0].at("view"));
  EXPECT_EQ(report.at("frames")[2].at("time"), 10);
  EXPECT_EQ(report.at("frames")[2].at("meshes"), nlohmann::json({meshes[2]}));
}

TEST_F(Series, StepsTimesViews) {
  const auto run = tessera(arguments({pattern}, "f_%d.pfm", {"--orbit", "2", "--report", folder / "report.json"}));
  ASSERT_EQ(run.status, 0) << run.err;
  const auto report = nlohmann::json::parse(contents(folder / "report.json"));
  ASSERT_EQ(report.at("frames").size(), 6u);
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_EQ(report.at("frames")[k].at("meshes")[0], meshes[k / 2]);
    EXPECT_EQ(report.at("frames")[k].at("view"), report.at("frames")[k % 2].at("view"));
  }
}

TEST_F(Series, ResumeReadsNoMeshWhoseFramesExist) {
  const Names resume = arguments(meshes, "f_%d.pfm", {"--resume"});
  ASSERT_EQ(tessera(resume).status, 0);
  const std::string last = contents(folder / "f_2.pfm");
  std::filesystem::remove(folder / "f_2.pfm");
  std::filesystem::remove(meshes[1]);  // its frame exists; the first mesh is needed for view and transfer function
  const auto run = tessera(resume);
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(contents(folder / "f_2.pfm") == last);
  for (const std::string& mesh : meshes) std::filesystem::remove(mesh);
  const auto again = tessera(resume);
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_NE(again.err.find("all 3 frames exist already"), std::string::npos) << again.err;
}

TEST_F(Series, PartsOfATimestepAreOneMesh) {
  ASSERT_EQ(tessera({"convert", meshes[0], folder / "p.pvtu", "--pieces", "2", "--partition", "file"}).status, 0);
  const std::string film =
      pvd("<DataSet timestep=\"0\" part=\"1\" file=\"p_0001.vtu\"/><DataSet timestep=\"0\" part=\"0\" "
          "file=\"p_0000.vtu\"/>");
  const auto run = tessera(arguments({film}, "parts.pfm"));
  ASSERT_EQ(run.status, 0) << run.err;
  ASSERT_EQ(tessera(arguments({meshes[0]}, "one.pfm")).status, 0);
  EXPECT_TRUE(contents(folder / "one.pfm") == contents(folder / "parts.pfm"));
}

TEST_F(Series, TheFieldOfTheFirstStepIsKept) {
  // The field is chosen among those that vary. A later step without this field is reported before any image is
  // rendered.
  const auto rename = [&](const std::string& mesh) {
    const auto text = contents(mesh);
    std::string changed = text;
    for (std::size_t at = changed.find("\"f\""); at != std::string::npos; at = changed.find("\"f\"", at))
      changed.replace(at, 3, "\"g\"");
    EXPECT_NE(changed, text);
    return folder.file("renamed.vtu", changed);
  };
  const auto run = tessera(arguments({meshes[0], rename(meshes[1])}, "f_%d.pfm"));
  EXPECT_EQ(run.status, 2);
  EXPECT_NE(run.err.find("time step 1 has no field 'point:f', which time step 0 shows"), std::string::npos) << run.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "f_0.pfm"));
  const auto named = tessera(arguments({meshes[0], folder / "renamed.vtu"}, "f_%d.pfm", {"--field", "f"}));
  EXPECT_EQ(named.status, 2);
  EXPECT_NE(named.err.find("renamed.vtu: there is no field 'f'"), std::string::npos) << named.err;
}

TEST_F(Series, FaultsAreOneLineBeforeAnythingIsRendered) {
  const auto names = folder.names();
  const std::string missing =
      pvd("<DataSet timestep=\"0\" file=\"m_0001.vtu\"/><DataSet timestep=\"1\" file=\"no.vtu\"/>");
  const std::string malformed = folder.file("bad.pvd", "<VTKFile type=\"Collection\"><Collection>");
  const auto with_films = folder.names();
  for (const Names& inputs :
       {Names{folder / "k_%04d.vtu"}, Names{missing}, Names{malformed}, Names{folder / "none.pvd"},
        Names{meshes[0], folder / "no.vtu"}, Names{meshes[0], pattern}, Names{meshes[0], function}}) {
    const auto run = tessera(arguments(inputs, "f_%d.pfm"));
    EXPECT_EQ(run.status, 2) << inputs.back();
    EXPECT_EQ(run.error_lines(), 1u) << run.err;
    EXPECT_EQ(folder.names(), with_films);
  }
  const auto unnumbered = tessera(arguments({pattern}, "f.pfm"));
  EXPECT_EQ(unnumbered.status, 2);
  EXPECT_NE(unnumbered.err.find("the names of 3 frames need numbers"), std::string::npos) << unnumbered.err;
  const auto run = tessera({"convert", missing, folder / "o.vtu"});
  EXPECT_EQ(run.status, 2);
  EXPECT_NE(run.err.find("it is a time series, which only render and serve accept"), std::string::npos) << run.err;
  EXPECT_EQ(folder.names(), with_films);
}

TEST_F(Series, RanksMakeTheSameFilm) {
  if (!has_mpirun()) GTEST_SKIP() << "there is no mpirun";
  ASSERT_EQ(tessera({"convert", meshes[2], folder / "p.pvtu", "--pieces", "3"}).status, 0);
  const Names inputs = {meshes[0], folder / "p.pvtu", meshes[1]};  // read whole, in parts, whole
  ASSERT_EQ(tessera(arguments(inputs, "one_%d.pfm", {"--quiet", "--orbit", "2"})).status, 0);
  for (const Names& shape : {Names{"--projectors", "2", "--compositors", "1"}, Names{"--projectors", "1"}}) {
    Names more = {"--quiet", "--orbit", "2", "--exchange", "segments", "--threads", "1"};
    more.insert(more.end(), shape.begin(), shape.end());
    const Outcome run = mpirun(3, arguments(inputs, "many_%d.pfm", more));
    ASSERT_EQ(run.status, 0) << run.err;
    for (int k = 0; k < 6; ++k)
      EXPECT_TRUE(contents(folder / fmt::format("one_{}.pfm", k)) == contents(folder / fmt::format("many_{}.pfm", k)))
          << "frame " << k;
  }
}

}  // namespace
}  // namespace tessera::apps
