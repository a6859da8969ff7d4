// Meshes with levels of refinement: blocks of regular grids that a list names.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <random>

#include "io/amr_values.hpp"
#include "io/mesh_checks.hpp"
#include "io/mesh_reader.hpp"
#include "io/temporary_folder.hpp"

namespace tessera::io {
namespace {

using testing::message_of;

/// A block of cells of size 1 / `parts`, by the first and last of them along each axis.
struct Block {
  int level, parts;
  std::array<int, 3> first, last;

  [[nodiscard]] bool holds(const glm::dvec3& p) const {
    for (int a = 0; a < 3; ++a) {
      const auto axis = static_cast<std::size_t>(a);
      if (p[a] * parts < first[axis] || p[a] * parts >= last[axis] + 1) return false;
    }
    return true;
  }
};

/// A file of blocks whose origin is not a whole number of spacings, written with `at` at points or cells' centres.
class AmrFile {
 public:
  static constexpr double origin = 0.3, unit = 0.7;

  AmrFile(const test::TemporaryFolder& folder, std::vector<Block> blocks, bool points,
          const std::function<double(const glm::dvec3&)>& at)
      : blocks_(std::move(blocks)) {
    std::string list;
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      const Block& block = blocks_[b];
      std::string extent, values;
      glm::dvec3 low;
      const double spacing = unit / block.parts;
      std::array<int, 3> n{};
      for (std::size_t a = 0; a < 3; ++a) {
        n[a] = block.last[a] - block.first[a] + (points ? 2 : 1);
        extent += fmt::format("0 {} ", block.last[a] - block.first[a] + 1);
        low[static_cast<int>(a)] = origin + spacing * block.first[a];
      }
      for (int k = 0; k < n[2]; ++k)
        for (int j = 0; j < n[1]; ++j)
          for (int i = 0; i < n[0]; ++i)
            values += fmt::format("{} ", at(low + spacing * (glm::dvec3(i, j, k) + (points ? 0.0 : 0.5))));
      folder.write(
          fmt::format("b{}.vti", b),
          fmt::format(
              "<VTKFile type=\"ImageData\" version=\"0.1\" byte_order=\"LittleEndian\"><ImageData "
              "WholeExtent=\"{0}\" Origin=\"{1} {2} {3}\" Spacing=\"{4} {4} {4}\"><Piece Extent=\"{0}\"><{5}>"
              "<DataArray type=\"Float64\" Name=\"f\" format=\"ascii\">{6}</DataArray></{5}></Piece></ImageData>"
              "</VTKFile>",
              extent, low.x, low.y, low.z, spacing, points ? "PointData" : "CellData", values));
      list += fmt::format("<Block level=\"{}\"><DataSet index=\"0\" file=\"b{}.vti\"/></Block>", block.level, b);
    }
    file = folder.write("amr.vth", "<VTKFile type=\"vtkOverlappingAMR\" version=\"1.1\"><vtkOverlappingAMR>" + list +
                                       "</vtkOverlappingAMR></VTKFile>");
  }

  /// The deepest block at a place.
  [[nodiscard]] const Block& block_at(const glm::dvec3& p) const {
    const Block* found = &blocks_.front();
    for (const Block& block : blocks_)
      if (block.holds((p - origin) / unit) && block.parts > found->parts) found = &block;
    return *found;
  }

  /// The centre of the cell at a place.
  [[nodiscard]] glm::dvec3 centre_at(const glm::dvec3& p) const {
    const double spacing = unit / block_at(p).parts;
    return origin + spacing * (glm::floor((p - origin) / spacing) + 0.5);
  }

  std::filesystem::path file;

