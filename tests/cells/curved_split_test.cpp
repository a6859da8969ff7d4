// SPDX-License-Identifier: BSD-3-Clause
// Higher-order cells: their functions, identical division of shared faces by neighbours, and errors within their
// bounds.
#include "cells/curved/curved_split.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <map>
#include <random>
#include <utility>

#include "cells/curved/curved_cell.hpp"
#include "cells/curved/higher_order_plan.hpp"
#include "cells/mesh_assembly.hpp"
#include "support/curved_meshes.hpp"
#include "support/mesh_checks.hpp"
#include "support/some_cases.hpp"

namespace tessera::io::curved_split_test {
namespace {

using testing::bent;
using testing::Field;
using testing::Kind;
using testing::kinds;
using testing::place_of;
using testing::Warp;
using testing::warped_box;

/// A random point in a cell's own coordinates, in units of 1 / cells::cell_unit.
cells::CellPlace random_place(cells::CurvedFamily family, std::mt19937& random) {
  std::uniform_int_distribution<std::int32_t> number(0, cells::cell_unit);
  for (;;) {
    const cells::CellPlace p = {number(random), number(random), number(random)};
    switch (family) {
      case cells::CurvedFamily::tet:
        if (p[0] + p[1] + p[2] <= cells::cell_unit) return p;
        break;
      case cells::CurvedFamily::hexahedron:
        return p;
      case cells::CurvedFamily::wedge:
        if (p[0] + p[1] <= cells::cell_unit) return p;
        break;
      case cells::CurvedFamily::pyramid:
        if (std::max(p[0], p[1]) + p[2] <= cells::cell_unit) return p;
        break;
    }
  }
}

TEST(CurvedCell, HasAllPolynomialsOfItsDegree) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> coefficient(-1, 1);
  for (const Kind& kind : kinds) {
    SCOPED_TRACE(static_cast<int>(kind.type));
    const auto lattice = cells::curved_lattice(kind.type, kind.nodes, kind.degrees);
    ASSERT_TRUE(lattice);
    std::vector<std::array<double, 4>> terms;  // powers of r, s, t and a factor
    for (int i = 0; i <= kind.degree; ++i)
      for (int j = 0; i + j <= kind.degree; ++j)
        for (int k = 0; i + j + k <= kind.degree; ++k)
          terms.push_back(
              {static_cast<double>(i), static_cast<double>(j), static_cast<double>(k), coefficient(random)});
    const auto f = [&](const glm::dvec3& x) {
      double sum = 0;
      for (const auto& [i, j, k, c] : terms) sum += c * std::pow(x.x, i) * std::pow(x.y, j) * std::pow(x.z, k);
      return sum;
    };
    std::vector<glm::dvec3> positions;
    std::vector<double> values;
    for (std::size_t k = 0; k < kind.nodes; ++k) {
      positions.push_back(place_of(*lattice, k));
      values.push_back(f(positions.back()));
    }
    cells::CurvedCell cell;
    cell.set(*lattice, positions, values);
    for (int n = 0; n < 50; ++n) {
      const cells::CellPlace place = random_place(lattice->family, random);
      const glm::dvec4 found = cell.at(place, 0);
      const glm::dvec3 x = glm::dvec3(place[0], place[1], place[2]) / static_cast<double>(cells::cell_unit);
      EXPECT_NEAR(found.x, x.x, 1e-12);  // positions are the identity, which is also a polynomial
      EXPECT_NEAR(found.z, x.z, 1e-12);
      EXPECT_NEAR(found.w, f(x), 1e-11);
    }
  }
}

TEST(CurvedCell, HasItsNodesAtTheLatticePoints) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> anywhere(-1, 1);
  for (const Kind& kind : kinds) {
    SCOPED_TRACE(static_cast<int>(kind.type));
    const auto lattice = cells::curved_lattice(kind.type, kind.nodes, kind.degrees);
    ASSERT_TRUE(lattice);
    if (lattice->has_control_points) continue;
    std::vector<glm::dvec3> positions(kind.nodes);
    std::vector<double> values(kind.nodes);
    for (auto& p : positions) p = {anywhere(random), anywhere(random), anywhere(random)};
    for (double& v : values) v = anywhere(random);
    cells::CurvedCell cell;
    cell.set(*lattice, positions, values);
    for (std::size_t k = 0; k < kind.nodes; ++k) {
      cells::CellPlace place;
      bool is_whole = true;  // false for example for a third, which is not a multiple of the unit
      for (std::size_t x = 0; x < 3; ++x) {
        const int steps = lattice->order[x] * lattice->refined;
        is_whole = is_whole && std::int64_t{lattice->nodes[k][x]} * cells::cell_unit % steps == 0;
        place[x] = static_cast<std::int32_t>(std::int64_t{lattice->nodes[k][x]} * cells::cell_unit / steps);
      }
      if (!is_whole) continue;
      EXPECT_NEAR(cell.at(place, 0).w, values[k], 1e-12) << k;
    }
  }
}

