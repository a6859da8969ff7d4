// SPDX-License-Identifier: BSD-3-Clause
#include "io/scene/paraview_color_map.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "colormaps/color_spaces.hpp"
#include "colormaps/transfer_curves.hpp"
#include "support/temporary_folder.hpp"

namespace tessera::io {
namespace {

using test::expect_bad_input;

colormaps::LoadedTransferFunction parse(const std::string& text,
                                        const colormaps::TransferFunctionOptions& options = {}) {
  return parse_paraview_color_map(text, "map.json", options);
}

/// A map over 0 to 2 (not normalised) with the given space.
std::string map(const std::string& space, const std::string& more = "") {
  return R"([{"Name": "test", "ColorSpace": ")" + space +
         R"(", "RGBPoints": [0, 0.231373, 0.298039, 0.752941, 1, 0.705882, 0.0156863, 0.14902, 2, 0.9, 0.9, 0.2])" +
         more + "}]";
}

struct Color {
  double x, r, g, b;
};

/// Compares the map, read back at values between its knots and encoded again, with display colours.
void expect_colors(const scene::TransferFunction& f, const std::vector<Color>& truths, double tolerance,
                   const std::string& space) {
  for (const Color& truth : truths) {
    const glm::dvec3 c = colormaps::encode_srgb(f.evaluate(truth.x).color);
    EXPECT_NEAR(c.x, truth.r, tolerance) << space << " red at " << truth.x;
    EXPECT_NEAR(c.y, truth.g, tolerance) << space << " green at " << truth.x;
    EXPECT_NEAR(c.z, truth.b, tolerance) << space << " blue at " << truth.x;
  }
}

// Reference values from VTK 9.1's vtkColorTransferFunction::GetColor(x) through its Python wrapping: AddRGBPoint for
// each point of map(), SetColorSpaceTo<space>(), and SetHSVWrap(0 or 1) for HSV.
// Tolerance: a curve of knots may deviate by 1e-4 of linear light, which in dark colours is up to 1.3e-3 of display
// value (slope 12.92 at black); VTK's own XYZ matrices are rounded so that a round trip changes colours by 1.3e-4.
constexpr double tolerance = 1.5e-3;

TEST(ParaViewColorMap, MixesColoursLikeVtkInRgb) {
  expect_colors(parse(map("RGB")).function,
                {{-0.5, 0.231373, 0.298039, 0.752941},
                 {0.1, 0.278823900, 0.269803730, 0.692548900},
                 {0.25, 0.350000250, 0.227450825, 0.601960750},
                 {0.5, 0.468627500, 0.156862650, 0.450980500},
                 {0.9, 0.658431100, 0.043921570, 0.209412100},
                 {1.3, 0.764117400, 0.280980410, 0.164314000},
                 {2.5, 0.9, 0.9, 0.2}},
                tolerance, "RGB");
}

TEST(ParaViewColorMap, MixesColoursLikeVtkInLab) {
  const std::vector<Color> truths{
      {0.1, 0.355754988, 0.280486032, 0.689155756}, {0.25, 0.466813343, 0.253075163, 0.595160089},
      {0.5, 0.580662530, 0.202498456, 0.443042772}, {0.75, 0.653883510, 0.138599115, 0.296020041},
      {0.9, 0.686924808, 0.082290577, 0.208762267}, {1.3, 0.784719293, 0.380435274, 0.172776605}};
  for (const char* name : {"Lab", "CIELAB"}) expect_colors(parse(map(name)).function, truths, tolerance, name);
  const auto approximate = parse(map("LabCIEDE2000"));
  expect_colors(approximate.function, truths, tolerance, "LabCIEDE2000");
  EXPECT_NE(approximate.name.find("Lab for LabCIEDE2000"), std::string::npos) << approximate.name;
}

