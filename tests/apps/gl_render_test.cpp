// --compositor and --backend, as users give them.
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

/// Largest difference of two .pfm of one size.
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

TEST_F(GlRender, OneProcessComputesWithinTheExactPromiseAndSaysWhere) {
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

TEST_F(GlRender, ThePapersWayIsTheCpusSamplesWithAFloatFramebuffer) {
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

TEST_F(GlRender, ADeviceThatIsNotThereIsOneLine) {
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
    EXPECT_LT(picture_difference(folder / "one.pfm", folder / "ranks.pfm"), 5e-6);  // floats' roundings
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