// A place on a face, evaluated by the face alone and by the whole cell: both must give the same number.
TEST(CurvedCell, AgreesWithItselfOnFacesAndEdges) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> anywhere(-1, 1);
  for (const Kind& kind : kinds) {
    SCOPED_TRACE(static_cast<int>(kind.type));
    const auto lattice = cells::curved_lattice(kind.type, kind.nodes, kind.degrees);
    std::vector<glm::dvec3> positions(kind.nodes);
    std::vector<double> values(kind.nodes);
    for (auto& p : positions) p = {anywhere(random), anywhere(random), anywhere(random)};
    for (double& v : values) v = anywhere(random);
    cells::CurvedCell cell;
    cell.set(*lattice, positions, values);
    const std::size_t corners = cells::corners_of(lattice->family).size();
    for (std::size_t a = 0; a < corners; ++a)
      for (std::size_t b = 0; b < a; ++b) {
        const unsigned shared = cell.faces_of_corner(a) & cell.faces_of_corner(b);
        if (shared == 0) continue;
        const cells::CellPlace p = cell.place_of_corner(a), q = cell.place_of_corner(b);
        cells::CellPlace at;
        for (std::size_t x = 0; x < 3; ++x) at[x] = (3 * p[x] + q[x]) / 4;
        const glm::dvec4 alone = cell.at(at, shared), whole = cell.at(at, 0);
        for (int x = 0; x < 4; ++x) EXPECT_NEAR(alone[x], whole[x], 1e-12);
      }
  }
}

ReadOptions tolerance(double relative) {
  ReadOptions options;
  options.higher_order_tolerance = relative;
  options.field = "point:f";
  return options;
}

/// Triangles used once must enclose the tets' volume. A crack would add edges of this surface that are not between two
/// of its triangles, or more surface than a ball has.
void expect_closed_ball(const scene::TetMesh& mesh) {
  std::size_t inside = 0, once = 0;
  std::map<std::array<testing::Point, 2>, int> rim;
  for (const auto& [triangle, uses] : testing::count_triangles(mesh)) {
    EXPECT_LE(uses, 2);
    if (uses != 1) continue;
    ++once;
    for (int k = 0; k < 3; ++k) {
      std::array<testing::Point, 2> edge = {triangle[static_cast<std::size_t>(k)],
                                            triangle[static_cast<std::size_t>((k + 1) % 3)]};
      std::sort(edge.begin(), edge.end());
      ++rim[edge];
    }
  }
  for (const auto& [edge, uses] : rim) inside += uses != 2;
  EXPECT_GT(once, 0u);
  EXPECT_EQ(inside, 0u) << "edges of the surface that are not between two triangles";
  // A crack may also be a separate closed surface. The Euler characteristic is 2 only for the surface of one ball.
  std::map<testing::Point, int> corners;
  for (const auto& [edge, uses] : rim) ++corners[edge[0]], ++corners[edge[1]];
  EXPECT_EQ(static_cast<long>(corners.size()) - static_cast<long>(rim.size()) + static_cast<long>(once), 2)
      << "the surface is not one ball's";
}

/// A tolerance that gives many tets per cell, but few enough for builds with sanitizers.
constexpr double coarse = 6e-2;

void expect_one_ball(std::vector<cells::CellBlock> blocks) {
  const cells::MeshFile file = cells::assemble_mesh(std::move(blocks), tolerance(coarse), "mesh");
  EXPECT_EQ(file.higher_order.by_corners, 0u);
  EXPECT_GT(file.higher_order.tets, file.higher_order.divided * 2);
  expect_closed_ball(file.mesh);
}

