// SPDX-License-Identifier: BSD-3-Clause
// --compositor and --backend on the command line.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "apps/program.hpp"
#include "support/gl_context.hpp"

namespace tessera::apps {
namespace {

class GlRender : public ::testing::Test {
 protected:
  void SetUp() override {
    if (tests::osmesa_or_none() == nullptr) GTEST_SKIP() << "OSMesa cannot be opened";
  }
};

/// Largest difference of two .pfm files of one size.
double picture_difference(const std::string& a, const std::string& b) {
  const std::string x = contents(a), y = contents(b);
  EXPECT_EQ(x.size(), y.size());
  const std::size_t pixels = 24 * 20 * 3;
  std::vector<float> p(pixels), q(pixels);
  std::memcpy(p.data(), x.data() + x.size() - 4 * pixels, 4 * pixels);
  std::memcpy(q.data(), y.data() + y.size() - 4 * pixels, 4 * pixels);
  double most = 0;
  for (std::size_t i = 0; i < pixels; ++i) most = std::max(most, std::fabs(double{p[i]} - q[i]));
  return most;
}

std::vector<std::string> render_arguments(const std::string& mesh, const std::string& picture,
                                          const std::vector<std::string>& more) {
  std::vector<std::string> all{"render", mesh, "-o", picture, "--size", "24x20", "--threads", "1"};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

TEST_F(GlRender, OneProcessKeepsTheExactPromiseAndReportsTheDevice) {
  const Folder folder;
  const std::string mesh = folder.cube();
  const auto run = tessera(
      render_arguments(mesh, folder / "gl.pfm",
                       {"--compositor", "gl-compute", "--backend", "osmesa", "--integrator", "exact", "--verify", "200",
                        "--report", folder / "report.json", "--timing", folder / "trace.json"}));
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.err.find("composited by gl-compute (OSMesa, "), std::string::npos) << run.err;
  EXPECT_NE(run.out.find("bound 2e-05 met"), std::string::npos) << run.out;
  const auto report = nlohmann::json::parse(contents(folder / "report.json"));
  EXPECT_EQ(report.at("method").at("compositor"), "gl-compute");
  EXPECT_TRUE(report.at("frames").at(0).at("backend").get<std::string>().starts_with("gl-compute (OSMesa"));
  std::size_t passes = 0;
  const auto trace = nlohmann::json::parse(contents(folder / "trace.json"));
  for (const auto& event : trace.at("traceEvents"))
    if (event.at("name") == "sort" && event.at("args").contains("messages"))
      passes += event.at("args").at("messages").get<int>();
  EXPECT_GE(passes, 1u);
  const auto timing = tessera({"timing", folder / "trace.json"});
  EXPECT_EQ(timing.status, 0) << timing.err;
}

TEST_F(GlRender, BackendAloneMeansCompute) {
  const Folder folder;
  const std::string mesh = folder.cube();
  const auto run = tessera(render_arguments(mesh, folder / "gl.pfm", {"--backend", "osmesa"}));
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.err.find("composited by gl-compute (OSMesa, "), std::string::npos) << run.err;
}

TEST_F(GlRender, ThePapersMethodMatchesTheCpusSamplesWithAFloatFramebuffer) {
  const Folder folder;
  const std::string mesh = folder.cube();
  const std::vector<std::string> sampled{"--integrator", "sampled:4", "--quiet"};
  ASSERT_EQ(tessera(render_arguments(mesh, folder / "cpu.pfm", sampled)).status, 0);
  auto on_gl = sampled;
  on_gl.insert(on_gl.end(), {"--compositor", "gl-fragment", "--backend", "osmesa", "--framebuffer", "float"});
  const auto run = tessera(render_arguments(mesh, folder / "gl.pfm", on_gl));
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.err, "");
  EXPECT_LT(picture_difference(folder / "cpu.pfm", folder / "gl.pfm"), 1e-4);
}