TEST(ParaViewColorMap, MixesColoursLikeVtkThroughWhite) {
  expect_colors(parse(map("Diverging")).function,
                {{0.1, 0.351735418, 0.468505687, 0.890375511},
                 {0.25, 0.553318141, 0.688634521, 0.995187915},
                 {0.5, 0.865395197, 0.865410210, 0.865395561},
                 {0.6, 0.948076211, 0.795204736, 0.717169620},
                 {0.75, 0.958417217, 0.603116240, 0.481685120},
                 {0.9, 0.842251404, 0.326619276, 0.266613231},
                 {1.3, 1, 0.805209337, 0.552883485}},
                tolerance, "Diverging");
}

TEST(ParaViewColorMap, MixesColoursLikeVtkFromGreysAndOutOfGamut) {
  const std::string points = R"("RGBPoints": [0, 0, 0, 0, 1, 0.1, 0.2, 0.9, 2, 1, 1, 1, 3, 0.9, 0.1, 0.1]})";
  expect_colors(parse(R"({"ColorSpace": "Diverging", )" + points).function,
                {{0.2, 0.208572085, 0.199077799, 0.230744252},
                 {0.5, 0.441004130, 0.388233425, 0.601447378},
                 {0.8, 0.442043590, 0.366893667, 0.873628567},
                 {1.2, 0.492896803, 0.411545089, 1},
                 {1.5, 0.715148335, 0.626728834, 1},
                 {2.2, 1, 0.812890398, 0.771575364},
                 {2.8, 1, 0.389803348, 0.298068512}},
                tolerance, "Diverging");
  expect_colors(parse(R"({"ColorSpace": "Lab", )" + points).function,
                {{0.2, 0.088552586, 0.066260053, 0.176559749},
                 {0.8, 0.140841302, 0.166381138, 0.702376618},
                 {1.5, 0.673502522, 0.586389587, 0.960063239},
                 {2.2, 1, 0.826333253, 0.787936173},
                 {2.8, 0.956414585, 0.358048558, 0.270816718}},
                tolerance, "Lab");
}

TEST(ParaViewColorMap, MixesColoursLikeVtkInHsvWithAndWithoutWrapping) {
  const std::vector<Color> same{{0.1, 0.244021608, 0.208596970, 0.748235100},
                                {0.25, 0.376427247, 0.174935991, 0.741176250},
                                {0.5, 0.631628914, 0.120175872, 0.729411500},
                                {0.75, 0.717646750, 0.067092641, 0.507414626}};
  expect_colors(parse(map("HSV")).function, same, tolerance, "HSV");
  expect_colors(parse(map("HSV")).function, {{1.3, 0.318638589, 0.062827456, 0.764117400}}, tolerance, "HSV");
  for (const auto& text : {map("HSV", ", \"HSVWrap\": 1"), map("HSV", ", \"HSVWrap\": true"), map("Wrapped")}) {
    expect_colors(parse(text).function, same, tolerance, "HSV wrapping");
    expect_colors(parse(text).function, {{1.3, 0.764117400, 0.178380600, 0.062827456}}, tolerance, "HSV wrapping");
  }
}

TEST(ParaViewColorMap, StepTakesTheSecondColourOfTheInterval) {
  expect_colors(parse(map("Step")).function,
                {{-0.5, 0.231373, 0.298039, 0.752941},
                 {0.1, 0.705882, 0.0156863, 0.14902},
                 {0.9, 0.705882, 0.0156863, 0.14902},
                 {1.3, 0.9, 0.9, 0.2},
                 {2, 0.9, 0.9, 0.2}},
                1e-12, "Step");
}