TEST(CurvedSplit, LeavesNoCracksWhateverTheNumbering) {
  const Field wavy = [](const glm::dvec3& p) { return std::sin(9 * p.x * p.y) + p.z * p.z; };
  test::SomeCases some(5);
  for (const Kind& kind : kinds)
    for (const double relative : {1e-1, 6e-2})  // each cell is divided separately; some faces barely need a division
      for (const bool turned : {false, true}) {
        if (!some.next()) continue;
        SCOPED_TRACE(fmt::format("{}, {} nodes, {}{}", kind.type, kind.nodes, relative, turned ? ", turned" : ""));
        const cells::MeshFile file =
            cells::assemble_mesh({warped_box(kind, 2, bent, wavy, turned)}, tolerance(relative), "mesh");
        EXPECT_EQ(file.higher_order.by_corners, 0u);
        EXPECT_GT(file.higher_order.tets, file.higher_order.divided * 2);
        EXPECT_LE(file.higher_order.position_error, relative * 2);
        expect_closed_ball(file.mesh);
      }
}

/// The largest difference between the field of tets and `truth` at random points in the tets.
double worst_difference(const scene::TetMesh& mesh, const Field& truth, int points_a_tet) {
  std::mt19937 random(5);
  std::exponential_distribution<double> weight;
  double worst = 0;
  for (const scene::Tet& tet : mesh.tets)
    for (int n = 0; n < points_a_tet; ++n) {
      std::array<double, 4> w{};
      double sum = 0, value = 0;
      for (double& x : w) sum += x = weight(random);
      glm::dvec3 p(0);
      for (std::size_t k = 0; k < 4; ++k) {
        p += w[k] / sum * mesh.positions[tet[k]];
        value += w[k] / sum * mesh.scalars[tet[k]];
      }
      worst = std::max(worst, std::abs(value - truth(p)));
    }
  return worst;
}

TEST(CurvedSplit, KeepsAFieldWithinItsBound) {
  const Field quadratic = [](const glm::dvec3& p) { return p.x * p.x - 2 * p.y * p.z + 0.5 * p.z * p.z + p.y; };
  const Warp straight = [](const glm::dvec3& p) { return p; };
  test::SomeCases some(7);
  for (const Kind& kind : kinds) {
    if (kind.degree < 2) continue;
    for (const double relative : {1e-1, 1e-2, 4e-3}) {
      if (!some.next()) continue;
      SCOPED_TRACE(::testing::PrintToString(static_cast<int>(kind.type)) + " " + ::testing::PrintToString(relative));
      const cells::MeshFile file =
          cells::assemble_mesh({warped_box(kind, 1, straight, quadratic, true)}, tolerance(relative), "mesh");
      const double range = 4;  // about -1 ... 2.5
      const double worst = worst_difference(file.mesh, quadratic, 4);
      EXPECT_LE(worst, file.higher_order.field_error + 1e-12);
      EXPECT_LE(file.higher_order.field_error, relative * range);
      EXPECT_GT(worst, 0.02 * file.higher_order.field_error) << "the bound is no use";
      EXPECT_LE(file.higher_order.position_error, 1e-11);  // rounding, amplified by degree 9
      EXPECT_NEAR(testing::volume(file.mesh), 1, 1e-12);
    }
  }
}

TEST(CurvedSplit, KeepsALinearFieldOnCurvedCells) {
  const Field linear = [](const glm::dvec3& p) { return 1 + p.x - 2 * p.y + 3 * p.z; };
  for (const Kind& kind : kinds) {
    if (kind.type == 27 || kind.type == 31)
      continue;  // their functions on a curved face do not include all of its
                 // positions
    const cells::MeshFile file =
        cells::assemble_mesh({warped_box(kind, 2, bent, linear, false)}, tolerance(4e-2), "mesh");
    EXPECT_LE(worst_difference(file.mesh, linear, 1), 1e-12) << static_cast<int>(kind.type) << " of " << kind.nodes;
    // Straight edges are not halved: tets around an inner point become thin, and their slopes have larger rounding
    // errors.
    const bool has_straight_edges = kind.type == 71 && (kind.nodes == 5 || kind.nodes == 8);
    EXPECT_LE(file.higher_order.field_error, has_straight_edges ? 1e-8 : 1e-11)
        << static_cast<int>(kind.type) << " of " << kind.nodes;
  }
}