TEST_F(GlRender, AutomaticNeverTakesSoftware) {
  const Folder folder;
  const std::string mesh = folder.cube();
  ASSERT_EQ(tessera(render_arguments(mesh, folder / "cpu.pfm", {"--quiet"})).status, 0);
  const auto run = tessera(render_arguments(mesh, folder / "auto.pfm", {"--compositor", "gl-compute"}));
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.err.find("llvmpipe"), std::string::npos) << run.err;
  if (run.err.find("composited by cpu (") != std::string::npos) {
    EXPECT_EQ(contents(folder / "cpu.pfm"), contents(folder / "auto.pfm"));
  }
}

TEST_F(GlRender, ReportsAMissingDeviceInOneLine) {
  const Folder folder;
  const auto run =
      tessera(render_arguments(folder.cube(), folder / "x.pfm", {"--backend", "egl", "--egl-device", "1000"}));
  EXPECT_TRUE(run.status == 2 || run.status == 3) << run.status;  // no such device, or no EGL
  EXPECT_EQ(run.error_lines(), 1u) << run.err;
}

TEST_F(GlRender, RanksCompositeOnDevicesOrPartlyOnTheCpu) {
  if (!has_mpirun()) GTEST_SKIP() << "there is no mpirun";
  const Folder folder;
  const std::string mesh = folder.cube();
  ASSERT_EQ(tessera(render_arguments(mesh, folder / "one.pfm", {"--quiet", "--integrator", "exact"})).status, 0);
  for (const std::string backends : {"osmesa", "cpu,osmesa"}) {
    const auto run =
        mpirun(4, render_arguments(mesh, folder / "ranks.pfm",
                                   {"--integrator", "exact", "--projectors", "2", "--compositors", "2", "--tile-size",
                                    "8", "--compositor", "gl-compute", "--backend", backends}));
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_NE(
        run.err.find(backends == "osmesa" ? "composited by gl-compute (OSMesa" : "composited by cpu + gl-compute"),
        std::string::npos)
        << run.err;
    EXPECT_LT(picture_difference(folder / "one.pfm", folder / "ranks.pfm"), 5e-6);  // rounding of floats
  }
}

TEST_F(GlRender, DevicesRasterizeCellsWithinTheExactPromise) {
  const Folder folder;
  const auto run = tessera(render_arguments(
      folder.cube(), folder / "device.pfm",
      {"--rasterizer", "device", "--compositor", "gl-compute", "--backend", "osmesa", "--integrator", "exact",
       "--verify", "200", "--report", folder / "report.json", "--timing", folder / "trace.json"}));
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.err.find("device, exact"), std::string::npos) << run.err;
  EXPECT_NE(run.out.find("bound 2e-05 met"), std::string::npos) << run.out;
  const auto report = nlohmann::json::parse(contents(folder / "report.json"));
  EXPECT_EQ(report.at("method").at("rasterizer"), "device");
  const auto& counters = report.at("frames").at(0).at("counters");
  EXPECT_GT(counters.at("cells_on_device").get<int>(), 0);
  EXPECT_GT(counters.at("segments").get<int>(), 0);
}

TEST_F(GlRender, DevicesOfRanksInAnyRolesRasterizeCells) {
  if (!has_mpirun()) GTEST_SKIP() << "there is no mpirun";
  const Folder folder;
  const std::string mesh = folder.cube();
  ASSERT_EQ(tessera(render_arguments(mesh, folder / "one.pfm", {"--quiet", "--integrator", "exact"})).status, 0);
  for (const int ranks : {2, 4}) {  // two ranks with both roles, or four with one role each
    std::vector<std::string> more{"--integrator", "exact", "--projectors", "2",          "--compositors", "2",
                                  "--tile-size",  "8",     "--compositor", "gl-compute", "--rasterizer",  "device",
                                  "--backend"};
    more.emplace_back("osmesa");
    const auto run = mpirun(ranks, render_arguments(mesh, folder / "ranks.pfm", more));
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_NE(run.err.find("device, exact"), std::string::npos) << run.err;
    EXPECT_LT(picture_difference(folder / "one.pfm", folder / "ranks.pfm"), 5e-6);
    more.back() = "cpu,osmesa";
    const auto mixed = mpirun(ranks, render_arguments(mesh, folder / "x.pfm", more));
    EXPECT_EQ(mixed.status, 2);
    EXPECT_NE(mixed.err.find("--rasterizer device: --backend leaves some compositors to the CPU"), std::string::npos)
        << mixed.err;
  }
}

