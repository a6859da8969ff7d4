// SPDX-License-Identifier: BSD-3-Clause
#include "io/scene/json_transfer_function.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "colormaps/presets.hpp"
#include "io/scene/transfer_function_file.hpp"
#include "support/temporary_folder.hpp"

namespace tessera::io {
namespace {

using test::expect_bad_input;
using test::TemporaryFolder;

scene::TransferFunction stepped() {
  return scene::TransferFunction({{-1e-300, {0.1, 1.0 / 3, 7}, 0},
                                  {0.1, {0, 0, 0}, 1e-17},
                                  {0.1, {0.7, 0.2, 0.1}, 123456.789},
                                  {2e30, {1, 1, 1}, 0.3}});
}

bool same(const scene::TransferFunction& a, const scene::TransferFunction& b) {
  return std::ranges::equal(a.knots(), b.knots());
}

TEST(JsonTransferFunction, ReadsBackBitByBit) {
  EXPECT_TRUE(same(parse_json_transfer_function(knots_json(stepped()), "f", {}).function, stepped()));
  const auto preset = colormaps::preset("viridis:peaks", {}).function;
  EXPECT_TRUE(same(parse_json_transfer_function(knots_json(preset), "f", {}).function, preset));
}

TEST(JsonTransferFunction, TakesTheOptionsOfFilesOfExtinctions) {
  colormaps::TransferFunctionOptions options;
  options.opacity_scale = 2;
  options.range = {{10, 20}};
  const auto loaded =
      parse_json_transfer_function(R"({"knots": [[0, 0, 0, 0, 1], [1, 1, 0.5, 0, 3]]})", "f.json", options);
  ASSERT_EQ(loaded.function.knots().size(), 2u);
  EXPECT_EQ(loaded.function.knots()[0], (scene::Knot{10, {0, 0, 0}, 2}));
  EXPECT_EQ(loaded.function.knots()[1], (scene::Knot{20, {1, 0.5, 0}, 6}));
  EXPECT_FALSE(loaded.unit_distance);
  options.opacity_points = {{0, 0}, {1, 1}};
  expect_bad_input([&] { parse_json_transfer_function(R"({"knots": [[0, 0, 0, 0, 1]]})", "f.json", options); },
                   {"f.json: contains extinctions", "`opacity_points`"});
}

TEST(JsonTransferFunction, RefusesInvalidFunctionsAndNamesTheKnot) {
  const struct {
    const char* text;
    std::vector<std::string> parts;
  } cases[] = {
      {R"({"knots": 3})", {"f: knots is not a list of knots"}},
      {R"({"knots": []})", {"f: knots is not a list of knots"}},
      {R"({"knots": [[0, 1, 1, 1, 1], [1, 1, 1, 1]]})", {"f: knot 2 is not a list of 5 numbers"}},
      {R"({"knots": [[0, 1, "x", 1, 1]]})", {"f: knot 1: its green is not a finite number"}},
      {R"({"knots": [[0, 1, 1, -1, 1]]})", {"f: knot 1: its blue is -1, but must not be negative; give 0 or more"}},
      {R"({"knots": [[2, 1, 1, 1, 1], [1, 1, 1, 1, 1]]})", {"f: knot 2: its value 1 is below the one before it, 2"}},
      {R"({"knots": [[0, 1, 1, 1, 1]], "range": [0, 1]})", {"f: 'range' is unknown next to knots"}},
      {R"({"knots": [[0, 1, 1, 1, 1])", {"f: line 1, column", "not valid JSON"}},
      {R"({"colors": []})", {"f: has no RGBPoints"}},
  };
  for (const auto& c : cases) expect_bad_input([&] { parse_json_transfer_function(c.text, "f", {}); }, c.parts);
}

TEST(JsonTransferFunction, IsAcceptedInsteadOfAName) {
  const auto loaded = load_transfer_function(knots_json(stepped()), {});
  EXPECT_TRUE(same(loaded.function, stepped()));
  EXPECT_EQ(loaded.name, "JSON");
  const auto map = load_transfer_function(
      R"([{"Name": "mine", "RGBPoints": [0,0,0,0, 1,1,1,1], "Points": [0,0,0.5,0, 1,1,0.5,0]}])", {});
  EXPECT_EQ(map.name, "JSON 'mine'");
  expect_bad_input([] { load_transfer_function("{\"knots\": 1}", {}); }, {"`transfer_function`: knots is not a list"});
  expect_bad_input([] { load_transfer_function("[", {}); }, {"`transfer_function`: line 1, column"});
  const TemporaryFolder folder;
  folder.write("f.json", knots_json(stepped()));
  EXPECT_TRUE(same(load_transfer_function((folder / "f.json").string(), {}).function, stepped()));
}

/// Largest differences of colours, and relative ones of extinctions, between two functions.
struct Off {
  double color = 0, extinction = 0;
};
Off difference(const scene::TransferFunction& a, const scene::TransferFunction& b, double unit_distance) {
  const double low = a.knots().front().value, high = a.knots().back().value;
  std::mt19937_64 random(7);
  Off off;
  for (int i = 0; i < 100000; ++i) {
    const double s = std::uniform_real_distribution(low, high)(random);
    const scene::Knot p = a.evaluate(s), q = b.evaluate(s);
    for (int c = 0; c < 3; ++c) off.color = std::max(off.color, std::abs(p.color[c] - q.color[c]));
    off.extinction =
        std::max(off.extinction, std::abs(p.extinction - q.extinction) / std::max(p.extinction, 0.01 / unit_distance));
  }
  return off;
}

TEST(ParaViewJson, ReadsBackNearly) {
  for (const char* name : {"cool-warm:rise", "viridis:peaks", "turbo:surface", "inferno:ends"}) {
    const auto function = colormaps::preset(name, {}).function;
    const auto back = parse_json_transfer_function(color_map_json(function, 0.5, name), "f", {});
    const Off off = difference(function, back.function, 0.5);
    EXPECT_LT(off.color, 2.5e-4) << name;
    EXPECT_LT(off.extinction, 2.5e-4) << name;
    EXPECT_EQ(back.unit_distance, 0.5);
    EXPECT_EQ(back.name, std::string("f '") + name + "'");
  }
}

TEST(ParaViewJson, KeepsStepsAndShortensTheUnitDistanceOfDenseFunctions) {
  const scene::TransferFunction dense({{0, {1, 0, 0}, 1}, {1, {1, 0, 0}, 1}, {1, {0, 0, 1}, 1e6}, {2, {0, 1, 1}, 1e5}});
  const auto back = parse_json_transfer_function(color_map_json(dense, 100, "dense"), "f", {});
  ASSERT_TRUE(back.unit_distance);
  EXPECT_LT(*back.unit_distance, 1e-5);
  EXPECT_NEAR(back.function.evaluate(std::nextafter(1, 0)).extinction, 1, 2e-4);
  EXPECT_NEAR(back.function.evaluate(1).extinction, 1e6, 200);
  EXPECT_NEAR(back.function.evaluate(1.5).extinction, 5.5e5, 200);
  EXPECT_EQ(back.function.evaluate(std::nextafter(1, 0)).color, glm::dvec3(1, 0, 0));
  EXPECT_EQ(back.function.evaluate(1).color, glm::dvec3(0, 0, 1));
}

TEST(ParaViewJson, RefusesAnInvalidLength) {
  for (const double length : {0.0, -1.0, std::nan(""), HUGE_VAL})
    expect_bad_input([&] { color_map_json(stepped(), length, "f"); }, {"`unit_distance`", "a length above 0"});
  expect_bad_input([&] { color_map_json({}, 1, "f"); }, {"no knot"});
}

}  // namespace
}  // namespace tessera::io