TEST(CurvedSplit, NeedsMoreTetsForLessError) {
  const Field wavy = [](const glm::dvec3& p) { return std::sin(5 * p.x) + p.y; };
  std::uint64_t before = 0;
  for (const double relative : {1e-1, 3e-2, 1e-2, 3e-3}) {
    const cells::MeshFile file =
        cells::assemble_mesh({warped_box(kinds[0], 2, bent, wavy, false)}, tolerance(relative), "mesh");
    EXPECT_GT(file.higher_order.tets, before);
    EXPECT_EQ(file.higher_order.tolerance, relative);
    before = file.higher_order.tets;
  }
}

TEST(CurvedSplit, LoosensItsToleranceWhereThatTakesTooManyTets) {
  const Field wavy = [](const glm::dvec3& p) { return std::sin(5 * p.x) + p.y; };
  ReadOptions options = tolerance(1e-6);
  options.higher_order_tets = 20000;
  const cells::MeshFile file = cells::assemble_mesh({warped_box(kinds[4], 2, bent, wavy, false)}, options, "mesh");
  EXPECT_GT(file.higher_order.tolerance, 1e-6);
  EXPECT_LE(file.higher_order.tets, 60000u) << "about so many, not three times";
  EXPECT_GE(file.higher_order.tets, 2000u) << "and not a tenth";
  options.higher_order_tets = 0;
  const cells::MeshFile corners = cells::assemble_mesh({warped_box(kinds[4], 2, bent, wavy, false)}, options, "mesh");
  EXPECT_EQ(corners.higher_order.by_corners, 8u);
  EXPECT_EQ(corners.mesh.tets.size() % 8, 0u);
  EXPECT_EQ(cells::warnings_on_cells(corners.counts, corners.higher_order).size(), 1u);
}

TEST(CurvedSplit, FillsWhatTheCellsFill) {
  // A box bent by a map that quadratic cells represent exactly. Its volume is the integral of (1 + 0.4 x) (1 + 0.2 z).
  const Warp bend = [](const glm::dvec3& p) { return glm::dvec3(p.x + 0.2 * p.x * p.x, p.y + 0.2 * p.y * p.z, p.z); };
  const Field one = [](const glm::dvec3&) { return 1.0; };
  test::SomeCases some(5);
  for (const Kind& kind : kinds) {
    if (kind.degree < 2) continue;
    for (const double relative : {1e-2, 1e-3}) {
      if (!some.next()) continue;
      const cells::MeshFile file =
          cells::assemble_mesh({warped_box(kind, 1, bend, one, false)}, tolerance(relative), "mesh");
      // The surface has an area of 6.9, and deviates by at most `position_error` everywhere.
      EXPECT_NEAR(testing::volume(file.mesh), 1.32, 7 * file.higher_order.position_error);
      EXPECT_LE(file.higher_order.position_error, 2 * relative);  // the diagonal is 2
    }
  }
}

/// Adds weights to the nodes in the form in which writers of rational cells store them.
void add_weights(cells::CellBlock& block, const std::function<double(const glm::dvec3&)>& weight) {
  std::vector<double> weights;
  for (const glm::dvec3& p : block.positions) weights.push_back(weight(p));
  block.fields.push_back(
      cells::field_of_values("RationalWeights", "double", scene::Association::point, 1, std::move(weights)));
}

/// A quarter of a tube of radii 1 and 2 and height 1, in one cell whose field is the height.
cells::CellBlock quarter_tube() {
  const Kind kind{79, 12, 1, {2, 1, 1}};
  const auto height = [](const glm::dvec3& p) { return p.z; };
  const Warp tube = [](const glm::dvec3& p) {
    const double radius = 1 + p.y;
    const glm::dvec2 control[3] = {{radius, 0}, {radius, radius}, {0, radius}};
    const glm::dvec2 at = control[static_cast<int>(std::lround(2 * p.x))];
    return glm::dvec3(at.x, at.y, -p.z);  // -z, so that r, s, t are right-handed
  };
  cells::CellBlock block = warped_box(kind, 1, tube, height, false);
  add_weights(block, [](const glm::dvec3& p) { return p.x == p.y ? std::sqrt(0.5) : 1; });
  return block;
}