 private:
  std::vector<Block> blocks_;
};

/// Four cells a side; in it a block of the next level, a block in that, and one two levels finer than the cells around
/// it, which touches the boundary.
std::vector<Block> nested_blocks() {
  return {{0, 1, {0, 0, 0}, {3, 3, 3}},
          {1, 2, {2, 2, 2}, {5, 5, 5}},
          {2, 4, {6, 6, 6}, {9, 9, 9}},
          {2, 4, {12, 12, 0}, {15, 15, 3}}};
}

double linear(const glm::dvec3& p) { return 1 + 2 * p.x - 3 * p.y + 0.5 * p.z; }
double wavy(const glm::dvec3& p) { return std::sin(5 * p.x) + std::cos(7 * p.y) * std::sin(3 * p.z); }

/// The stretch of a line inside a tet; empty if it misses it.
std::optional<std::pair<double, double>> stretch_in(const scene::TetMesh& mesh, const scene::Tet& tet,
                                                    const glm::dvec3& from, const glm::dvec3& along) {
  double low = -1e9, high = 1e9;
  for (std::size_t k = 0; k < 4; ++k) {
    const glm::dvec3 a = mesh.positions[tet[(k + 1) % 4]], b = mesh.positions[tet[(k + 2) % 4]],
                     c = mesh.positions[tet[(k + 3) % 4]];
    glm::dvec3 normal = glm::cross(b - a, c - a);
    if (glm::dot(normal, mesh.positions[tet[k]] - a) < 0) normal = -normal;
    const double height = glm::dot(normal, from - a), slope = glm::dot(normal, along);
    if (slope > 0)
      low = std::max(low, -height / slope);
    else if (slope < 0)
      high = std::min(high, -height / slope);
    else if (height < 0)
      return std::nullopt;
  }
  if (low >= high) return std::nullopt;
  return std::pair(low, high);
}

/// Lines through the block of nested_blocks(): some from random places, some straight through corners of cells.
std::vector<std::pair<glm::dvec3, glm::dvec3>> lines() {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> inside(0.01, 3.99), turn(-1, 1);
  std::vector<std::pair<glm::dvec3, glm::dvec3>> all;
  for (int n = 0; n < 400; ++n) {
    glm::dvec3 p(inside(random), inside(random), inside(random));
    if (n % 2 == 1) p = glm::round(4.0 * p) / 4.0;
    all.emplace_back(AmrFile::origin + AmrFile::unit * p,
                     glm::normalize(glm::dvec3(turn(random), turn(random), turn(random))));
  }
  return all;
}

/// The mesh fills its box once: no gaps, and every triangle inside belongs to two tets.
void expect_conforming(const scene::TetMesh& mesh, double side) {
  EXPECT_NEAR(testing::volume(mesh), side * side * side, 1e-12 * side * side * side);
  double area = 0;
  for (const auto& [triangle, uses] : testing::count_triangles(mesh)) {
    ASSERT_LE(uses, 2);
    if (uses == 2) continue;
    std::array<glm::dvec3, 3> p{};
    for (std::size_t k = 0; k < 3; ++k) p[k] = {triangle[k][0], triangle[k][1], triangle[k][2]};
    area += 0.5 * glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));
  }
  EXPECT_NEAR(area, 6 * side * side, 1e-12 * area) << "some triangles inside have one tet only: hanging corners";
  std::map<testing::Point, double> value;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const glm::dvec3& p = mesh.positions[v];
    const auto [at, is_new] = value.emplace(testing::Point{p.x, p.y, p.z}, mesh.scalars[v]);
    ASSERT_TRUE(is_new || at->second == mesh.scalars[v]) << "two values at one place";
  }
}

TEST(Amr, LinesThroughCellDataSumUpWhatTheirFinestCellsHold) {
  const test::TemporaryFolder folder;
  const AmrFile amr(folder, nested_blocks(), false, wavy);
  const MeshFile read = read_mesh(amr.file);
  scene::validate(read.mesh, "amr");
  EXPECT_EQ(read.mesh.association, scene::Association::cell);
  EXPECT_EQ(read.counts.cells_read, 64u - 8 - 1 + 64 - 8 + 2 * 64);
  EXPECT_NE(std::find(read.notes.begin(), read.notes.end(), "17 cells are covered by finer ones and left out"),
            read.notes.end());
  const double most = 4 * AmrFile::unit;
  for (const auto& [from, along] : lines()) {
    double sum = 0, length = 0;
    for (std::size_t t = 0; t < read.mesh.tets.size(); ++t)
      if (const auto stretch = stretch_in(read.mesh, read.mesh.tets[t], from, along)) {
        length += stretch->second - stretch->first;
        sum += (stretch->second - stretch->first) * read.mesh.scalars[t];
      }
    // Between all planes of the finest lattice that the line crosses, from the file alone.
    std::vector<double> cuts;
    double first = -1e9, last = 1e9;
    for (int a = 0; a < 3; ++a) {
      for (int plane = 0; plane <= 16; ++plane)
        cuts.push_back((AmrFile::origin + most * plane / 16 - from[a]) / along[a]);
      const auto [low, high] = std::minmax(cuts[cuts.size() - 17], cuts.back());
      first = std::max(first, low), last = std::min(last, high);
    }
    std::sort(cuts.begin(), cuts.end());
    double expected = 0;
    for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
      const double begin = std::max(cuts[k], first), end = std::min(cuts[k + 1], last);
      if (end > begin) expected += (end - begin) * wavy(amr.centre_at(from + 0.5 * (begin + end) * along));
    }
    EXPECT_NEAR(length, last - first, 1e-9);
    EXPECT_NEAR(sum, expected, 1e-6);
  }
}

TEST(Amr, PointDataIsContinuousAcrossLevelsAndLinearWhereItIs) {
  const test::TemporaryFolder folder;
  for (const auto& at : {linear, wavy}) {
    const MeshFile read = read_mesh(AmrFile(folder, nested_blocks(), true, at).file);
    scene::validate(read.mesh, "amr");
    ASSERT_EQ(read.mesh.association, scene::Association::point);
    expect_conforming(read.mesh, 4 * AmrFile::unit);
    for (std::size_t v = 0; at == linear && v < read.mesh.positions.size(); ++v)
      ASSERT_NEAR(read.mesh.scalars[v], linear(read.mesh.positions[v]), 1e-12);
  }
}

