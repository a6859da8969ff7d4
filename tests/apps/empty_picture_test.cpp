// SPDX-License-Identifier: BSD-3-Clause
// Images that show nothing: the reason is reported, and the suggested remedies help.
#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "apps/program.hpp"
#include "io/image/image_file.hpp"

namespace tessera::apps::empty_picture_test {
namespace {

using Names = std::vector<std::string>;

constexpr std::string_view empty = "the image is empty";

/// A bar of five hexahedra along (1, 0, 0), so thin that it contains no pixel centre, with the field x.
std::string bar(double thickness) {
  std::string points, values, cells;
  for (int i = 0; i <= 5; ++i)
    for (int corner = 0; corner < 4; ++corner) {
      const double y = (corner & 1) != 0 ? thickness : 0, z = (corner & 2) != 0 ? thickness : 0;
      points += std::to_string(i * 0.2) + " " + std::to_string(y) + " " + std::to_string(z) + " ";
      values += std::to_string(i * 0.2) + " ";
    }
  for (int i = 0; i < 5; ++i)
    for (const int corner : {0, 1, 3, 2, 4, 5, 7, 6}) cells += std::to_string(4 * i + corner) + " ";
  return "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\"><UnstructuredGrid>"
         "<Piece NumberOfPoints=\"24\" NumberOfCells=\"5\"><PointData><DataArray type=\"Float64\" Name=\"u\" "
         "format=\"ascii\">" +
         values +
         "</DataArray></PointData><Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">" +
         points + "</DataArray></Points><Cells><DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">" +
         cells +
         "</DataArray><DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">8 16 24 32 40</DataArray>"
         "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">12 12 12 12 12</DataArray></Cells></Piece>"
         "</UnstructuredGrid></VTKFile>\n";
}

/// The value after an option in a message.
std::string value_of(const std::string& option, const std::string& message) {
  const std::size_t at = message.find(option + " ");
  if (at == std::string::npos) return "";
  const std::size_t first = at + option.size() + 1;
  return message.substr(first, message.find_first_of(" ;\n", first) - first);
}

bool shows_something(const std::string& picture) {
  const Image image = io::read_image(picture);
  for (std::size_t i = 3; i < image.rgba.size(); i += 4)
    if (image.rgba[i] > 0.002f) return true;
  return false;
}

class EmptyPicture : public ::testing::Test {
 protected:
  Outcome render(const std::string& input, const Names& more, int ranks = 1) const {
    Names all = {"render", input, "-o", picture, "--size", "64x64"};
    for (std::size_t i = 0; i < more.size(); ++i)
      if (more[i] == "--size") all.resize(4);
    all.insert(all.end(), more.begin(), more.end());
    Outcome outcome = ranks == 1 ? tessera(all) : mpirun(ranks, all);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome;
  }
  /// Each of the options suggested by the warning shows something, without a warning.
  void expect_remedies(const std::string& input, const Names& words, const std::string& warning, const Names& options,
                       int ranks = 1) const {
    for (const std::string& option : options) {
      const std::string value = value_of(option, warning);
      ASSERT_FALSE(value.empty()) << option << ": " << warning;
      Names all = words;
      all.insert(all.end(), {option, value});
      const Outcome repaired = render(input, all, ranks);
      EXPECT_TRUE(shows_something(picture)) << option << ' ' << value;
      EXPECT_EQ(repaired.err.find(empty), std::string::npos) << repaired.err;
    }
  }