TEST(CurvedSplit, DrawsTheCirclesOfRationalCells) {
  test::SomeCases some(3);
  for (const double relative : {1e-2, 1e-1, 1e-3}) {
    if (!some.next()) continue;
    const cells::MeshFile file = cells::assemble_mesh({quarter_tube()}, tolerance(relative), "mesh");
    EXPECT_EQ(file.higher_order.by_corners, 0u);
    const double error = file.higher_order.position_error;
    EXPECT_LE(error, relative * 3.01);  // the box of the control points has a diagonal of 3
    std::size_t on_circles = 0;
    for (const auto& [triangle, uses] : testing::count_triangles(file.mesh)) {
      if (uses != 1) continue;
      std::array<double, 3> radius{};
      glm::dvec2 middle(0);
      for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec2 p(triangle[k][0], triangle[k][1]);
        radius[k] = glm::length(p);
        middle += p / 3.0;
      }
      for (const double of : {1.0, 2.0}) {
        const auto is_there = [&](double r) { return std::abs(r - of) < 1e-12; };
        if (!std::all_of(radius.begin(), radius.end(), is_there)) continue;
        ++on_circles;
        EXPECT_NEAR(glm::length(middle), of, error);
      }
    }
    EXPECT_GE(on_circles, 8u) << "the surface has no points on its circles";
    const double volume = testing::volume(file.mesh), truth = 0.75 * 3.14159265358979324;
    EXPECT_NEAR(volume, truth, 4.8 * error);  // the curved surfaces have an area of 4.7
    EXPECT_LT(volume, truth) << "chords of the outer circle take more away than those of the inner one add";
    EXPECT_LE(file.higher_order.field_error, 1e-12) << "the height is linear";
  }
}

TEST(CurvedSplit, LeavesNoCracksBetweenRationalCells) {
  const Field wavy = [](const glm::dvec3& p) { return std::sin(9 * p.x * p.y) + p.z * p.z; };
  for (const Kind& kind : kinds) {
    if (kind.type < 78) continue;
    SCOPED_TRACE(static_cast<int>(kind.type));
    cells::CellBlock block = warped_box(kind, 2, bent, wavy, true);
    add_weights(block, [](const glm::dvec3& p) { return 1 + 0.5 * std::sin(7 * p.x + 3 * p.y - 5 * p.z); });
    expect_one_ball({std::move(block)});
  }
}

TEST(CurvedSplit, TreatsEqualWeightsAsAbsent) {
  const Field wavy = [](const glm::dvec3& p) { return std::sin(5 * p.x) + p.y; };
  const Kind kind{79, 27, 1, {2, 2, 2}};
  const cells::MeshFile without =
      cells::assemble_mesh({warped_box(kind, 2, bent, wavy, true)}, tolerance(1e-2), "mesh");
  cells::CellBlock block = warped_box(kind, 2, bent, wavy, true);
  add_weights(block, [](const glm::dvec3&) { return 0.3; });
  const cells::MeshFile with = cells::assemble_mesh({std::move(block)}, tolerance(1e-2), "mesh");
  EXPECT_EQ(with.mesh.tets, without.mesh.tets);
  EXPECT_EQ(with.mesh.positions, without.mesh.positions);
  EXPECT_EQ(with.mesh.scalars, without.mesh.scalars);
}

TEST(CurvedSplit, ReportsCellsWithUnusableWeightsAndDrawsTheirCorners) {
  for (const double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), 1e9}) {
    cells::CellBlock block = quarter_tube();
    bool is_first = true;
    block.fields.pop_back();
    add_weights(block, [&](const glm::dvec3&) { return std::exchange(is_first, false) ? bad : 1.0; });
    const cells::MeshFile file = cells::assemble_mesh({std::move(block)}, tolerance(1e-2), "mesh");
    EXPECT_EQ(file.higher_order.by_corners, 1u) << bad;
    EXPECT_EQ(cells::warnings_on_cells(file.counts, file.higher_order).size(), 1u);
  }
}

