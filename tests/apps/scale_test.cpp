// SPDX-License-Identifier: BSD-3-Clause
// `--scale`, given and chosen automatically.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "apps/program.hpp"
#include "cells/axis_scale.hpp"
#include "scene/scaled_source.hpp"

namespace tessera::apps::scale_test {
namespace {

using Names = std::vector<std::string>;

/// Classic NetCDF ("The NetCDF Classic Format Specification") of one field of floats over axes of doubles.
class ClassicNetcdf {
 public:
  struct Axis {
    std::string name, units;
    std::vector<double> values;
  };
  static std::string of(const std::vector<Axis>& axes) {
    ClassicNetcdf file;
    file.text_ = "CDF\1";
    file.number(0);
    file.number(10), file.number(static_cast<std::uint32_t>(axes.size()));
    for (const Axis& axis : axes) file.name(axis.name), file.number(static_cast<std::uint32_t>(axis.values.size()));
    file.number(0), file.number(0);
    file.number(11), file.number(static_cast<std::uint32_t>(axes.size() + 1));
    std::vector<std::size_t> begins;
    std::size_t samples = 1;
    for (std::uint32_t k = 0; k < axes.size(); ++k) {
      samples *= axes[k].values.size();
      file.name(axes[k].name), file.number(1), file.number(k);
      file.number(12), file.number(1), file.name("units"), file.number(2);
      file.name(axes[k].units);
      file.number(6), file.number(static_cast<std::uint32_t>(8 * axes[k].values.size()));
      begins.push_back(file.text_.size()), file.number(0);
    }
    file.name("thetao"), file.number(static_cast<std::uint32_t>(axes.size()));
    for (std::uint32_t k = 0; k < axes.size(); ++k) file.number(k);
    file.number(0), file.number(0), file.number(5), file.number(static_cast<std::uint32_t>(4 * samples));
    begins.push_back(file.text_.size()), file.number(0);
    for (std::size_t k = 0; k < axes.size(); ++k) {
      file.set(begins[k], static_cast<std::uint32_t>(file.text_.size()));
      for (const double value : axes[k].values) {
        const auto bits = std::bit_cast<std::uint64_t>(value);
        file.number(static_cast<std::uint32_t>(bits >> 32)), file.number(static_cast<std::uint32_t>(bits));
      }
    }
    file.set(begins.back(), static_cast<std::uint32_t>(file.text_.size()));
    for (std::size_t k = 0; k < samples; ++k) file.number(std::bit_cast<std::uint32_t>(static_cast<float>(k % 7)));
    return file.text_;
  }