TEST(ParaViewColorMap, ColoursBetweenKnotsAreRightTo1e4OfLinearLight) {
  for (const auto& [name, space, wraps] :
       {std::tuple{"RGB", colormaps::ColorSpace::rgb, false}, std::tuple{"Lab", colormaps::ColorSpace::lab, false},
        std::tuple{"Diverging", colormaps::ColorSpace::diverging, false},
        std::tuple{"HSV", colormaps::ColorSpace::hsv, false}}) {
    const auto f = parse(map(name)).function;
    const glm::dvec3 a{0.231373, 0.298039, 0.752941}, b{0.705882, 0.0156863, 0.14902};
    double worst = 0;
    for (int i = 0; i < 10000; ++i) {
      const double t = (i + 0.5) / 10000;
      const glm::dvec3 miss =
          colormaps::decode_srgb(colormaps::mix_colors(a, b, t, space, wraps)) - f.evaluate(t).color;
      worst = std::max({worst, std::abs(miss.x), std::abs(miss.y), std::abs(miss.z)});
    }
    // Chords are tested at 15 points. A gamut edge or a corner of hue between two of these points can exceed the bound
    // by 2 %.
    EXPECT_LE(worst, 1.02e-4) << name;
    EXPECT_LE(f.knots().size(), 400u) << name;
  }
}

TEST(ParaViewColorMap, OpacityIsMadeExtinctionAfterInterpolation) {
  const auto loaded = parse(map("RGB", ", \"Points\": [0, 0, 0.5, 0, 2, 0.9, 0.5, 0]"));
  // Halfway from opacity 0 to 0.9, the opacity is 0.45. The extinction is therefore 0.598, not half of 2.303.
  EXPECT_NEAR(loaded.function.evaluate(1).extinction, -std::log(0.55), 1e-4 * 0.6);
  for (int i = 0; i <= 1000; ++i) {
    const double exact = -std::log1p(-0.9 * i / 1000.0);
    EXPECT_NEAR(loaded.function.evaluate(2 * i / 1000.0).extinction, exact, 1e-4 * std::max(exact, 0.01) + 1e-15) << i;
  }
  EXPECT_LE(loaded.function.knots().size(), 300u);
}

TEST(ParaViewColorMap, AnOpacityOfOneStaysFinite) {
  const auto f = parse(map("RGB", ", \"Points\": [0, 0, 0.5, 0, 2, 1, 0.5, 0]")).function;
  EXPECT_NEAR(f.max_extinction(), -std::log(1e-6), 1e-6);
  EXPECT_NEAR(f.evaluate(1.9).extinction, -std::log(0.05), 1e-4 * 3);
  EXPECT_LE(f.knots().size(), 500u);
}

TEST(ParaViewColorMap, MidpointAndSharpnessAreVtks) {
  // Reference values from VTK 9.1's vtkPiecewiseFunction::GetValue(x): AddPoint(x, y, midpoint, sharpness) for the
  // points below.
  const std::string points =
      ", \"Points\": [0, 0.1, 0.3, 0.4,  1, 0.9, 0.7, 0,  3, 0.2, 0.25, 1,  4, 0.6, 0.5, 0.8,  5, 0, 0.5, 0]";
  const auto f = parse(map("RGB", points)).function;
  const struct {
    double x, opacity;
  } truths[] = {{-1, 0.1},
                {0, 0.1},
                {0.1, 0.10099171316672413},
                {0.3, 0.5},
                {0.5, 0.84759279343113},
                {0.9, 0.8999857193860011},
                {1, 0.9},
                {1.5, 0.775},
                {2, 0.65},
                {2.4, 0.55},
                {2.9, 0.2583333333333334},
                {3.1, 0.2},
                {3.2, 0.2},
                {3.25, 0.6},
                {3.3, 0.6},
                {4.2, 0.5999842466231501},
                {4.5, 0.3},
                {4.8, 1.5753376849909622e-05},
                {5, 0},
                {6, 0}};
  for (const auto& truth : truths) {
    const double exact = -std::log1p(-truth.opacity);
    EXPECT_NEAR(f.evaluate(truth.x).extinction, exact, 1e-4 * std::max(exact, 0.01) + 1e-15) << "at " << truth.x;
  }
  EXPECT_LE(f.knots().size(), 600u);
}