TEST(CurvedSplit, LeavesNoCracksBetweenKinds) {
  const Field wavy = [](const glm::dvec3& p) { return std::sin(9 * p.x * p.y) + p.z * p.z; };
  // Two adjacent cubes, each of one kind: kinds in a group have the same nodes on the face between them.
  const std::vector<std::vector<Kind>> alike = {
      {{29, 27, 2}, {37, 19, 2}, {74, 14, 2}, {72, 27, 2, {2, 2, 2}}},
      {{72, 64, 3, {3, 3, 3}}, {74, 30, 3}},
      {{25, 20, 2}, {27, 13, 1}},
      {{24, 10, 2}, {71, 10, 2}},
      {{79, 27, 1, {2, 2, 2}}, {79, 27, 1, {2, 2, 2}}},
  };
  test::SomeCases some(5);
  for (const auto& group : alike)
    for (const Kind& left : group)
      for (const Kind& right : group) {
        if (!some.next()) continue;
        SCOPED_TRACE(::testing::PrintToString(static_cast<int>(left.type)) + " beside " +
                     ::testing::PrintToString(static_cast<int>(right.type)));
        const Warp moved = [](const glm::dvec3& p) { return bent(glm::dvec3(p.x + 1, p.y, p.z)); };
        expect_one_ball({warped_box(left, 1, bent, wavy, true), warped_box(right, 1, moved, wavy, true)});
      }
}

/// Cubic tets of a cube. In the first `folded` tets, a node within a face is moved through the cell.
cells::CellBlock folded_box(std::size_t folded, double by) {
  cells::CellBlock block = warped_box(
      {71, 20, 3}, 2, bent, [](const glm::dvec3& p) { return p.x; }, false);
  for (std::size_t c = 0; c < folded; ++c) block.positions[block.connectivity[block.offsets[c] + 16]] += by;
  return block;
}

TEST(CurvedSplit, RefusesCellsThatNeedUnboundedTets) {
  ReadOptions options = tolerance(1e-5);
  options.higher_order_tets = 20000;
  const auto planning = [](const auto&, const ReadOptions& o, const auto&...) {
    return cells::HigherOrderPlan{{{.position = o.higher_order_tolerance}, 5000}, o.higher_order_tolerance};
  };
  test::expect_bad_input(
      [&] { cells::assemble_mesh({folded_box(1, 2)}, options, "mesh", planning); },
      {"mesh: cell 0 cannot be approximated closely enough by 5000 tets", "`higher_order_tolerance`"});
  ReadOptions remedy = options;
  remedy.higher_order_tolerance = 0.1;
  EXPECT_NO_THROW(cells::assemble_mesh({folded_box(1, 2)}, remedy, "mesh", planning));
  // If there are few cells, they are divided on trial first.
  const cells::MeshFile file = cells::assemble_mesh({folded_box(1, 2)}, options, "mesh");
  EXPECT_LE(file.higher_order.tets, 65536u + 64 * 48);
  EXPECT_GT(file.higher_order.tolerance, 1e-5);
}

TEST(CurvedSplit, LoosensTheToleranceForOneStronglyCurvedCell) {
  // One tet with values 1 at the corners and 0 at the middles of edges. It would need more than a million tets at a
  // tolerance of 1e-4.
  cells::CellBlock block = warped_box(
      {24, 10, 2}, 1, bent, [](const glm::dvec3&) { return 0.0; }, false);
  block.types.resize(1), block.offsets.resize(2), block.connectivity.resize(10);
  std::vector<double> values(block.positions.size(), 0);
  for (std::size_t k = 0; k < 4; ++k) values[block.connectivity[k]] = 1;
  block.fields = {cells::field_of_values("f", "double", scene::Association::point, 1, std::move(values))};
  const cells::MeshFile file =
      cells::assemble_mesh({std::move(block)}, tolerance(default_higher_order_tolerance), "mesh");
  EXPECT_GT(file.higher_order.tolerance, default_higher_order_tolerance);
  EXPECT_GT(file.higher_order.tets, 10000u);
}