/// The complete pipeline of Juliachs et al. 2007, selected by one option and by its parts.
TEST_F(GlRender, ThePresetIsThePrintedPipeline) {
  const Folder folder;
  const std::string mesh = folder.cube();
  ASSERT_EQ(tessera(render_arguments(mesh, folder / "parts.pfm",
                                     {"--quiet", "--rasterizer", "scanline", "--integrator", "sampled:4",
                                      "--compositor", "gl-fragment", "--backend", "osmesa", "--tile-size", "2"}))
                .status,
            0);
  const auto one = tessera(
      render_arguments(mesh, folder / "one.pfm", {"--preset", "juliachs-2007", "--report", folder / "report.json"}));
  ASSERT_EQ(one.status, 0) << one.err;
  EXPECT_NE(one.err.find("scanline, sampled:4"), std::string::npos) << one.err;
  EXPECT_NE(one.err.find("composited by gl-fragment (OSMesa, "), std::string::npos) << one.err;
  EXPECT_EQ(contents(folder / "parts.pfm"), contents(folder / "one.pfm"));
  const auto method = nlohmann::json::parse(contents(folder / "report.json")).at("method");
  EXPECT_EQ(method.at("framebuffer"), "half");
  // Other options override it.
  ASSERT_EQ(tessera(render_arguments(mesh, folder / "own.pfm",
                                     {"--preset", "juliachs-2007", "--compositor", "cpu", "--integrator", "exact",
                                      "--rasterizer", "planes"}))
                .status,
            0);
  ASSERT_EQ(tessera(render_arguments(mesh, folder / "plain.pfm", {"--integrator", "exact"})).status, 0);
  EXPECT_EQ(contents(folder / "own.pfm"), contents(folder / "plain.pfm"));
  const auto wrong = tessera(render_arguments(mesh, folder / "x.pfm", {"--preset", "juliachs"}));
  EXPECT_EQ(wrong.status, 2);
  EXPECT_NE(wrong.err.find("--preset: 'juliachs' is unknown; use juliachs-2007"), std::string::npos) << wrong.err;
}

/// Runs on 1, 2 and 4 projectors with as many compositors. Images differ slightly, because 16-bit values are rounded at
/// each segment of a list, and because the order of equal keys, which the paper leaves open, differs between ranks.
TEST_F(GlRender, ThePresetOnRanksIsOneProcess) {
  if (!has_mpirun()) GTEST_SKIP() << "there is no mpirun";
  const Folder folder;
  const std::string mesh = folder.cube();
  ASSERT_EQ(tessera(render_arguments(mesh, folder / "one.pfm", {"--preset", "juliachs-2007", "--quiet"})).status, 0);
  for (const std::size_t ranks : {2, 4, 8}) {
    const auto run = mpirun(static_cast<int>(ranks),
                            render_arguments(mesh, folder / "ranks.pfm",
                                             {"--preset", "juliachs-2007", "--report", folder / "report.json"}));
    ASSERT_EQ(run.status, 0) << run.err;
    const auto job = nlohmann::json::parse(contents(folder / "report.json")).at("job");
    EXPECT_EQ(job.at("projectors").size(), ranks / 2) << job;
    EXPECT_EQ(job.at("compositors").size(), ranks / 2) << job;
    EXPECT_LT(picture_difference(folder / "one.pfm", folder / "ranks.pfm"), 4e-3) << ranks;
  }
}

TEST_F(GlRender, ADeviceThatIsMissingOnOneRankEndsAllOfThem) {
  if (!has_mpirun()) GTEST_SKIP() << "there is no mpirun";
  const Folder folder;
  const auto run = mpirun(
      4, render_arguments(folder.cube(), folder / "x.pfm",
                          {"--projectors", "2", "--compositors", "2", "--backend", "cpu,egl", "--egl-device", "1000"}));
  EXPECT_TRUE(run.status == 2 || run.status == 3) << run.status;
  EXPECT_NE(run.err.find("tessera: "), std::string::npos) << run.err;
  EXPECT_EQ(folder.names(), std::vector<std::string>{"cube.vtu"});
}

}  // namespace
}  // namespace tessera::apps
