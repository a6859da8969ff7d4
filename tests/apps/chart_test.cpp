// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "analysis/chart_measure.hpp"
#include "analysis/delta_e.hpp"
#include "apps/program.hpp"

namespace tessera::apps {
namespace {

TEST(DeltaE, AgreesWithThePublishedPairs) {
  // Sharma, Wu, Dalal 2005, Table 1: pairs 1, 2, 7, 9, 17, 20, 25, 33.
  const struct {
    glm::dvec3 a, b;
    double difference;
  } pairs[] = {{{50, 2.6772, -79.7751}, {50, 0, -82.7485}, 2.0425},
               {{50, 3.1571, -77.2803}, {50, 0, -82.7485}, 2.8615},
               {{50, 0, 0}, {50, -1, 2}, 2.3669},
               {{50, 2.49, -0.001}, {50, -2.49, 0.0009}, 7.1792},
               {{50, 2.5, 0}, {73, 25, -18}, 27.1492},
               {{50, 2.5, 0}, {58, 24, 15}, 19.4535},
               {{60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}, 1.2644},
               {{6.7747, -0.2908, -2.4247}, {5.8714, -0.0985, -2.2286}, 0.6377}};
  for (const auto& pair : pairs) {
    EXPECT_NEAR(analysis::delta_e_2000(pair.a, pair.b), pair.difference, 5.1e-5);  // four digits are printed
    EXPECT_NEAR(analysis::delta_e_2000(pair.b, pair.a), pair.difference, 5.1e-5);
  }
  EXPECT_NEAR(glm::dvec3(analysis::lab_of_linear({1, 1, 1})).x, 100, 1e-12);
  EXPECT_NEAR(analysis::lab_of_linear({0.18, 0.18, 0.18}).x, 49.496, 1e-3);
}

TEST(ChartMeasure, ErrorsAreOfTheSampledPixels) {
  Image image({2, 2});
  image.rgba = {0, 0, 0, 0, 0.5f, 0.5f, 0.5f, 1, 9, 9, 9, 9, 0.25f, 0, 0, 0.25f};
  const std::vector<PixelIndex> pixels = {{0, 0}, {1, 0}, {1, 1}};
  std::vector<ReferencePixel> truths(3);
  truths[1] = {0.5, 0.25, 0.5, 1};
  truths[2] = {0.25, 0, 0, 0.5};
  const analysis::ChartError error = analysis::chart_error(image, pixels, truths);
  EXPECT_DOUBLE_EQ(error.max, 0.25);
  EXPECT_DOUBLE_EQ(error.p999, 0.25);
  EXPECT_DOUBLE_EQ(error.rms, std::sqrt(2 * 0.0625 / 12));
  EXPECT_DOUBLE_EQ(error.visible_share, 1.0 / 3);  // opacity alone is not visible over black
  EXPECT_DOUBLE_EQ(analysis::chart_error(image, pixels, truths, 3).rms, std::sqrt(0.0625 / 9));
  image.rgba[0] = std::nanf("");
  EXPECT_TRUE(std::isinf(analysis::chart_error(image, pixels, truths).max));
  EXPECT_FALSE(analysis::chart_error(image, pixels, truths).finite);
}

analysis::ChartPoint point(const char* name, std::vector<double> ms, double error) {
  analysis::ChartPoint p;
  p.name = name, p.frame_ms = std::move(ms), p.error.max = error;
  return p;
}

TEST(ChartMeasure, TheParetoFrontHasTheUndominatedMethods) {
  std::vector<analysis::ChartPoint> points = {point("fast", {9, 1, 1}, 1e-2), point("best", {5}, 1e-7),
                                              point("beaten", {6}, 1e-3),     point("middle", {4, 2}, 1e-3),
                                              point("twin", {3}, 1e-3),       analysis::ChartPoint()};
  points.back().left_out = "not here";
  analysis::mark_front(points);
  const std::vector<bool> expected = {true, true, false, true, true, false};
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(points[i].on_front, expected[i]) << i;
  EXPECT_EQ(analysis::fastest_within(points, 1e-2)->name, "fast");
  EXPECT_EQ(analysis::fastest_within(points, 2e-3)->name, "middle");
  EXPECT_EQ(analysis::fastest_within(points, 1e-5)->name, "best");
  EXPECT_EQ(analysis::fastest_within(points, 1e-9), nullptr);
}

nlohmann::json parsed(const std::string& file) { return nlohmann::json::parse(std::ifstream(file)); }

TEST(Chart, AMeshChartPlacesEveryMethodOrGivesAReason) {
  const Folder folder;
  const Outcome run = tessera({"chart", folder.cube(), "--size", "24x20", "--repeat", "1", "--budget-seconds", "300",
                               "--quiet", "--json", folder / "c.json", "--csv", folder / "c.csv", "--figure",
                               folder / "c.svg", "--figure", folder / "c.png"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.error_lines(), 0u) << run.err;
  EXPECT_NE(run.out.find("fastest within 1e-05: "), std::string::npos);
  const auto json = parsed(folder / "c.json");
  EXPECT_TRUE(json["pixels"]["whole_image"]);
  EXPECT_EQ(json["pixels"]["count"], 24 * 20);
  std::set<std::string> families;
  for (const auto& method : json["methods"]) {
    if (method.contains("left_out")) continue;
    families.insert(method["family"]);
    EXPECT_EQ(method["frame_ms"].size(), 1u);
    EXPECT_GE(method["max_error"], method["error_999"]);
    EXPECT_GE(method["error_999"], method["rms_error"]);
    if (method["name"] == "planes exact") {
      EXPECT_LT(method["max_error"], 2e-5);
    }
    if (method["name"] == "planes sampled:1") {
      EXPECT_GT(method["max_error"], 1e-5);
    }
  }
  for (const char* family :
       {"planes, auto", "planes, preintegrated", "planes, partial", "scanline, sampled", "two ranks, random cells"})
    EXPECT_TRUE(families.count(family) == 1) << family;
  std::ifstream csv(folder / "c.csv");
  std::size_t lines = 0;
  for (std::string line; std::getline(csv, line);) ++lines;
  EXPECT_EQ(lines, json["methods"].size() + 1);
  EXPECT_TRUE(std::ifstream(folder / "c.svg").good());
  EXPECT_TRUE(std::ifstream(folder / "c.png").good());
}

TEST(Chart, AVolumeAndAPeersPictureShareOneChart) {
  const Folder folder;
  ASSERT_EQ(tessera({"generate", "ripples", folder / "r.vti", "n=12", "--quiet"}).status, 0);
  // A peer whose image equals ours, without opacity.
  ASSERT_EQ(tessera({"render", folder / "r.vti", "-o", folder / "p.pfm", "--size", "16x12", "--quiet"}).status, 0);
  std::ofstream(folder / "p.json")
      << R"([{"family": "peer", "name": "peer one", "frame_ms": [3, 1, 2], "picture": "p.pfm"},
                                          {"family": "peer", "name": "peer two", "left_out": "not installed"}])";
  const Outcome run = tessera({"chart", folder / "r.vti", "--size", "16x12", "--repeat", "1", "--quiet", "--peer",
                               folder / "p.json", "--json", folder / "c.json"});
  ASSERT_EQ(run.status, 0) << run.err;
  bool found = false;
  const auto json = parsed(folder / "c.json");
  for (const auto& method : json["methods"]) {
    if (method["name"] == "peer two") {
      EXPECT_EQ(method["left_out"], "not installed");
    }
    if (method["name"] != "peer one") continue;
    found = true;
    EXPECT_EQ(method["median_ms"], 2);
    EXPECT_LT(method["max_error"], 1e-4);
  }
  EXPECT_TRUE(found);
  const Outcome wrong =
      tessera({"chart", folder / "r.vti", "--size", "8x8", "--repeat", "1", "--quiet", "--peer", folder / "p.json"});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_NE(wrong.err.find("it is 16x12 pixels, but the chart is 8x8"), std::string::npos);
}

TEST(Chart, ABudgetForNothingStillMeasuresTheDefaultAndNamesTheRest) {
  const Folder folder;
  const Outcome run = tessera({"chart", folder.cube(), "--size", "24x20", "--budget-seconds", "1e-9", "--quiet",
                               "--json", folder / "c.json", "--figure", folder / "c.svg"});
  ASSERT_EQ(run.status, 0) << run.err;
  const auto methods = parsed(folder / "c.json")["methods"];
  EXPECT_EQ(methods[0]["options"], "--accuracy 0.0001");
  EXPECT_EQ(methods[0]["frame_ms"].size(), 1u);
  for (std::size_t n = 1; n < methods.size(); ++n) EXPECT_TRUE(methods[n].contains("left_out")) << methods[n]["name"];
  EXPECT_NE(run.out.find("no room in the budget: planes auto 0.01"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("fastest within 0.0001: planes auto 0.0001"), std::string::npos) << run.out;
}

TEST(Chart, RefusesImpossibleRequestsBeforeTheWork) {
  const Folder folder;
  EXPECT_EQ(tessera({"chart", folder.cube(), "--figure", folder / "c.pdf", "--quiet"}).status, 2);
  EXPECT_EQ(tessera({"chart", folder.cube(), "--budget-seconds", "0", "--quiet"}).status, 2);
  EXPECT_EQ(tessera({"chart", folder.cube(), "--json", folder / "none/c.json", "--quiet"}).status, 2);
  EXPECT_EQ(tessera({"info", folder.cube(), "--check"}).status, 0);
}

}  // namespace
}  // namespace tessera::apps