TEST(CurvedSplit, GivesACellFewerTetsWhenTheyTakeLonger) {
  const auto limit_of = [&](const Kind& kind, std::size_t limit) {
    const cells::CellBlock block = warped_box(
        kind, 1, bent, [](const glm::dvec3&) { return 0.0; }, false);
    return cells::CurvedCells(block, block.positions, {}, scene::Association::point, {.tolerance = {}, .limit = limit})
        .settings()
        .limit;
  };
  constexpr std::size_t many = 1 << 22, usual = 1 << 18;
  EXPECT_EQ(limit_of({24, 10, 2}, many), many);      // quadratic tetrahedra
  EXPECT_LT(limit_of({29, 27, 2}, many), many / 4);  // triquadratic hexahedra: 84 coefficients instead of 10
  EXPECT_EQ(limit_of({29, 27, 2}, usual), usual);
}

TEST(CurvedSplit, RefusesMeshesThatNeedUnboundedTets) {
  const cells::CellBlock block = warped_box(
      kinds[0], 2, bent, [](const glm::dvec3& p) { return p.x; }, false);
  const auto tets_of = [&](std::size_t blocks, std::uint64_t all) {
    const auto planning = [&](const auto&...) {
      return cells::HigherOrderPlan{{{.position = 4e-4}, std::size_t{1} << 20, all}, 1e-4};
    };
    return cells::assemble_mesh(std::vector(blocks, block), tolerance(1e-4), "mesh", planning).higher_order.tets;
  };
  const std::uint64_t alone = tets_of(1, 1 << 20);
  ASSERT_GT(alone, 64 * block.types.size()) << "what each cell may become beside";
  EXPECT_EQ(tets_of(1, alone), alone);
  EXPECT_EQ(tets_of(2, 2 * alone), 2 * alone);
  const auto expect_refusal = [&](std::size_t blocks, std::uint64_t all) {
    test::expect_bad_input(
        [&] { tets_of(blocks, all); },
        {"mesh: its higher-order cells up to ", " cannot be approximated closely enough by ", "`higher_order_tets`"});
  };
  expect_refusal(1, alone - 64 * block.types.size() - 1);
  expect_refusal(2, 2 * (alone - 64 * block.types.size()) - 1);  // each block alone is below the limit
}

TEST(CurvedSplit, UsesLittleMemoryForADamagedNode) {
  cells::ExcessTally tally{};
  EXPECT_EQ(cells::usual_tets(tally), 1u << 18);
  tally[0] = 1000, tally[40] = 48;
  EXPECT_EQ(cells::usual_tets(tally), (1u << 18) + 2000) << "what a node pulls away counts not";
  tally[40] = 200;
  EXPECT_EQ(cells::usual_tets(tally), 1u << 21);
  tally[0] = 1 << 20;
  EXPECT_EQ(cells::usual_tets(tally), 4 * ((1u << 20) + 200)) << "a large mesh is divided too";

  const Field wavy = [](const glm::dvec3& p) { return std::sin(5 * p.x) + p.y; };
  for (const std::size_t kind : {0u, 4u}) {
    // A node within an edge is moved away by a thousand times the mesh's size.
    cells::CellBlock block = warped_box(kinds[kind], 1, bent, wavy, false);
    block.positions[block.connectivity[kinds[kind].nodes / 2 + 2]].x += 1e3;
    std::uint64_t tets = 0;
    try {
      tets =
          cells::assemble_mesh({std::move(block)}, tolerance(default_higher_order_tolerance), "mesh").higher_order.tets;
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find("more tets (`higher_order_tets`)"), std::string::npos) << e.what();
    }
    EXPECT_LE(tets, (3u << 18) + 64 * 6);
  }
}

TEST(CurvedSplit, DoesNotDivideCellsForInfiniteDistances) {
  cells::CellBlock block = warped_box(
      {24, 10, 2}, 1, bent, [](const glm::dvec3& p) { return p.x; }, false);
  block.positions[block.connectivity[4]].z = 1e308;  // its square is not finite
  const cells::MeshFile file = cells::assemble_mesh({std::move(block)}, tolerance(1e-2), "mesh");
  EXPECT_LT(file.higher_order.tets, 1000u);
  EXPECT_EQ(file.higher_order.position_error, std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace tessera::io::curved_split_test