 private:
  void number(std::uint32_t value) {
    for (const int shift : {24, 16, 8, 0}) text_ += static_cast<char>(value >> shift & 0xff);
  }
  void set(std::size_t at, std::uint32_t value) {
    for (const int shift : {24, 16, 8, 0}) text_[at++] = static_cast<char>(value >> shift & 0xff);
  }
  void name(const std::string& word) {
    number(static_cast<std::uint32_t>(word.size()));
    text_ += word;
    text_.resize((text_.size() + 3) / 4 * 4, '\0');
  }
  std::string text_;
};

std::string bounds_of(const Names& arguments) {
  const Outcome info = tessera(arguments);
  EXPECT_EQ(info.status, 0) << info.err;
  const std::size_t at = info.out.find("bounds    ");
  return at == std::string::npos ? info.out : info.out.substr(at + 10, info.out.find(", diag", at) - at - 10);
}

TEST(Scale, IsOfMeshesAndVolumesAndWrittenByConvert) {
  const Folder folder;
  const std::string cube = folder.cube(), volume = folder.rectilinear();
  EXPECT_EQ(bounds_of({"info", cube, "--scale", "1,2,0.5"}), "(-1 -2 -0.5) to (1 2 0.5)");
  const std::string scaled = folder / "scaled.vtu";
  ASSERT_EQ(tessera({"convert", cube, scaled, "--scale", "1,2,0.5", "--quiet"}).status, 0);
  EXPECT_EQ(bounds_of({"info", scaled}), "(-1 -2 -0.5) to (1 2 0.5)");

  const std::string grid = folder.file("g_2x2x2_uint8.raw", std::string("\0\1\2\3\4\5\6\7", 8));
  EXPECT_EQ(bounds_of({"info", grid, "--origin", "1,1,1", "--scale", "1,10,0.5"}), "(1 10 0.5) to (2 20 1)");
  for (const std::string& input : {cube, volume}) {
    const Outcome verified =
        tessera({"render", input, "-o", folder / "a.exr", "--size", "40x40", "--scale", "1,3,0.2", "--verify", "800"});
    EXPECT_EQ(verified.status, 0) << verified.err << verified.out;
  }
}

TEST(Scale, OfAnObliqueGridMovesItsCornersAsTheWorldsAxesDo) {
  GridGeometry grid;
  grid.points = {2, 3, 4};
  grid.origin = {1, 2, 3};
  grid.spacing = {1, 2, 3};
  grid.direction[0] = {0.6, 0.8, 0}, grid.direction[1] = {-0.8, 0.6, 0};
  const glm::dvec3 scale(2, 5, 0.1);
  const GridGeometry scaled = scene::scaled(grid, scale);
  for (const glm::dvec3 index : {glm::dvec3(0), glm::dvec3(1, 0, 0), glm::dvec3(1, 2, 3), glm::dvec3(0.5, 1.5, 2)}) {
    const glm::dvec3 wanted = world_of_index(grid, index) * scale, place = world_of_index(scaled, index);
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(place[axis], wanted[axis], 1e-12);
  }
}

TEST(Scale, RefusesInvalidFactors) {
  const Folder folder;
  for (const std::string word : {"1,2", "1,0,1", "1,-1,1", "x"}) {
    const Outcome outcome = tessera({"info", folder.cube(), "--scale", word});
    EXPECT_EQ(outcome.status, 2) << word;
    EXPECT_EQ(outcome.err.find("tessera: --scale: "), 0u) << outcome.err;
  }
}

TEST(Scale, IsChosenForDegreesWithMetresAndNoted) {
  const Folder folder;
  const std::vector<double> few = {0, 1, 2}, deep = {0, 1000, 2500, 4000};
  const auto file = [&](const std::string& name, const std::vector<double>& levels) {
    return folder.file(name, ClassicNetcdf::of({{"depth", "m", levels},
                                                {"lat", "degrees_north", few},
                                                {"lon", "degrees_east", {10, 11, 12, 13, 14}}}));
  };
  const std::string ocean = file("ocean.nc", deep), shallow = file("shallow.nc", {0, 1, 2, 3});
  const Outcome chosen = tessera({"info", ocean});
  if (chosen.err.find("tessera-read-vtk") != std::string::npos) GTEST_SKIP() << chosen.err;
  EXPECT_NE(chosen.out.find("z is multiplied by 0.0002"), std::string::npos) << chosen.out << chosen.err;
  EXPECT_EQ(bounds_of({"info", ocean}), "(10 0 -0.8) to (14 2 0)");
  EXPECT_EQ(bounds_of({"info", ocean, "--scale", "1,1,1"}), "(10 0 -4000) to (14 2 0)");
  EXPECT_EQ(bounds_of({"info", shallow}), "(10 0 -3) to (14 2 0)");

  const auto render = [&](bool on_ranks) {
    const Names all = {"render", ocean, "-o", folder / "a.exr", "--size", "48x48"};
    return on_ranks ? mpirun(2, all) : tessera(all);
  };
  const Outcome alone = render(false);
  EXPECT_EQ(alone.status, 0);
  EXPECT_EQ(alone.err.find("warning"), std::string::npos) << alone.err;
  EXPECT_NE(alone.err.find("--scale 1,1,1 leaves z unchanged"), std::string::npos) << alone.err;
  if (!has_mpirun()) return;
  const std::string of_one = contents(folder / "a.exr");
  EXPECT_EQ(render(true).status, 0);
  EXPECT_EQ(contents(folder / "a.exr"), of_one);
}

TEST(Scale, IsNotChosenForBoxesThatAreNotThin) {
  EXPECT_EQ(cells::scale_for_degrees({glm::dvec3(0), glm::dvec3(10, 10, 100)}), glm::dvec3(1));
  EXPECT_EQ(cells::scale_for_degrees({glm::dvec3(0), glm::dvec3(10, 10, 0.6)}), glm::dvec3(1));
  EXPECT_EQ(cells::scale_for_degrees({glm::dvec3(0), glm::dvec3(2, 2, 5000)}), glm::dvec3(1, 1, 1e-4));
  EXPECT_EQ(cells::scale_for_degrees({glm::dvec3(0), glm::dvec3(360, 180, 5)}), glm::dvec3(1, 1, 10));
}

}  // namespace
}  // namespace tessera::apps::scale_test
