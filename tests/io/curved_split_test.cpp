// Higher-order cells: their functions, that neighbours divide what they share alike, and that errors keep their bounds.
#include "io/curved_split.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <random>

#include "io/curved_cell.hpp"
#include "io/mesh_assembly.hpp"
#include "io/mesh_checks.hpp"

namespace tessera::io {
namespace {

using scene::Association;

struct Kind {
  std::uint8_t type;
  std::size_t nodes;
  int degree;  ///< of the polynomials in (r, s, t) that it has all of
  std::array<int, 3> degrees{};
};

std::size_t lagrange_nodes(std::uint8_t type, const std::array<int, 3>& n) {
  const auto p = static_cast<std::size_t>(n[0]) + 1, q = static_cast<std::size_t>(n[1]) + 1,
             m = static_cast<std::size_t>(n[2]) + 1;
  return type == 71 ? p * (p + 1) * (p + 2) / 6 : type == 72 ? p * q * m : p * (p + 1) / 2 * m;
}

Kind lagrange(std::uint8_t type, std::array<int, 3> n) {
  return {type, lagrange_nodes(type, n), std::min({n[0], n[1], n[2]}), n};
}

const std::vector<Kind> kinds = {{24, 10, 2},
                                 {25, 20, 2},
                                 {26, 15, 2},
                                 {27, 13, 2},
                                 {29, 27, 2},
                                 {31, 12, 1},
                                 {32, 18, 2},
                                 {33, 24, 2},
                                 lagrange(71, {2, 2, 2}),
                                 lagrange(71, {3, 3, 3}),
                                 lagrange(71, {5, 5, 5}),
                                 lagrange(72, {2, 2, 2}),
                                 lagrange(72, {3, 2, 1}),
                                 lagrange(72, {3, 3, 3}),
                                 lagrange(73, {3, 3, 2}),
                                 lagrange(73, {4, 4, 4})};

using Field = std::function<double(const glm::dvec3&)>;
using Warp = std::function<glm::dvec3(const glm::dvec3&)>;

glm::dvec3 place_of(const CurvedLattice& lattice, std::size_t node) {
  const LatticePlace& p = lattice.nodes[node];
  return {static_cast<double>(p[0]) / lattice.order[0], static_cast<double>(p[1]) / lattice.order[1],
          static_cast<double>(p[2]) / lattice.order[2]};
}

/// A random point of a cell's own coordinates, in units.
CellPlace random_place(CurvedFamily family, std::mt19937& random) {
  std::uniform_int_distribution<std::int32_t> number(0, cell_unit);
  for (;;) {
    const CellPlace p = {number(random), number(random), number(random)};
    switch (family) {
      case CurvedFamily::tet:
        if (p[0] + p[1] + p[2] <= cell_unit) return p;
        break;
      case CurvedFamily::hexahedron:
        return p;
      case CurvedFamily::wedge:
        if (p[0] + p[1] <= cell_unit) return p;
        break;
      case CurvedFamily::pyramid:
        if (std::max(p[0], p[1]) + p[2] <= cell_unit) return p;
        break;
    }
  }
}

TEST(CurvedCell, HasAllPolynomialsOfItsDegree) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> coefficient(-1, 1);
  for (const Kind& kind : kinds) {
    SCOPED_TRACE(static_cast<int>(kind.type));
    const auto lattice = curved_lattice(kind.type, kind.nodes, kind.degrees);
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
    CurvedCell cell;
    cell.set(*lattice, positions, values);
    for (int n = 0; n < 50; ++n) {
      const CellPlace place = random_place(lattice->family, random);
      const glm::dvec4 found = cell.at(place, 0);
      const glm::dvec3 x = glm::dvec3(place[0], place[1], place[2]) / static_cast<double>(cell_unit);
      EXPECT_NEAR(found.x, x.x, 1e-12);  // positions are the identity, a polynomial too
      EXPECT_NEAR(found.z, x.z, 1e-12);
      EXPECT_NEAR(found.w, f(x), 1e-11);
    }
  }
}

TEST(CurvedCell, HasItsNodesWhereTheLatticeSays) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> anywhere(-1, 1);
  for (const Kind& kind : kinds) {
    SCOPED_TRACE(static_cast<int>(kind.type));
    const auto lattice = curved_lattice(kind.type, kind.nodes, kind.degrees);
    ASSERT_TRUE(lattice);
    std::vector<glm::dvec3> positions(kind.nodes);
    std::vector<double> values(kind.nodes);
    for (auto& p : positions) p = {anywhere(random), anywhere(random), anywhere(random)};
    for (double& v : values) v = anywhere(random);
    CurvedCell cell;
    cell.set(*lattice, positions, values);
    for (std::size_t k = 0; k < kind.nodes; ++k) {
      CellPlace place;
      bool is_whole = true;  // a third has no place in units
      for (std::size_t x = 0; x < 3; ++x) {
        is_whole = is_whole && cell_unit % lattice->order[x] == 0;
        place[x] = lattice->nodes[k][x] * (cell_unit / lattice->order[x]);
      }
      if (!is_whole) continue;
      EXPECT_NEAR(cell.at(place, 0).w, values[k], 1e-12) << k;
    }
  }
}

