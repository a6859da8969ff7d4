// SPDX-License-Identifier: BSD-3-Clause
#include "colormaps/presets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "colormaps/color_spaces.hpp"
#include "io/scene/transfer_function_file.hpp"
#include "support/temporary_folder.hpp"

namespace tessera::io {
namespace {

using test::expect_bad_input;

constexpr std::array<const char*, 7> variants{"ramp", "inverse", "ends", "peaks", "rise", "surface", "flat"};

double opacity(const colormaps::LoadedTransferFunction& loaded, double s) {
  return -std::expm1(-loaded.function.evaluate(s).extinction * loaded.unit_distance.value());
}

TEST(Presets, AreAtLeastEightEachWithSixOpacities) {
  const auto names = colormaps::preset_names();
  EXPECT_GE(names.size(), 8u);
  colormaps::TransferFunctionOptions options;
  options.field_range = {-3, 12};
  for (const std::string& name : names)
    for (const char* variant : variants) {
      const auto loaded = colormaps::preset(name + ":" + variant, options);
      EXPECT_EQ(loaded.name, name + ":" + variant);
      EXPECT_EQ(loaded.function.knots().front().value, -3);
      EXPECT_EQ(loaded.function.knots().back().value, 12);
      EXPECT_GT(loaded.function.max_extinction(), 0);
      EXPECT_LE(loaded.function.max_color(), 1);
      EXPECT_LE(loaded.function.knots().size(), 300u) << loaded.name;
    }
}

TEST(Presets, TakeTheirUnitDistanceFromTheUserBeforeTheDefault) {
  colormaps::TransferFunctionOptions options;
  options.default_unit_distance = 5;
  const auto otherwise = colormaps::preset("viridis:flat", options);
  EXPECT_EQ(otherwise.unit_distance_source, "default");
  EXPECT_EQ(otherwise.unit_distance, 5);
  EXPECT_NEAR(otherwise.function.evaluate(0.5).extinction, -std::log(0.9) / 5, 1e-12);
  options.unit_distance = 0.5;
  const auto asked = colormaps::preset("viridis:flat", options);
  EXPECT_EQ(asked.unit_distance_source, "`unit_distance`");
  EXPECT_NEAR(asked.function.evaluate(0.5).extinction, -std::log(0.9) / 0.5, 1e-12);
}

TEST(Presets, HaveThePublishedColours) {
  // viridis at its ends and middle, from its published table.
  const auto f = colormaps::preset("viridis", {}).function;
  const glm::dvec3 low = colormaps::encode_srgb(f.evaluate(0).color),
                   middle = colormaps::encode_srgb(f.evaluate(0.5).color),
                   high = colormaps::encode_srgb(f.evaluate(1).color);
  const auto expect_near = [](const glm::dvec3& c, double r, double g, double b) {
    EXPECT_NEAR(c.x, r, 2e-3);  // the stops are rounded to 1e-4; knots may deviate by 5e-4 of linear light
    EXPECT_NEAR(c.y, g, 2e-3);
    EXPECT_NEAR(c.z, b, 2e-3);
  };
  expect_near(low, 0.26700401, 0.00487433, 0.32941519);
  expect_near(middle, 0.128087, 0.565107, 0.550924);
  expect_near(high, 0.99324789, 0.90615657, 0.1439362);
}

TEST(Presets, LightnessOfPerceptualPresetsRises) {
  for (const char* name : {"viridis", "plasma", "inferno", "magma", "cividis", "black-body", "gray"}) {
    const auto f = colormaps::preset(name, {}).function;
    double before = -1;
    for (int i = 0; i <= 100; ++i) {
      const glm::dvec3 c = f.evaluate(i / 100.0).color;
      const double luminance = 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
      EXPECT_GT(luminance, before) << name << " at " << i / 100.0;
      before = luminance;
    }
  }
}

TEST(Presets, ColoursOfDisplayBlendingStayUndecoded) {
  colormaps::TransferFunctionOptions options;
  const glm::dvec3 decoded = colormaps::preset("gray", options).function.evaluate(0.5).color;
  options.display_colors = true;
  const glm::dvec3 display = colormaps::preset("gray", options).function.evaluate(0.5).color;
  EXPECT_NEAR(display.x, colormaps::encode_srgb(decoded.x), 1e-3);
  EXPECT_GT(display.x, 0.4);
}

TEST(Presets, RefuseAnUnknownVariantWithTheListOfThem) {
  EXPECT_TRUE(colormaps::is_preset("viridis"));
  EXPECT_TRUE(colormaps::is_preset("viridis:peak"));
  EXPECT_FALSE(colormaps::is_preset("./viridis"));
  EXPECT_FALSE(colormaps::is_preset("Viridis"));
  EXPECT_FALSE(colormaps::is_preset(""));
  expect_bad_input([] { load_transfer_function("viridis:peak", {}); }, {"'viridis:peak'", "peaks", "surface"});
}

TEST(DefaultTransferFunction, IsNeitherTransparentNorOpaqueAnywhere) {
  // Rays through a mesh whose diagonal is twenty unit distances: a short ray crosses a tenth of the diagonal, a usual
  // ray half of it.
  colormaps::TransferFunctionOptions options;
  options.field_range = {1e-3, 7e5};
  options.default_unit_distance = 0.3;
  const auto loaded = colormaps::default_transfer_function(options);
  EXPECT_EQ(loaded.unit_distance_source, "default");
  for (int i = 0; i <= 20; ++i) {
    const double s = std::lerp(options.field_range[0], options.field_range[1], i / 20.0);
    const double clear = 1 - opacity(loaded, s);
    EXPECT_GT(1 - std::pow(clear, 10), 0.25) << s;  // half the diagonal
    EXPECT_LT(1 - std::pow(clear, 2), 0.4) << s;    // a tenth
    const glm::dvec3 c = loaded.function.evaluate(s).color;
    EXPECT_GT(std::max({c.x, c.y, c.z}), 0.3) << "not black at " << s;
  }
  const double middle = 1 - std::pow(1 - opacity(loaded, 3.5e5), 10);
  EXPECT_GT(middle, 0.5);
  EXPECT_LT(middle, 0.9);
}

TEST(DefaultTransferFunction, ShowsAConstantField) {
  colormaps::TransferFunctionOptions options;
  options.field_range = {4, 4};
  const auto loaded = colormaps::default_transfer_function(options);
  const scene::Knot knot = loaded.function.evaluate(4);
  EXPECT_NEAR(opacity(loaded, 4), 0.1, 1e-12);
  EXPECT_GT(knot.color.x, 0.5);
  for (const std::string& name : colormaps::preset_names())
    for (const char* variant : variants)
      EXPECT_NEAR(opacity(colormaps::preset(name + ":" + variant, options), 4), 0.1, 1e-12) << name << variant;
}

TEST(DefaultTransferFunction, SurvivesRangesAtTheEndsOfDoubles) {
  for (const auto& range :
       {std::array{-1.7e308, 1.7e308}, std::array{0.0, 5e-324}, std::array{7e6, std::nextafter(7e6, 8e6)},
        std::array{1e-320, 1e300}, std::array{-1e-300, 1e-300}}) {
    colormaps::TransferFunctionOptions options;
    options.field_range = range;
    const auto f = colormaps::default_transfer_function(options).function;
    EXPECT_GT(f.evaluate(range[0]).extinction, 0);
    if (range[1] - range[0] < std::numeric_limits<double>::min())  // one value: the upper end of a step
      EXPECT_EQ(f.evaluate(range[0]).extinction, f.knots().back().extinction);
    else
      EXPECT_GT(f.evaluate(range[1]).extinction, f.evaluate(range[0]).extinction);
  }
}

}  // namespace
}  // namespace tessera::io