TEST(ParaViewColorMap, StepsOfColourAndOpacityAreKept) {
  const auto f = parse(R"({"RGBPoints": [0, 1, 0, 0, 2, 1, 0, 0, 2, 0, 0, 1, 4, 0, 0, 1],
                           "Points": [0, 0.5, 0.5, 0, 3, 0.5, 0.5, 0, 3, 0, 0.5, 0, 4, 0, 0.5, 0]})")
                     .function;
  EXPECT_EQ(f.evaluate(std::nextafter(2.0, 0)).color.x, 1);
  EXPECT_EQ(f.evaluate(2).color.x, 0);
  EXPECT_NEAR(f.evaluate(std::nextafter(3.0, 0)).extinction, std::log(2.0), 1e-15);
  EXPECT_EQ(f.evaluate(3).extinction, 0);
  EXPECT_EQ(f.knots().size(), 6u);
}

TEST(ParaViewColorMap, UnitDistanceIsTheUsersThenTheFilesThenTheDefault) {
  const std::string points = ", \"Points\": [0, 0.5, 0.5, 0, 2, 0.5, 0.5, 0]";
  colormaps::TransferFunctionOptions options;
  options.default_unit_distance = 8;
  const auto without = parse(map("RGB", points), options);
  EXPECT_EQ(without.unit_distance_source, "default");
  EXPECT_NEAR(without.function.max_extinction(), std::log(2.0) / 8, 1e-15);
  const auto with = parse(map("RGB", points + ", \"ScalarOpacityUnitDistance\": 4"), options);
  EXPECT_EQ(with.unit_distance_source, "file");
  EXPECT_NEAR(with.function.max_extinction(), std::log(2.0) / 4, 1e-15);
  options.unit_distance = 2;
  const auto asked = parse(map("RGB", points + ", \"ScalarOpacityUnitDistance\": 4"), options);
  EXPECT_EQ(asked.unit_distance_source, "`unit_distance`");
  EXPECT_EQ(asked.unit_distance, 2);
  EXPECT_NEAR(asked.function.max_extinction(), std::log(2.0) / 2, 1e-15);
}

TEST(ParaViewColorMap, KeepsValuesUnlessRescaled) {
  colormaps::TransferFunctionOptions options;
  options.field_range = {100, 300};
  const std::string text = R"({"RGBPoints": [0,0,0,0, 1,1,1,1], "Points": [0,0,0.5,0, 4,0.5,0.5,0]})";
  const auto as_is = parse(text, options);
  EXPECT_EQ(as_is.function.knots().front().value, 0);
  EXPECT_EQ(as_is.function.knots().back().value, 4);
  EXPECT_NE(as_is.name.find("is outside"), std::string::npos) << as_is.name;

  options.rescale = true;
  const auto rescaled = parse(text, options);
  EXPECT_EQ(rescaled.function.knots().front().value, 100);
  EXPECT_EQ(rescaled.function.knots().back().value, 300);
  EXPECT_NE(rescaled.name.find("rescaled to 100 to 300"), std::string::npos) << rescaled.name;
  EXPECT_NEAR(colormaps::encode_srgb(rescaled.function.evaluate(200).color.x), 0.5, 1e-3);
  EXPECT_NEAR(rescaled.function.evaluate(200).extinction, -std::log(0.75), 1e-4);

  // A constant field gets the map's middle.
  options.field_range = {7, 7};
  const auto constant = parse(text, options);
  EXPECT_NEAR(constant.function.evaluate(7).extinction, -std::log(0.75), 1e-12);
  EXPECT_NEAR(colormaps::encode_srgb(constant.function.evaluate(7).color.x), 0.5, 1e-12);
}

TEST(ParaViewColorMap, WithoutPointsHasTheDefaultRampWithANote) {
  const auto loaded = parse(map("RGB"));
  EXPECT_NE(loaded.name.find("no Points"), std::string::npos) << loaded.name;
  EXPECT_GT(loaded.function.evaluate(0).extinction, 0);
  EXPECT_GT(loaded.function.evaluate(2).extinction, loaded.function.evaluate(0).extinction);
}

TEST(ParaViewColorMap, UsesTheFirstOfSeveralWithANote) {
  const auto loaded = parse(R"([{"Name": "A", "RGBPoints": [2,1,0,0]}, {"Name": "B", "RGBPoints": [2,0,1,0]}])");
  EXPECT_EQ(loaded.function.evaluate(2).color.x, 1);
  EXPECT_NE(loaded.name.find("'A'"), std::string::npos) << loaded.name;
  EXPECT_NE(loaded.name.find("first of 2 maps"), std::string::npos) << loaded.name;
}

