// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <filesystem>
#include <limits>

#include "colormaps/presets.hpp"
#include "io/scene/transfer_function_file.hpp"
#include "io/text/text_file.hpp"
#include "support/temporary_folder.hpp"

namespace tessera::io {
namespace {

using test::expect_bad_input;

scene::TransferFunction parse_function(std::string_view text, const colormaps::TransferFunctionOptions& options = {}) {
  return parse_text_transfer_function(text, "tf.txt", options).function;
}

TEST(TextTransferFunction, ReportsASystemFileThatCannotBeRead) {
  if (!std::filesystem::exists("/proc/self/mem")) GTEST_SKIP() << "no /proc/self/mem";
  test::expect_bad_input([] { read_text_file("/proc/self/mem"); }, {"cannot be read as text"});
}

// Reading a new pseudo-terminal, on which no program writes, once waited forever.
TEST(TextTransferFunction, RefusesADevice) {
  for (const char* device : {"/dev/ptmx", "/dev/zero", "/dev/full"})
    test::expect_bad_input([&] { read_text_file(device); }, {device, "neither a regular file nor a pipe"});
}

TEST(TextTransferFunction, UsesNumbersAsGiven) {
  const auto loaded = parse_text_transfer_function("0 0.1 0.2 0.3 0\n10 1 1.5 0 4\n", "tf.txt", {});
  ASSERT_EQ(loaded.function.knots().size(), 2u);
  EXPECT_EQ(loaded.function.knots()[0], (scene::Knot{0, {0.1, 0.2, 0.3}, 0}));
  EXPECT_EQ(loaded.function.knots()[1], (scene::Knot{10, {1, 1.5, 0}, 4}));
  EXPECT_FALSE(loaded.unit_distance);
  EXPECT_EQ(loaded.unit_distance_source, "");
}

TEST(TextTransferFunction, AllowsCommentsBlankLinesWindowsLinesAndAByteOrderMark) {
  const auto f = parse_function("\xEF\xBB\xBF# a comment\r\n\r\n  \t0 0 0 0 1 # and another\r\n+1e0\t1 1 1 .5");
  ASSERT_EQ(f.knots().size(), 2u);
  EXPECT_EQ(f.knots()[1], (scene::Knot{1, {1, 1, 1}, 0.5}));
}

TEST(TextTransferFunction, KeepsAStep) {
  const auto f = parse_function("0 0 0 0 1\n1 0 0 0 1\n1 1 1 1 5\n2 1 1 1 5\n");
  EXPECT_EQ(f.knots().size(), 4u);
  EXPECT_DOUBLE_EQ(f.evaluate(1).extinction, 5);
}

TEST(TextTransferFunction, OpacityScaleMultipliesExtinction) {
  colormaps::TransferFunctionOptions options;
  options.opacity_scale = 2.5;
  EXPECT_DOUBLE_EQ(parse_function("0 1 1 1 2\n", options).knots()[0].extinction, 5);
}

TEST(TextTransferFunction, RefusesLinesWithoutFiveNumbersNamingFileAndLine) {
  const std::string_view good = "0 0 0 0 1\n\n# c\n";  // the error is in line 4
  const struct {
    const char* line;
    std::vector<std::string> parts;
  } cases[] = {
      {"1 0 0 0", {"4 numbers instead of 5"}},
      {"1 0 0 0 1 2", {"6 numbers instead of 5"}},
      {"1", {"1 number instead"}},
      {"point 1 0 0 1", {"'point'", "not a finite number"}},
      {"1 0 0 0 nan", {"'nan'"}},
      {"1 0 0 0 inf", {"'inf'"}},
      {"1 0 0 0 1e999", {"'1e999'"}},
      {"1 0 0 0 1x", {"'1x'"}},
      {"1 0 0 0 0x10", {"'0x10'"}},
      {"1 0 0 0 -1", {"extinction is -1", "must not be negative"}},
      {"1 0 -0.5 0 1", {"green is -0.5"}},
      {"-1 0 0 0 1", {"value -1 is below the one before it, 0", "sort"}},
      {"1, 0, 0, 0, 1", {"comma"}},
      {"1 0,5 0 0 1", {"'0,5'", "comma", "point"}},
      {"\x01\xff 0 0 0 1",
       {"'?"
        "?'"}},
  };
  for (const auto& bad : cases) {
    auto parts = bad.parts;
    parts.insert(parts.end(), {"tf.txt: line 4: ", "; "});
    expect_bad_input([&] { parse_function(std::string(good) + bad.line + "\n"); }, parts);
  }
}

TEST(TextTransferFunction, RefusesAFileWithoutKnots) {
  expect_bad_input([] { parse_function(""); }, {"tf.txt: ", "no knot"});
  expect_bad_input([] { parse_function("# nothing\n\n"); }, {"tf.txt: ", "no knot"});
}

TEST(TextTransferFunction, ReportsThatAUnitDistanceDoesNotApply) {
  colormaps::TransferFunctionOptions options;
  options.unit_distance = 2;
  const auto loaded = parse_text_transfer_function("0 1 1 1 3\n", "tf.txt", options);
  EXPECT_EQ(loaded.function.max_extinction(), 3);
  EXPECT_NE(loaded.name.find("`unit_distance` does not apply"), std::string::npos) << loaded.name;
}

TEST(TextTransferFunction, RescalesOnRequest) {
  colormaps::TransferFunctionOptions options;
  options.field_range = {10, 30};
  options.rescale = true;
  const auto loaded = parse_text_transfer_function("0 1 1 1 0\n0.25 1 1 1 1\n1 1 1 1 2\n", "tf.txt", options);
  EXPECT_EQ(loaded.function.knots()[1].value, 15);
  EXPECT_EQ(loaded.function.knots()[2].value, 30);
  options.field_range = {5, 5};
  EXPECT_EQ(parse_text_transfer_function("0 1 1 1 0\n0.4 1 1 1 1\n1 1 1 1 2\n", "tf.txt", options)
                .function.evaluate(5)
                .extinction,
            1);
}

TEST(TransferFunctionFile, IsRecognizedByItsFirstCharacter) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(load_transfer_function(folder.write("a.json", "0 1 1 1 2\n"), {}).function.knots().size(), 1u);
  const auto map = load_transfer_function(folder.write("b.txt", "\n [{\"RGBPoints\": [2, 0, 0, 0, 4, 1, 1, 1]}]"), {});
  EXPECT_GT(map.function.knots().size(), 2u);
  const auto xml = folder.write("c.json", "<ColorMaps/>");
  expect_bad_input([&] { load_transfer_function(xml, {}); }, {"c.json: is XML", "export it as .json"});
}

TEST(TransferFunctionFile, RefusesNamesOfNeitherFilesNorPresets) {
  expect_bad_input([] { load_transfer_function("no-such-thing", {}); },
                   {"no-such-thing: no such file and no preset", "viridis", "cool-warm"});
  const test::TemporaryFolder folder;
  expect_bad_input([&] { load_transfer_function(folder.path(), {}); }, {"is a directory"});
  expect_bad_input([&] { load_transfer_function(folder.write("empty", ""), {}); }, {"no knot"});
}

TEST(TransferFunctionFile, RefusesAFileTooLargeToBeOne) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("large", "");
  std::filesystem::resize_file(file, 65u << 20);
  expect_bad_input([&] { load_transfer_function(file, {}); }, {"larger than 64 MiB"});
}

TEST(TransferFunctionOptions, AreChecked) {
  colormaps::TransferFunctionOptions options;
  options.unit_distance = -1;
  expect_bad_input([&] { colormaps::default_transfer_function(options); }, {"`unit_distance` is -1"});
  options = {};
  options.default_unit_distance = 0;
  expect_bad_input([&] { colormaps::default_transfer_function(options); }, {"unit distance is 0"});
  options = {};
  options.field_range = {2, 1};
  expect_bad_input([&] { colormaps::default_transfer_function(options); }, {"field range 2 to 1"});
  options = {};
  options.opacity_scale = std::numeric_limits<double>::quiet_NaN();
  expect_bad_input([&] { colormaps::default_transfer_function(options); }, {"opacity scale"});
}

}  // namespace
}  // namespace tessera::io