TEST(Amr, SmoothedCellDataIsContinuousAndLinearInsideAndKeepsEachCellsValue) {
  const test::TemporaryFolder folder;
  MeshOptions options;
  options.smooth = true;
  for (const auto& at : {linear, wavy}) {
    const AmrFile amr(folder, nested_blocks(), false, at);
    const MeshFile read = read_mesh(amr.file, options);
    scene::validate(read.mesh, "amr");
    ASSERT_EQ(read.mesh.association, scene::Association::point);
    expect_conforming(read.mesh, 4 * AmrFile::unit);
    std::size_t centres = 0, inner = 0;
    for (std::size_t v = 0; v < read.mesh.positions.size(); ++v) {
      const glm::dvec3 p = read.mesh.positions[v], lattice = (p - AmrFile::origin) / AmrFile::unit;
      if (glm::length(amr.centre_at(p) - p) < 1e-9) {
        ++centres;
        EXPECT_NEAR(read.mesh.scalars[v], at(p), 1e-12);
      }
      // As far from the boundary as half a cell of the coarsest level.
      const double margin = std::min({lattice.x, lattice.y, lattice.z, 4 - lattice.x, 4 - lattice.y, 4 - lattice.z});
      if (at == linear && margin >= 0.5 - 1e-9) {
        ++inner;
        EXPECT_NEAR(read.mesh.scalars[v], linear(p), 1e-9) << lattice.x << ' ' << lattice.y << ' ' << lattice.z;
      }
    }
    EXPECT_GE(centres, read.mesh.positions.empty() ? 1u : 239u);
    EXPECT_TRUE(at != linear || inner > 400u);
  }
}

TEST(Amr, BlocksThatCutThroughCoarserCellsLeaveTheRestOfThem) {
  const test::TemporaryFolder folder;
  const std::vector<Block> cut{
      {0, 1, {0, 0, 0}, {3, 3, 3}}, {1, 3, {1, 2, 3}, {7, 6, 5}}, {2, 6, {5, 6, 7}, {10, 9, 8}}};
  for (const bool points : {false, true}) {
    const AmrFile amr(folder, cut, points, linear);
    for (const bool smooth : {false, true}) {
      MeshOptions options;
      options.smooth = smooth;
      const MeshFile read = read_mesh(amr.file, options);
      EXPECT_NEAR(testing::volume(read.mesh), std::pow(4 * AmrFile::unit, 3), 1e-11) << points << smooth;
      if (points || smooth) expect_conforming(read.mesh, 4 * AmrFile::unit);
      for (std::size_t v = 0; points && v < read.mesh.positions.size(); ++v)
        ASSERT_NEAR(read.mesh.scalars[v], linear(read.mesh.positions[v]), 1e-12);
      for (std::size_t t = 0; !points && !smooth && t < read.mesh.tets.size(); ++t) {
        glm::dvec3 centre(0);
        for (const std::uint32_t v : read.mesh.tets[t]) centre += 0.25 * read.mesh.positions[v];
        ASSERT_NEAR(read.mesh.scalars[t], linear(amr.centre_at(centre)), 1e-12);
      }
    }
  }
}

TEST(Amr, WeightsOfLargestEntropyAreAboveZeroAndHaveTheMeanAskedFor) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> length(0.01, 4);
  for (int n = 0; n < 1000; ++n) {
    std::array<glm::dvec3, 8> offsets{};
    std::array<double, 8> weights{};
    weights.fill(1);
    for (int k = 0; k < 8; ++k) {  // one in each octant: 0 is inside their hull
      const double size = length(random);
      offsets[static_cast<std::size_t>(k)] = size * glm::dvec3(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
    }
    weigh_by_entropy(offsets, weights);
    glm::dvec3 mean(0);
    double sum = 0;
    for (std::size_t k = 0; k < 8; ++k) {
      EXPECT_GT(weights[k], 0);
      mean += weights[k] * offsets[k], sum += weights[k];
    }
    EXPECT_NEAR(sum, 1, 1e-12);
    EXPECT_LT(glm::length(mean), 1e-9);
  }
}

TEST(Amr, WhatDoesNotNestIsToldWithTheBlockAtFault) {
  const test::TemporaryFolder folder;
  const auto fault = [&](std::vector<Block> blocks) {
    return message_of([&] { read_mesh(AmrFile(folder, std::move(blocks), false, linear).file); });
  };
  EXPECT_NE(fault({{0, 2, {0, 0, 0}, {3, 3, 3}}, {1, 3, {0, 0, 0}, {2, 2, 2}}}).find("whole ratios"),
            std::string::npos);
  EXPECT_NE(fault({{0, 1, {0, 0, 0}, {3, 3, 3}}, {1, 100, {0, 0, 0}, {2, 2, 2}}}).find("up to 64"), std::string::npos);
  const AmrFile amr(folder, nested_blocks(), false, linear);
  folder.write("b1.vti", "<VTKFile");
  EXPECT_NE(message_of([&] { read_mesh(amr.file); }).find("b1.vti: "), std::string::npos);
  EXPECT_NE(message_of([&] { read_mesh(folder.write("x.vth", "<a/>")); }).find("no list of AMR blocks"),
            std::string::npos);
}

}  // namespace
}  // namespace tessera::io