TEST(ParaViewColorMap, SortsPointsAndClampsColoursAsVtkDoes) {
  const auto f = parse(R"({"RGBPoints": [4, 1.0000001, 0, 0,  2, -0.01, 1, 0]})").function;
  EXPECT_EQ(f.knots().front().color, glm::dvec3(0, 1, 0));
  EXPECT_EQ(f.knots().back().color, glm::dvec3(1, 0, 0));
}

TEST(ParaViewColorMap, RefusesBrokenFilesInOneLine) {
  const struct {
    std::string text;
    std::vector<std::string> parts;
  } cases[] = {
      {R"([{"RGBPoints": [0, 0, 0)", {"line 1, column", "not valid JSON"}},
      {"[\n {\"RGBPoints\": [0 0]}]", {"line 2, column"}},
      {"", {"not valid JSON"}},
      {"[]", {"empty list"}},
      {"[1]", {"not a colour map"}},
      {"{}", {"no RGBPoints"}},
      {R"({"RGBPoints": []})", {"no RGBPoints"}},
      {R"({"RGBPoints": 3})", {"RGBPoints is not a list"}},
      {R"({"RGBPoints": [0,0,0]})", {"has 3 numbers", "multiple of 4"}},
      {R"({"RGBPoints": [0,0,0,"x"]})", {"item 4 is not a finite number"}},
      {R"({"RGBPoints": [0,0,0,1e999]})", {"not valid JSON"}},
      {R"({"RGBPoints": [0,255,128,0]})", {"point 1", "not bytes"}},
      {R"({"RGBPoints": [0,0,0,0], "RGBPoints": [1,1,1,1]})", {"'RGBPoints' is given twice"}},
      {R"({"IndexedColors": [1,0,0], "Annotations": ["0","a"]})", {"only IndexedColors"}},
      {R"({"ColorSpace": "CMYK", "RGBPoints": [0,0,0,0]})", {"'CMYK' is unknown", "Diverging"}},
      {R"({"ColorSpace": 3, "RGBPoints": [0,0,0,0]})", {"ColorSpace is not a string"}},
      {R"({"RGBPoints": [0,0,0,0], "Points": [0,1.5,0.5,0]})", {"point 1 has opacity 1.5"}},
      {R"({"RGBPoints": [0,0,0,0], "Points": [0,-0.5,0.5,0]})", {"opacity -0.5"}},
      {R"({"RGBPoints": [0,0,0,0], "Points": [0,1,2,0]})", {"midpoint 2"}},
      {R"({"RGBPoints": [0,0,0,0], "Points": [0,1,0.5,-3]})", {"sharpness -3"}},
      {R"({"RGBPoints": [0,0,0,0], "ScalarOpacityUnitDistance": 0})", {"ScalarOpacityUnitDistance"}},
      {R"({"RGBPoints": [0,0,0,0], "ScalarOpacityUnitDistance": "1"})", {"ScalarOpacityUnitDistance"}},
      {std::string(100000, '['), {"levels deep"}},
      {"{\"\x01\xff\": 1}", {"not valid JSON"}},
  };
  for (const auto& bad : cases) {
    auto parts = bad.parts;
    parts.emplace_back("map.json: ");
    parts.emplace_back("; ");
    expect_bad_input([&] { parse(bad.text); }, parts);
  }
}

TEST(ParaViewColorMap, AForeignNameCannotBreakTheLine) {
  const auto loaded = parse("{\"Name\": \"a\\nb\\u001b[31m\", \"RGBPoints\": [2,0,0,0]}");
  EXPECT_EQ(loaded.name.find('\n'), std::string::npos);
  EXPECT_EQ(loaded.name.find('\x1b'), std::string::npos);
}

}  // namespace
}  // namespace tessera::io