  Folder folder;
  std::string picture = folder / "a.exr";
  std::string cube = folder.cube();  // [-1, 1]^3
};

// Seen from the front, the bar is in the middle of the image, between pixel centres.
TEST_F(EmptyPicture, OfABarBetweenPixelsNamesSizeZoomAndScale) {
  const std::string mesh = folder.file("bar.vtu", bar(0.002));
  const Names words = {"--view", "front"};
  const Outcome outcome = render(mesh, words);
  EXPECT_FALSE(shows_something(picture));
  EXPECT_NE(outcome.err.find("tessera: warning: " + mesh + ": " + std::string(empty)), std::string::npos)
      << outcome.err;
  EXPECT_NE(outcome.err.find("so thin that it is between"), std::string::npos) << outcome.err;
  expect_remedies(mesh, words, outcome.err, {"--size", "--zoom", "--scale"});
}

TEST_F(EmptyPicture, OfDistantSpecksNamesACameraInFrontOfOne) {
  const std::string mesh = folder.file(
      "specks.vtu",
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\"><UnstructuredGrid><Piece "
      "NumberOfPoints=\"8\" NumberOfCells=\"2\"><PointData><DataArray type=\"Float64\" Name=\"u\" "
      "format=\"ascii\">0 1 2 3 4 5 6 7</DataArray></PointData><Points><DataArray type=\"Float64\" "
      "NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 0 1 0 0 0 1 1e7 1e7 1e7 10000001 1e7 1e7 1e7 10000001 1e7 "
      "1e7 1e7 10000001</DataArray></Points><Cells><DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">0 "
      "1 "
      "2 3 4 5 6 7</DataArray><DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">4 8</DataArray><DataArray "
      "type=\"UInt8\" Name=\"types\" format=\"ascii\">10 "
      "10</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>\n");
  const Outcome outcome = render(mesh, {});
  ASSERT_NE(outcome.err.find(empty), std::string::npos) << outcome.err;
  const std::size_t option = outcome.err.find("--camera");  // lines break anywhere
  const std::size_t open = outcome.err.find("'{", option), close = outcome.err.find("}'", open);
  ASSERT_NE(option, std::string::npos) << outcome.err;
  ASSERT_NE(open, std::string::npos) << outcome.err;
  ASSERT_NE(close, std::string::npos) << outcome.err;
  render(mesh, {"--camera", outcome.err.substr(open + 1, close - open)});
  EXPECT_TRUE(shows_something(picture));
}

TEST_F(EmptyPicture, OfAThinGridNamesRemediesToo) {
  const std::string grid = folder.file("g_2x2x2_uint8.raw", std::string("\0\1\2\3\4\5\6\7", 8));
  const Names words = {"--spacing", "1,0.002,0.002", "--view", "front"};
  const Outcome outcome = render(grid, words);
  EXPECT_NE(outcome.err.find("so thin that it is between"), std::string::npos) << outcome.err;
  expect_remedies(grid, words, outcome.err, {"--size", "--zoom", "--scale"});
}

TEST_F(EmptyPicture, IsReportedOnceByAllRanks) {
  if (!has_mpirun()) GTEST_SKIP() << "no mpirun";
  const std::string mesh = folder.file("bar.vtu", bar(0.002));
  const Names words = {"--view", "front"};
  const std::string alone = render(mesh, words).err, together = render(mesh, words, 2).err;
  EXPECT_NE(alone.find(empty), std::string::npos) << alone;
  for (const std::string option : {"--size", "--zoom", "--scale"})
    EXPECT_EQ(value_of(option, together), value_of(option, alone)) << together;
  EXPECT_EQ(together.find(empty), together.rfind(empty)) << together;
}

TEST_F(EmptyPicture, OfAViewPastTheDataIsFitted) {
  const std::string camera =
      folder.file("c.json", R"({"position": [50, 0, 9], "focal_point": [50, 0, 0], "parallel_scale": 2})");
  const std::string clipped = folder.file(
      "d.json", R"({"position": [0, 0, 9], "focal_point": [0, 0, 0], "parallel_scale": 2, "clipping_range": [1, 2]})");
  const std::string volume = folder.rectilinear();
  for (const std::string& input : {cube, volume}) {
    const Outcome outcome = render(input, {"--camera", camera});
    EXPECT_NE(outcome.err.find("nothing that the transfer function shows is in the view; --fit shows something"),
              std::string::npos)
        << outcome.err;
    const Outcome fitted = render(input, {"--camera", camera, "--fit"});
    EXPECT_TRUE(shows_something(picture));
    EXPECT_EQ(fitted.err.find(empty), std::string::npos) << fitted.err;
  }
  EXPECT_NE(render(cube, {"--camera", clipped}).err.find("a camera without its clipping_range"), std::string::npos);
}

TEST_F(EmptyPicture, OfAFunctionThatMissesTheDataNamesWhatMeetsThem) {
  const std::string far = folder.file("far.txt", "5 1 1 1 0\n6 1 1 1 3\n");
  const Outcome missed = render(cube, {"--transfer-function", far});
  EXPECT_NE(missed.err.find("the transfer function shows nothing"), std::string::npos) << missed.err;
  EXPECT_EQ(missed.err.find(empty), std::string::npos) << missed.err;  // reported only once
  EXPECT_EQ(render(cube, {"--transfer-function", far, "--rescale"}).err.find("shows nothing"), std::string::npos);
  EXPECT_TRUE(shows_something(picture));

  const Outcome range = render(cube, {"--transfer-function", "viridis:rise", "--range", "50,60"});
  EXPECT_NE(range.err.find("leave --range out, or give values that the field has"), std::string::npos) << range.err;
  EXPECT_NE(render(cube, {"--range", "50,60"}).err.find("leave --range out"), std::string::npos);
  const Outcome clear = render(cube, {"--transfer-function", "viridis", "--opacity-points", "0:0,1:0"});
  EXPECT_NE(clear.err.find("--opacity-points are all 0"), std::string::npos) << clear.err;
}

TEST_F(EmptyPicture, OfAPartWithoutVisibleValuesIsReported) {
  // One cell, with values from 0 to 1. The view shows only values that the function hides.
  const std::string volume = folder.file("v_2x2x2_uint8.raw", std::string("\0\1\0\1\0\1\0\1", 8));
  const std::string mesh = folder.file("thick.vtu", bar(1));
  const std::string function = folder.file("end.txt", "0.95 1 1 1 0\n1 1 1 1 9\n");
  const std::string at_0 = R"({"position": [0.1, 0.5, 9], "focal_point": [0.1, 0.5, 0], "view_up": [0, 1, 0], )"
                           R"("parallel_scale": 0.02})";
  const std::string at_8 = R"({"position": [0.82, 0.5, 9], "focal_point": [0.82, 0.5, 0], "view_up": [0, 1, 0], )"
                           R"("parallel_scale": 0.01})";
  for (const auto& [input, camera] : {std::pair(volume, at_0), std::pair(mesh, at_8)}) {
    const Outcome outcome = render(input, {"--transfer-function", function, "--camera", camera});
    EXPECT_NE(outcome.err.find("no ray meets a value that the transfer function shows"), std::string::npos)
        << outcome.err;
    render(input, {"--transfer-function", function});
    EXPECT_TRUE(shows_something(picture));
  }
}

TEST_F(EmptyPicture, OfAlmostNoOpacityNamesAScale) {
  const std::string faint = folder.file("f.txt", "0 1 1 1 1e-6\n1 1 1 1 1e-6\n");
  const Names words = {"--transfer-function", faint};
  const Outcome outcome = render(cube, words);
  EXPECT_NE(outcome.err.find("no pixel is more opaque than"), std::string::npos) << outcome.err;
  expect_remedies(cube, words, outcome.err, {"--opacity-scale"});
}

TEST_F(EmptyPicture, LightWithoutExtinctionIsNotEmpty) {
  const std::string light = folder.file("l.txt", "0 1 1 1 0\n1 1 1 1 0\n");
  const Outcome outcome = render(cube, {"--transfer-function", light, "--emission", "independent"});
  EXPECT_EQ(outcome.err.find("warning"), std::string::npos) << outcome.err;
  const Outcome surface = render(cube, {"--transfer-function", light, "--surface", "boundary"});
  EXPECT_EQ(surface.err.find("warning"), std::string::npos) << surface.err;
}

TEST_F(EmptyPicture, OfAFilmAreCounted) {
  const std::string mesh = folder.file("bar.vtu", bar(0.0005));
  const Outcome outcome =
      tessera({"render", mesh, "-o", folder / "f_%d.png", "--size", "32x32", "--orbit", "3", "--elevation", "20"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("3 of 3 images are empty, that of frame 1 because: "), std::string::npos) << outcome.err;
  const Outcome quiet = tessera({"render", mesh, "-o", folder / "q.png", "--size", "32x32", "--quiet"});
  EXPECT_NE(quiet.err.find("the image is empty"), std::string::npos) << quiet.err;
  EXPECT_EQ(quiet.error_lines(), 1u) << quiet.err;
}

}  // namespace
}  // namespace tessera::apps::empty_picture_test
