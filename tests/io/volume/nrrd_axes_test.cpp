// SPDX-License-Identifier: BSD-3-Clause
// NRRD headers: spaces, positions of samples, and axes that are not spatial.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"
#include "support/volume_bytes.hpp"
#include "support/volume_checks.hpp"

namespace tessera::io::nrrd_axes_test {
namespace {

using scene::GridIndex;
using test::all_samples;
using test::expect_no_volume;
using test::has_note;

class NrrdAxes : public ::testing::Test {
 protected:
  /// Samples 0, 1, 2 ... of int16.
  std::filesystem::path write(const std::string& about, std::size_t samples = 48) {
    return folder.write("a.nrrd", "NRRD0005\ntype: short\nencoding: raw\nendian: little\n" + about + "\n\n" +
                                      test::bytes_of(test::counting<std::int16_t>(samples)));
  }
  test::TemporaryFolder folder;
};

const std::string cube = "dimension: 3\nsizes: 4 3 2\n";
const std::string placed = cube + "space directions: (2,0,0) (0,3,0) (0,0,4)\nspace origin: (10,20,30)\nspace: ";

TEST_F(NrrdAxes, EveryNameOfASpaceHasItsDirections) {
  struct Space {
    const char* name;
    BodyAxes axes;
    glm::dvec3 first;  ///< world direction of the file's (1, 0, 0); the others likewise
    glm::dvec3 second, third;
  };
  const glm::dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  for (const Space& space : {Space{"right-anterior-superior", BodyAxes::ras, x, y, z},
                             Space{"RAS", BodyAxes::ras, x, y, z},
                             Space{"right-anterior-superior-time", BodyAxes::ras, x, y, z},
                             Space{"RAST", BodyAxes::ras, x, y, z},
                             Space{"left-posterior-superior", BodyAxes::lps, x, y, z},
                             Space{"lps", BodyAxes::lps, x, y, z},
                             Space{"LPST", BodyAxes::lps, x, y, z},
                             Space{"left-anterior-superior", BodyAxes::ras, -x, y, z},
                             Space{"left-anterior-superior-time", BodyAxes::ras, -x, y, z},
                             Space{"LAS", BodyAxes::ras, -x, y, z},
                             Space{"LAST", BodyAxes::ras, -x, y, z},
                             Space{"RPS", BodyAxes::ras, x, -y, z},
                             Space{"right-anterior-inferior", BodyAxes::ras, x, y, -z},
                             Space{"posterior-superior-right", BodyAxes::ras, -y, z, x},
                             Space{"scanner-xyz", BodyAxes::none, x, y, z},
                             Space{"scanner-xyz-time", BodyAxes::none, x, y, z},
                             Space{"3D-right-handed", BodyAxes::none, x, y, z},
                             Space{"3D-right-handed-time", BodyAxes::none, x, y, z},
                             Space{"3D-left-handed", BodyAxes::none, -x, y, z},
                             Space{"3D-left-handed-time", BodyAxes::none, -x, y, z}}) {
    const VolumeFile volume = open_volume(write(placed + space.name));
    EXPECT_EQ(volume.body_axes, space.axes) << space.name;
    const glm::dmat3 turn(space.first, space.second, space.third);
    const glm::dvec3 wanted = turn * glm::dvec3(10 + 2 * 3, 20 + 3 * 2, 30 + 4);
    const glm::dvec3 found = scene::world_of_index(volume.source->geometry(), {3, 2, 1});
    EXPECT_LT(glm::length(found - wanted), 1e-12) << space.name << ": " << found.x << ' ' << found.y << ' ' << found.z;
    EXPECT_EQ(has_note(volume, "converted"), turn != glm::dmat3(1.0)) << space.name;
  }
  const VolumeFile odd = open_volume(write(placed + "left-left-superior"));
  EXPECT_EQ(odd.body_axes, BodyAxes::none);
  EXPECT_TRUE(has_note(odd, "'left-left-superior' is unknown"));
}

TEST_F(NrrdAxes, MinimumsAndMaximumsPlaceSamplesByTheirCentering) {
  const auto geometry = [&](const std::string& about) {
    return open_volume(write("dimension: 3\nsizes: 4 3 4\n" + about)).source->geometry();
  };
  const scene::GridGeometry nodes = geometry("axis mins: 1 2 3\naxis maxs: 4 3 9");
  EXPECT_EQ(nodes.spacing, glm::dvec3(1, 0.5, 2));
  EXPECT_EQ(nodes.origin, glm::dvec3(1, 2, 3));
  const scene::GridGeometry cells = geometry("axis mins: 1 2 3\naxis maxs: 5 8 9\ncenters: cell node cell");
  EXPECT_EQ(cells.spacing, glm::dvec3(1, 3, 1.5));
  EXPECT_EQ(cells.origin, glm::dvec3(1.5, 2, 3.75));
  const scene::GridGeometry falling = geometry("axis mins: 4 0 0\naxis maxs: 1 1 1");
  EXPECT_EQ(falling.direction[0], glm::dvec3(-1, 0, 0));
  EXPECT_EQ(scene::world_of_index(falling, {3, 0, 0}).x, 1);
  const scene::GridGeometry ends = geometry("spacings: 2 nan 1\naxis maxs: 7 nan nan\naxis mins: nan nan 5");
  EXPECT_EQ(ends.spacing, glm::dvec3(2, 1, 1));
  EXPECT_EQ(ends.origin, glm::dvec3(1, 0, 5));
}

TEST_F(NrrdAxes, ImagesOfFourDimensionsAsItkWritesThemAreTimeSteps) {
  const std::string itk =
      "dimension: 4\nspace dimension: 4\nsizes: 4 3 2 2\nspace directions: (2,0,0,0) (0,3,0,0) (0,0,4,0) (0,0,0,1)\n"
      "kinds: domain domain domain domain\nspace origin: (10,20,30,0)";
  const VolumeFile last = open_volume(write(itk));
  EXPECT_EQ(last.source->geometry().points, (GridIndex{4, 3, 2}));
  EXPECT_EQ(last.source->geometry().spacing, glm::dvec3(2, 3, 4));
  EXPECT_EQ(last.source->geometry().origin, glm::dvec3(10, 20, 30));
  EXPECT_EQ(last.time_step.count, 2);
  EXPECT_EQ(all_samples(*last.source).front(), 24);
  EXPECT_EQ(all_samples(*open_volume(write(itk), {.time_step = 0}).source).front(), 0);
  const std::string vectors =
      "dimension: 5\nspace dimension: 4\nsizes: 2 4 3 2 1\nspace directions: none (1,0,0,0) (0,1,0,0) (0,0,1,0) "
      "(0,0,0,1)\nkinds: vector domain domain domain domain";
  EXPECT_EQ(all_samples(*open_volume(write(vectors), {.field = "samples:1"}).source)[2], 5);
}

TEST_F(NrrdAxes, TimesOfASpaceWithTimeAreThoseOfTheFourthDimension) {
  const auto times = [&](const std::string& about) {
    return open_volume(write("dimension: 4\nsizes: 4 3 2 2\n" + about)).time_step.times;
  };
  const std::string directions = "space directions: (2,0,0,0) (0,3,0,0) (0,0,4,0) ";
  for (const char* space : {"space: scanner-xyz-time\n", "space: RAST\n", "space dimension: 4\n"}) {
    EXPECT_EQ(times(space + directions + "(0,0,0,0.25)\nspace origin: (10,20,30,1.5)"), (std::vector{1.5, 1.75}));
    EXPECT_EQ(times(space + directions + "(0,0,0,0.25)"), (std::vector{0, 0.25}));
    EXPECT_TRUE(times(space + directions + "none").empty());
  }
  EXPECT_TRUE(times("space: RAST\nkinds: space space space list\n" + directions + "(0,0,0,0.25)").empty());
}

TEST_F(NrrdAxes, KindsAndDirectionsDistinguishListsComponentsAndTime) {
  const auto open = [&](const std::string& about, const ReadOptions& options = {}) {
    return open_volume(write(about), options);
  };
  const std::string last = "dimension: 4\nsizes: 4 3 2 2\nkinds: space space space ";
  for (const char* kind : {"time", "list"}) {
    EXPECT_EQ(open(last + kind).time_step.count, 2) << kind;
    EXPECT_EQ(all_samples(*open(last + kind, {.time_step = 1}).source).front(), 24) << kind;
  }
  const VolumeFile planar = open(last + "vector", {.field = "samples:1"});
  EXPECT_EQ(planar.fields.front().components, 2);
  EXPECT_EQ(all_samples(*planar.source)[1], 25);
  const VolumeFile unstated = open("dimension: 4\nsizes: 2 4 3 2\n");
  EXPECT_EQ(unstated.fields.front().components, 2);
  EXPECT_TRUE(has_note(unstated, "the first of its 4 axes, with 2 samples, is used as components"));
  const std::string first = "dimension: 4\nsizes: 2 4 3 2\nkinds: ";
  EXPECT_EQ(open(first + "list domain domain domain").time_step.count, 2);
  EXPECT_EQ(open(first + "2-vector space space space").fields.front().components, 2);
  // An axis of one sample has no role, even if it is between other axes.
  EXPECT_EQ(open("dimension: 4\nsizes: 4 1 6 2\nkinds: domain list domain domain").source->geometry().points,
            (GridIndex{4, 6, 2}));
  expect_no_volume(write("dimension: 4\nsizes: 4 2 3 2\nkinds: domain list domain domain"),
                   "axis 2 of 4, with 2 samples, is between the axes of space");
  expect_no_volume(write("dimension: 5\nsizes: 2 2 3 2 2\nkinds: time domain domain domain vector"),
                   "components must be its first axis");
}

TEST_F(NrrdAxes, UnitsModalityAndLabelsAreKnownFromFieldsAndKeys) {
  const VolumeFile volume = open_volume(
      write(placed + "LPS\nspace units: \"mm\" \"mm\" \"mm\"\nsample units: \"HU\"\nmodality:=CT\nintent:=label"));
  EXPECT_EQ(volume.tags, (VolumeTags{"CT", "HU", "mm", true}));
  EXPECT_TRUE(open_volume(write(placed + "LPS\nSegment0_LabelValue:=1")).tags.labels);
  EXPECT_EQ(open_volume(write(placed + "LPS")).tags, VolumeTags());
}

TEST_F(NrrdAxes, HeadersThatLackSomethingAreNotCalledDamaged) {
  expect_no_volume(write(cube + "space dimension: 2\nspace directions: (2,0) (0,3) none"),
                   "its space has two dimensions");
  const std::string about = "NRRD0004\ntype: short\nencoding: raw\n" + cube + "\n";
  expect_no_volume(folder.write("b.nrrd", about + test::bytes_of(test::counting<std::int16_t>(24))),
                   "add a line 'endian: little'");
}

}  // namespace
}  // namespace tessera::io::nrrd_axes_test