// A place on a face, told by the face alone and by the whole cell: two ways to one number.
TEST(CurvedCell, AgreesWithItselfOnFacesAndEdges) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> anywhere(-1, 1);
  for (const Kind& kind : kinds) {
    SCOPED_TRACE(static_cast<int>(kind.type));
    const auto lattice = curved_lattice(kind.type, kind.nodes, kind.degrees);
    std::vector<glm::dvec3> positions(kind.nodes);
    std::vector<double> values(kind.nodes);
    for (auto& p : positions) p = {anywhere(random), anywhere(random), anywhere(random)};
    for (double& v : values) v = anywhere(random);
    CurvedCell cell;
    cell.set(*lattice, positions, values);
    const std::size_t corners = corners_of(lattice->family).size();
    for (std::size_t a = 0; a < corners; ++a)
      for (std::size_t b = 0; b < a; ++b) {
        const unsigned shared = cell.faces_of_corner(a) & cell.faces_of_corner(b);
        if (shared == 0) continue;
        const CellPlace p = cell.place_of_corner(a), q = cell.place_of_corner(b);
        CellPlace at;
        for (std::size_t x = 0; x < 3; ++x) at[x] = (3 * p[x] + q[x]) / 4;
        const glm::dvec4 alone = cell.at(at, shared), whole = cell.at(at, 0);
        for (int x = 0; x < 4; ++x) EXPECT_NEAR(alone[x], whole[x], 1e-12);
      }
  }
}

