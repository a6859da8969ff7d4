// SPDX-License-Identifier: BSD-3-Clause
#include "reference/curved/curved_shapes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "reference/curved_cells.hpp"
#include "scene/error.hpp"

namespace tessera::reference::curved_shapes_test {
namespace {

/// Rounding error of shape functions: sums of at most 125 terms (order 5), whose values are at most 10.
constexpr double rounding = 1e-12;

/// Places in a cell's domain.
std::vector<glm::dvec3> places_in(Domain domain, int count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<glm::dvec3> places;
  while (places.size() < static_cast<std::size_t>(count)) {
    const glm::dvec3 place(unit(random), unit(random), unit(random));
    if (holds(domain, place, 0)) places.push_back(place);
  }
  return places;
}

TEST(CurvedShapes, EachIsOneAtItsNodeAndZeroAtTheOthers) {
  for (const TypeCase& type : all_types()) {
    if (type.bezier) continue;
    const CellShape shape = type.shape();
    ASSERT_EQ(shape.nodes.size(), type.nodes) << type.name;
    for (std::size_t node = 0; node < type.nodes; ++node) {
      const std::vector<double> values = shape_functions(shape, shape.nodes[node]);
      for (std::size_t i = 0; i < type.nodes; ++i)
        EXPECT_NEAR(values[i], i == node ? 1 : 0, rounding) << type.name << " node " << node << " function " << i;
    }
  }
}

TEST(CurvedShapes, SumToOne) {
  for (const TypeCase& type : all_types()) {
    const CellShape shape = type.shape();
    for (const glm::dvec3& place : places_in(shape.basis.domain(), 20)) {
      const std::vector<double> values = shape_functions(shape, place);
      EXPECT_NEAR(std::accumulate(values.begin(), values.end(), 0.0), 1, rounding) << type.name;
    }
  }
}

TEST(CurvedShapes, ReproducePolynomialsOfTheirDegree) {
  for (const TypeCase& type : all_types()) {
    if (type.bezier && type.degree > 1) continue;
    const CellShape shape = type.shape();
    for (int k = 0; k <= type.degree; ++k)
      for (int j = 0; j + k <= type.degree; ++j)
        for (int i = 0; i + j + k <= type.degree; ++i)
          for (const glm::dvec3& place : places_in(shape.basis.domain(), 5)) {
            const auto polynomial = [&](const glm::dvec3& p) {
              const glm::dvec3 q = polytope_place(type, p);
              return std::pow(q.x, i) * std::pow(q.y, j) * std::pow(q.z, k);
            };
            const std::vector<double> values = shape_functions(shape, place);
            double sum = 0;
            for (std::size_t node = 0; node < type.nodes; ++node) sum += values[node] * polynomial(shape.nodes[node]);
            EXPECT_NEAR(sum, polynomial(place), rounding) << type.name << ": " << i << " " << j << " " << k;
          }
  }
}

TEST(CurvedShapes, OfTheQuadraticPyramidReproduceSecondDegreeButTheSumOfSquares) {
  for (const TypeCase& type : all_types()) {
    if (type.type != 27) continue;
    const CellShape shape = type.shape();
    const std::vector<Scalar> polynomials{
        [](const glm::dvec3& p) { return p.z * p.z; },
        [](const glm::dvec3& p) { return (p.x - 0.5) * (p.y - 0.5); },
        [](const glm::dvec3& p) { return (p.x - 0.5) * p.z + 2 * (p.y - 0.5) * p.z; },
        [](const glm::dvec3& p) { return (p.x - 0.5) * (p.x - 0.5) - (p.y - 0.5) * (p.y - 0.5); },
    };
    for (const Scalar& polynomial : polynomials)
      for (const glm::dvec3& place : places_in(Domain::box, 5)) {
        const std::vector<double> values = shape_functions(shape, place);
        double sum = 0;
        for (std::size_t node = 0; node < type.nodes; ++node)
          sum += values[node] * polynomial(polytope_place(type, shape.nodes[node]));
        EXPECT_NEAR(sum, polynomial(polytope_place(type, place)), rounding);
      }
  }
}

TEST(CurvedShapes, OfLagrangeCellsAreProductsInEachDirection) {
  const CellShape shape = cell_shape(72, 60, {3, 2, 4}, "test");
  for (const glm::dvec3& place : places_in(Domain::box, 5)) {
    const std::vector<double> values = shape_functions(shape, place);
    double sum = 0;
    const auto polynomial = [](const glm::dvec3& p) { return p.x * p.x * p.x * p.y * p.y * std::pow(p.z, 4); };
    for (std::size_t node = 0; node < values.size(); ++node) sum += values[node] * polynomial(shape.nodes[node]);
    EXPECT_NEAR(sum, polynomial(place), rounding);
  }
}

TEST(CurvedShapes, GradientsAreThoseOfFiniteDifferences) {
  constexpr double step = 1e-5;
  for (const TypeCase& type : all_types()) {
    const CellShape shape = type.shape();
    const std::size_t n = shape.basis.size();
    std::vector<double> low(n), high(n), values(n);
    std::vector<glm::dvec3> gradients(n), unused(n);
    for (const glm::dvec3& place : places_in(shape.basis.domain(), 3)) {
      for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 before = place, after = place;
        before[axis] -= step, after[axis] += step;
        shape.basis.evaluate(before, low, unused);
        shape.basis.evaluate(after, high, unused);
        shape.basis.evaluate(place, values, gradients);
        // For order five, third derivatives reach several hundred; the error is step^2 times these derivatives.
        for (std::size_t i = 0; i < n; ++i)
          EXPECT_NEAR((high[i] - low[i]) / (2 * step), gradients[i][axis], 1e-7) << type.name;
      }
    }
  }
}

TEST(CurvedShapes, FacesAreTheCellsOwnOnThem) {
  for (const TypeCase& type : all_types()) {
    const CellShape shape = type.shape();
    std::vector<double> values(shape.basis.size());
    std::vector<glm::dvec3> gradients(shape.basis.size());
    for (const FacePatch& face : shape.faces) {
      const glm::dvec3 place = face.origin + 0.3 * face.along_u + 0.45 * face.along_v;
      EXPECT_TRUE(holds(shape.basis.domain(), place, 1e-15));
      EXPECT_FALSE(holds(shape.basis.domain(), place + (place - glm::dvec3(0.25)) * 1e-3, 1e-15));
      shape.basis.evaluate(place, values, gradients);
      double on_face = 0;
      for (const std::size_t i : face.control) on_face += values[i];
      EXPECT_NEAR(on_face, 1, rounding) << type.name;  // all others vanish, because they are not negative in the domain
    }
  }
}

/// Some nodes of each numbering, as in VTK.
TEST(CurvedShapes, NodesAreInVtksOrder) {
  struct Known {
    std::uint8_t type;
    std::size_t nodes;
    std::array<int, 3> orders;
    std::size_t node;
    glm::dvec3 place;
  };
  const double third = 1.0 / 3, two = 2.0 / 3, quarter = 0.25, half = 0.5;
  const std::vector<Known> known{
      {10, 4, {}, 3, {0, 0, 1}},
      {11, 8, {}, 2, {0, 1, 0}},
      {11, 8, {}, 7, {1, 1, 1}},
      {12, 8, {}, 2, {1, 1, 0}},
      {12, 8, {}, 7, {0, 1, 1}},
      {13, 6, {}, 4, {1, 0, 1}},
      {14, 5, {}, 2, {1, 1, 0}},
      {24, 10, {}, 5, {half, half, 0}},
      {24, 10, {}, 8, {half, 0, half}},
      {25, 20, {}, 9, {1, half, 0}},
      {25, 20, {}, 10, {half, 1, 0}},
      {25, 20, {}, 18, {1, 1, half}},
      {26, 15, {}, 8, {0, half, 0}},
      {26, 15, {}, 13, {1, 0, half}},
      {27, 13, {}, 7, {half, 1, 0}},
      {27, 13, {}, 11, {1, 1, half}},
      {29, 27, {}, 20, {0, half, half}},
      {29, 27, {}, 23, {half, 1, half}},
      {29, 27, {}, 24, {half, half, 0}},
      {31, 12, {}, 10, {half, half, 1}},
      {32, 18, {}, 16, {half, half, half}},
      {33, 24, {}, 22, {half, 0, half}},
      {37, 19, {}, 13, {half, half, 0}},
      {37, 19, {}, 15, {1, half, third}},
      {37, 19, {}, 18, {half, half, quarter}},
      // Edges, faces and inside of Lagrange cells.
      {71, 20, {}, 6, {two, third, 0}},
      {71, 20, {}, 8, {0, two, 0}},
      {71, 20, {}, 17, {third, third, third}},
      {71, 35, {}, 26, {quarter, quarter, half}},
      {71, 35, {}, 29, {0, quarter, half}},
      {71, 35, {}, 34, {quarter, quarter, quarter}},
      {71, 84, {}, 81, {1.0 / 6, 1.0 / 6, third}},
      {72, 60, {3, 2, 4}, 11, {third, 1, 0}},
      {72, 60, {3, 2, 4}, 26, {1, 1, quarter}},
      {72, 60, {3, 2, 4}, 32, {0, half, quarter}},
      {72, 60, {3, 2, 4}, 39, {two, 0, quarter}},
      {72, 60, {3, 2, 4}, 51, {two, half, 0}},
      {72, 60, {3, 2, 4}, 56, {third, half, half}},
      {73, 30, {3, 3, 2}, 8, {two, third, 0}},
      {73, 30, {3, 3, 2}, 27, {0, two, half}},
      {73, 60, {4, 4, 3}, 31, {half, quarter, 0}},
      {73, 60, {4, 4, 3}, 48, {0, 0.75, third}},
      {73, 60, {4, 4, 3}, 59, {quarter, half, two}},
      {73, 21, {}, 15, {third, third, 0}},
      {73, 21, {}, 20, {third, third, half}},
      {71, 15, {}, 12, {third, third, third}},
      // Some of the second-order nodes.
      {71, 5, {}, 4, {quarter, quarter, quarter}},
      {71, 7, {}, 6, {0, half, 0}},
      {71, 8, {}, 7, {0, third, third}},
      {71, 11, {}, 10, {quarter, quarter, quarter}},
      {71, 14, {}, 11, {third, 0, third}},
      {72, 9, {}, 8, {half, half, half}},
      {72, 16, {}, 12, {half, 0, 1}},
      {72, 21, {}, 20, {half, half, half}},
      {72, 26, {}, 25, {half, half, 1}},
      {73, 16, {}, 15, {third, third, half}},
      {73, 20, {}, 19, {0, half, half}},
  };
  for (const Known& k : known) {
    const CellShape shape = cell_shape(k.type, k.nodes, k.orders, "test");
    const glm::dvec3 found = shape.nodes.at(k.node);
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(found[axis], k.place[axis], 1e-15)
          << "type " << int{k.type} << " of " << k.nodes << ", node " << k.node;
  }
}

TEST(CurvedShapes, RefuseWhatIsNotACell) {
  EXPECT_THROW(cell_shape(24, 9, {}, "test"), scene::Error);
  EXPECT_THROW(cell_shape(42, 8, {}, "test"), scene::Error);
  EXPECT_THROW(cell_shape(71, 12, {}, "test"), scene::Error);
  EXPECT_THROW(cell_shape(72, 60, {}, "test"), scene::Error);  // not a cube
  EXPECT_THROW(cell_shape(72, 60, {3, 2, 3}, "test"), scene::Error);
  EXPECT_THROW(cell_shape(72, 8, {-1, 3, 3}, "test"), scene::Error);
  EXPECT_THROW(cell_shape(72, 60, {2147483647, 2, 4}, "test"), scene::Error);
  EXPECT_THROW(cell_shape(73, 30, {3, 2, 2}, "test"), scene::Error);
  EXPECT_THROW(cell_shape(72, 1728, {11, 11, 11}, "test"), scene::Error);
  EXPECT_THROW(cell_shape(72, std::size_t{1} << 40, {}, "test"), scene::Error);
}

}  // namespace
}  // namespace tessera::reference::curved_shapes_test