/// A box of n^3 cubes of cells of one kind, warped; each cell numbered from a corner of its own choice where `turned`,
/// and with points of its own, so that only positions tell that cells touch.
CellBlock warped_box(const Kind& kind, int n, const Warp& warp, const Field& field, bool turned) {
  CellBlock block;
  block.offsets = {0};
  std::vector<double> values, degrees;
  const auto lattice = curved_lattice(kind.type, kind.nodes, kind.degrees);
  std::mt19937 random(7);
  const auto add = [&](const std::function<glm::dvec3(const glm::dvec3&)>& to_box) {
    for (std::size_t k = 0; k < kind.nodes; ++k) {
      glm::dvec3 p = to_box(place_of(*lattice, k));
      for (int x = 0; x < 3; ++x) p[x] = std::round(p[x] * 360360) / 360360;  // one point for all cells that have it
      p = warp(p);
      block.connectivity.push_back(static_cast<std::uint32_t>(block.positions.size()));
      block.positions.push_back(p);
      values.push_back(field(p));
    }
    block.types.push_back(kind.type);
    block.offsets.push_back(block.connectivity.size());
    for (const int d : kind.degrees) degrees.push_back(d);
  };
  static constexpr int kuhn[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  for (int c = 0; c < n * n * n; ++c) {
    const glm::dvec3 from = glm::dvec3(c % n, c / n % n, c / (n * n)) / static_cast<double>(n);
    const double h = 1.0 / n;
    switch (lattice->family) {
      case CurvedFamily::tet:
        for (const auto& axis : kuhn) {
          std::array<glm::dvec3, 4> corner = {from, from, from, from};
          for (int k = 0; k < 3; ++k)
            for (int after = k + 1; after < 4; ++after) corner[static_cast<std::size_t>(after)][axis[k]] += h;
          if (turned) std::shuffle(corner.begin(), corner.end(), random);
          add([=](const glm::dvec3& x) {
            return corner[0] * (1 - x.x - x.y - x.z) + corner[1] * x.x + corner[2] * x.y + corner[3] * x.z;
          });
        }
        break;
      case CurvedFamily::hexahedron: {
        // Not all sides of a 24-node hexahedron have nodes in their middles, nor one order those of different ones.
        const bool may_turn = turned && kind.type != 33 && kind.degrees[0] == kind.degrees[2];
        const int turn = may_turn ? static_cast<int>(random() % 3) : 0;
        const bool flip = turned && random() % 2 == 0;
        add([=](const glm::dvec3& x) {
          glm::dvec3 y(x[turn % 3], x[(turn + 1) % 3], x[(turn + 2) % 3]);
          if (flip) y = glm::dvec3(1 - y.x, 1 - y.y, y.z);
          return from + h * y;
        });
        break;
      }
      case CurvedFamily::wedge:
        for (const bool upper : {false, true}) {
          std::array<glm::dvec2, 3> corner = {glm::dvec2(0, 0), glm::dvec2(1, upper ? 1 : 0),
                                              glm::dvec2(upper ? 0 : 1, 1)};
          if (turned) std::rotate(corner.begin(), corner.begin() + static_cast<int>(random() % 3), corner.end());
          add([=](const glm::dvec3& x) {
            const glm::dvec2 y = corner[0] * (1 - x.x - x.y) + corner[1] * x.x + corner[2] * x.y;
            return from + h * glm::dvec3(y.x, y.y, x.z);
          });
        }
        break;
      case CurvedFamily::pyramid:
        for (int side = 0; side < 6; ++side)  // base on a side of the cube, apex in its middle
          add([=](const glm::dvec3& x) {
            const double u = x.x + x.z / 2, v = x.y + x.z / 2, w = x.z / 2;
            const glm::dvec3 y = side < 3 ? glm::dvec3(u, v, w) : glm::dvec3(v, u, 1 - w);
            return from + h * glm::dvec3(y[side % 3], y[(side + 1) % 3], y[(side + 2) % 3]);
          });
        break;
    }
  }
  block.fields.push_back(field_of_values("f", "double", Association::point, 1, std::move(values)));
  if (kind.degrees[0] > 0)
    block.fields.push_back(field_of_values("HigherOrderDegrees", "double", Association::cell, 3, std::move(degrees)));
  return block;
}

glm::dvec3 bent(const glm::dvec3& p) {
  return {p.x + 0.05 * std::sin(3 * p.y + p.z), p.y + 0.05 * std::sin(2 * p.z + p.x), p.z + 0.05 * std::sin(4 * p.x)};
}

MeshOptions tolerance(double relative) {
  MeshOptions options;
  options.higher_order_tolerance = relative;
  options.field = "point:f";
  return options;
}

TEST(CurvedSplit, LeavesNoCracksWhateverTheNumbering) {
  const Field wavy = [](const glm::dvec3& p) { return std::sin(9 * p.x * p.y) + p.z * p.z; };
  for (const Kind& kind : kinds)
    for (const bool turned : {false, true}) {
      SCOPED_TRACE(::testing::PrintToString(static_cast<int>(kind.type)) + (turned ? " turned" : ""));
      // Triangles on the sides of the box, whose curved surface is told by the places they come from: those used once
      // must enclose what the tets fill, so a crack would show as a triangle inside.
      const MeshFile file = assemble_mesh({warped_box(kind, 2, bent, wavy, turned)}, tolerance(1e-2), "mesh");
      EXPECT_EQ(file.higher_order.by_corners, 0u);
      EXPECT_GT(file.higher_order.tets, file.higher_order.divided * 2);
      EXPECT_LE(file.higher_order.position_error, 1e-2 * 2);
      std::size_t inside = 0, once = 0;
      glm::dvec3 low(1e9), high(-1e9);
      for (const glm::dvec3& p : file.mesh.positions) low = glm::min(low, p), high = glm::max(high, p);
      std::map<std::array<testing::Point, 2>, int> rim;
      for (const auto& [triangle, uses] : testing::count_triangles(file.mesh)) {
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
      // Cracks would also add surface: its number of parts is Euler's.
      std::map<testing::Point, int> corners;
      for (const auto& [edge, uses] : rim) ++corners[edge[0]], ++corners[edge[1]];
      EXPECT_EQ(static_cast<long>(corners.size()) - static_cast<long>(rim.size()) + static_cast<long>(once), 2)
          << "the surface is not one ball's";
    }
}

/// The largest difference between the field of tets and `truth` at random points of them.
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
  for (const Kind& kind : kinds) {
    if (kind.degree < 2) continue;
    for (const double relative : {1e-1, 1e-2, 1e-3}) {
      SCOPED_TRACE(::testing::PrintToString(static_cast<int>(kind.type)) + " " + ::testing::PrintToString(relative));
      const MeshFile file =
          assemble_mesh({warped_box(kind, 1, straight, quadratic, true)}, tolerance(relative), "mesh");
      const double range = 4;  // -1 ... 2.5, nearly
      const double worst = worst_difference(file.mesh, quadratic, 4);
      EXPECT_LE(worst, file.higher_order.field_error + 1e-12);
      EXPECT_LE(file.higher_order.field_error, relative * range);
      EXPECT_GT(worst, 0.02 * file.higher_order.field_error) << "the bound is no use";
      EXPECT_LE(file.higher_order.position_error, 1e-11);  // rounding, times what a degree of 9 makes of it
      EXPECT_NEAR(testing::volume(file.mesh), 1, 1e-12);
    }
  }
}

TEST(CurvedSplit, KeepsALinearFieldOnCurvedCells) {
  const Field linear = [](const glm::dvec3& p) { return 1 + p.x - 2 * p.y + 3 * p.z; };
  for (const Kind& kind : kinds) {
    if (kind.type == 27 || kind.type == 31) continue;  // whose functions of a curved face are not all of its positions
    const MeshFile file = assemble_mesh({warped_box(kind, 2, bent, linear, false)}, tolerance(1e-2), "mesh");
    EXPECT_LE(worst_difference(file.mesh, linear, 1), 1e-12) << static_cast<int>(kind.type);
    EXPECT_LE(file.higher_order.field_error, 1e-11) << static_cast<int>(kind.type);
  }
}

TEST(CurvedSplit, NeedsMoreTetsForLessError) {
  const Field wavy = [](const glm::dvec3& p) { return std::sin(5 * p.x) + p.y; };
  std::uint64_t before = 0;
  for (const double relative : {1e-1, 3e-2, 1e-2, 3e-3}) {
    const MeshFile file = assemble_mesh({warped_box(kinds[0], 2, bent, wavy, false)}, tolerance(relative), "mesh");
    EXPECT_GT(file.higher_order.tets, before);
    EXPECT_EQ(file.higher_order.tolerance, relative);
    before = file.higher_order.tets;
  }
}

TEST(CurvedSplit, LoosensItsToleranceWhereThatTakesTooManyTets) {
  const Field wavy = [](const glm::dvec3& p) { return std::sin(5 * p.x) + p.y; };
  MeshOptions options = tolerance(1e-6);
  options.higher_order_tets = 20000;
  const MeshFile file = assemble_mesh({warped_box(kinds[4], 2, bent, wavy, false)}, options, "mesh");
  EXPECT_GT(file.higher_order.tolerance, 1e-6);
  EXPECT_LE(file.higher_order.tets, 60000u) << "about so many, not three times";
  EXPECT_GE(file.higher_order.tets, 2000u) << "and not a tenth";
  options.higher_order_tets = 0;
  const MeshFile corners = assemble_mesh({warped_box(kinds[4], 2, bent, wavy, false)}, options, "mesh");
  EXPECT_EQ(corners.higher_order.by_corners, 8u);
  EXPECT_EQ(corners.mesh.tets.size() % 8, 0u);
  EXPECT_EQ(warnings_on_cells(corners.higher_order).size(), 1u);
}

TEST(CurvedSplit, FillsWhatTheCellsFill) {
  // A box that quadratic cells bend exactly: the integral of (1 + 0.4 x) (1 + 0.2 z).
  const Warp bend = [](const glm::dvec3& p) { return glm::dvec3(p.x + 0.2 * p.x * p.x, p.y + 0.2 * p.y * p.z, p.z); };
  const Field one = [](const glm::dvec3&) { return 1.0; };
  for (const Kind& kind : kinds) {
    if (kind.degree < 2 || kind.type == 27) continue;
    for (const double relative : {1e-2, 1e-3}) {
      const MeshFile file = assemble_mesh({warped_box(kind, 1, bend, one, false)}, tolerance(relative), "mesh");
      // The surface, of 6.9, is nowhere off by more than that.
      EXPECT_NEAR(testing::volume(file.mesh), 1.32, 7 * file.higher_order.position_error);
      EXPECT_LE(file.higher_order.position_error, 2 * relative);  // the diagonal is 2
    }
  }
}

}  // namespace
}  // namespace tessera::io
