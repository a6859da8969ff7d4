// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "reference/curved_cells.hpp"
#include "reference/grid/grid_integral.hpp"
#include "reference/polynomial.hpp"
#include "reference/reference.hpp"
#include "reference/small_meshes.hpp"
#include "support/some_cases.hpp"

namespace tessera::reference::curved_closed_form_test {
namespace {

using scene::ProjectionKind;
using scene::TransferFunction;

constexpr scene::ImageSize size{18, 18};

/// Lengths between crossings of faces are of order one. Seen from a distance of 5, they have a rounding error of 1e-15.
/// Faces that rays meet at a slope of at least a hundredth magnify it by 100; a factor of ten allows for the rounding
/// of the closed form.
constexpr double rounding = 1e-12;

/// The map (x, y, z) -> (x, y, z + q(x, y)), for which every cell type with the degree of q gives an exact curved cell,
/// and which can be inverted in closed form.
struct Bend {
  struct Term {
    int i, j;
    double factor;
  };
  std::vector<Term> terms;

  [[nodiscard]] double lift(double x, double y) const {
    double sum = 0;
    for (const Term& t : terms) sum += t.factor * std::pow(x, t.i) * std::pow(y, t.j);
    return sum;
  }
  [[nodiscard]] glm::dvec3 operator()(const glm::dvec3& p) const { return {p.x, p.y, p.z + lift(p.x, p.y)}; }
};

/// Depths are relative to this: their powers are then of order one.
constexpr double middle_depth = 5;

/// A ray mapped back: its coordinates by planar depth, as polynomials.
std::array<Polynomial, 3> unbent(const WorldRay& ray, const Bend& bend) {
  std::array<Polynomial, 3> p;
  for (int a = 0; a < 3; ++a)
    p[static_cast<std::size_t>(a)] = {{ray.origin[a] + middle_depth * ray.direction[a], ray.direction[a]}};
  Polynomial lift{{0}};
  for (const Bend::Term& t : bend.terms) {
    Polynomial term{{t.factor}};
    for (int n = 0; n < t.i; ++n) term = term * p[0];
    for (int n = 0; n < t.j; ++n) term = term * p[1];
    lift = lift + term;
  }
  p[2] = p[2] + -1 * lift;
  return p;
}

/// A half space a x + b y + c z + d >= 0.
using HalfSpace = std::array<double, 4>;

std::vector<HalfSpace> polytope(const TypeCase& type) {
  if (type.pyramid) return {{0, 0, 1, 0}, {1, 0, -0.5, 0}, {-1, 0, -0.5, 1}, {0, 1, -0.5, 0}, {0, -1, -0.5, 1}};
  switch (type.shape().basis.domain()) {
    case Domain::tet:
      return {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {-1, -1, -1, 1}};
    case Domain::prism:
      return {{1, 0, 0, 0}, {0, 1, 0, 0}, {-1, -1, 0, 1}, {0, 0, 1, 0}, {0, 0, -1, 1}};
    default:
      return {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {-1, 0, 0, 1}, {0, -1, 0, 1}, {0, 0, -1, 1}};
  }
}

/// Intervals of planar depth within all half-spaces.
std::vector<DepthRange> inside(const std::array<Polynomial, 3>& ray, const std::vector<HalfSpace>& half_spaces) {
  constexpr double near = -4, far = 7;
  std::vector<Polynomial> constraints;
  std::vector<double> ends{near, far};
  for (const HalfSpace& h : half_spaces) {
    constraints.push_back(h[0] * ray[0] + h[1] * ray[1] + h[2] * ray[2] + Polynomial{{h[3]}});
    for (const double z : constraints.back().roots(near, far)) ends.push_back(z);
  }
  std::sort(ends.begin(), ends.end());
  std::vector<DepthRange> ranges;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const double middle = (ends[i] + ends[i + 1]) / 2;
    if (std::all_of(constraints.begin(), constraints.end(), [&](const Polynomial& p) { return p.at(middle) > 0; }))
      ranges.push_back({ends[i], ends[i + 1]});
  }
  return ranges;
}

/// A bend that the type represents exactly: of its degree; for a pyramid of 13 nodes, the second-degree terms that it
/// has.
Bend bend_of(const TypeCase& type) {
  if (type.type == 27 && type.pyramid) return {{{1, 1, 0.9}, {2, 0, 0.4}, {0, 2, -0.4}, {1, 0, -0.3}}};
  const int degree = type.type == 31 ? 2 : type.degree;  // quadratic in the triangle
  Bend bend{{{1, 0, -0.4}, {0, 1, 0.3}}};
  if (degree >= 2) bend.terms.insert(bend.terms.end(), {{2, 0, 0.9}, {1, 1, -0.8}, {0, 2, 0.7}});
  if (degree >= 3) bend.terms.insert(bend.terms.end(), {{3, 0, -0.6}, {1, 2, 0.8}});
  if (degree >= 4) bend.terms.insert(bend.terms.end(), {{2, 2, 0.9}, {0, 4, -0.5}});
  return bend;
}

std::vector<scene::Camera> cameras() {
  const glm::dvec3 centre(0.5, 0.5, 0.6);
  return {looking(centre + glm::dvec3(1.2, -4.3, 1.9), centre, ProjectionKind::perspective, 24, {0, 0, 1}),
          looking(centre + glm::dvec3(3.4, 2.8, 0.35), centre, ProjectionKind::perspective, 24, {0, 0, 1}),
          looking(centre + glm::dvec3(-2.1, -1.7, 4.1), centre, ProjectionKind::orthographic, 0.9, {0, 1, 0})};
}

/// Linear cells and Bezier ones are given a linear map.
Bend bend_or_shear(const TypeCase& type) {
  Bend bend = bend_of(type);
  if (type.bezier) bend.terms.resize(2);
  return bend;
}

/// Compares all pixels of one bent cell with the closed form. Returns how many rays meet it, and how many twice.
std::array<int, 2> expect_true_lengths(const TypeCase& type, const Bend& bend, const scene::Camera& camera) {
  const TransferFunction transfer_function({{0, {1, 0.5, 0.25}, 0.8}});
  CurvedMesh mesh;
  mesh.add(type, bend, [](const glm::dvec3&) { return 1.0; });
  const CurvedReference reference(mesh.cells(), camera, size, transfer_function);
  std::array<int, 2> hits{0, 0};
  for (const PixelIndex& p : all_pixels(size)) {
    const double x = p.x + 0.4873, y = p.y + 0.5241;
    const WorldRay ray = world_ray(camera, size, x, y);
    double length = 0;
    const std::vector<DepthRange> ranges = inside(unbent(ray, bend), polytope(type));
    for (const DepthRange& range : ranges) length += range.size() * glm::length(ray.direction);
    const Pixel found = reference.pixel(x, y);
    EXPECT_NEAR(found.length, length, rounding) << type.name << " at " << x << ", " << y;
    EXPECT_NEAR(found.a, -std::expm1(-0.8 * length), rounding) << type.name;
    EXPECT_NEAR(found.g, 0.5 * found.a, rounding);
    hits[0] += found.length > 0 ? 1 : 0;
    hits[1] += ranges.size() > 1 && ranges[1].low > ranges[0].high ? 1 : 0;
  }
  return hits;
}

TEST(CurvedReference, FindsTheTrueLengthOfEveryTypesBentCell) {
  test::SomeCases some(5);
  for (const TypeCase& type : all_types())
    for (const scene::Camera& camera : cameras())
      if (some.next()) {
        EXPECT_GT(expect_true_lengths(type, bend_or_shear(type), camera)[0], 20) << type.name;
      }
}

TEST(CurvedReference, FindsBothStretchesWhereARayLeavesACellAndComesBack) {
  const glm::dvec3 centre(0.5, 0.5, 0.6);
  for (const TypeCase& type : all_types()) {
    if (type.degree < 2 || type.bezier) continue;
    const Bend bend{{{2, 0, 6}, {1, 0, -6}, {1, 1, 0.3}, {0, 0, 1}}};  // two legs
    const scene::Camera camera =
        looking(centre + glm::dvec3(5, 0.4, -0.3), centre, ProjectionKind::perspective, 24, {0, 0, 1});
    EXPECT_GT(expect_true_lengths(type, bend, camera)[1], 5) << type.name;
  }
}

/// A field of the cell's coordinates that is linear in (x, y) and in the height before the bend, with squares if the
/// type has second degree.
TEST(CurvedReference, IntegratesTheFieldOfEveryTypesBentCell) {
  // Extinction and colour are linear over the whole range: the optical depth is a polynomial's integral.
  const TransferFunction transfer_function({{-4, {0, 1, 0.5}, 0}, {4, {1, 0, 0.5}, 3.2}});
  test::SomeCases some(4);
  for (const TypeCase& type : all_types()) {
    if (!some.next()) continue;
    const Bend bend = bend_or_shear(type);
    const bool squares = type.degree >= 2 && !type.bezier;
    const auto field = [&](const auto& x, const auto& y, const auto& z) {
      auto f = 0.7 * x + -0.9 * y + 1.1 * z;
      if (squares) f = f + 0.8 * (x * x) + -0.6 * (y * z) + 0.5 * (z * z);
      return f;
    };
    CurvedMesh mesh;
    mesh.add(type, bend, [&](const glm::dvec3& p) { return field(p.x, p.y, p.z); });
    const scene::Camera camera = cameras()[0];
    const CurvedReference reference(mesh.cells(), camera, size, transfer_function);
    int hits = 0;
    for (int n = 0; n < 100; ++n) {
      const double x = 1.13 + 1.7 * (n % 10), y = 1.37 + 1.7 * (n / 10);
      const WorldRay ray = world_ray(camera, size, x, y);
      const auto p = unbent(ray, bend);
      const double scale = glm::length(ray.direction);
      const Polynomial f = field(p[0], p[1], p[2]), extinction = scale * (0.4 * f + Polynomial{{1.6}});
      double depth = 0, red = 0;
      for (const DepthRange& range : inside(p, polytope(type))) {
        // Light by Simpson's rule, fine enough for 1e-12: red is 0.5 + f / 8.
        constexpr int steps = 2000;
        for (int i = 0; i <= steps; ++i) {
          const double z = range.low + range.size() * i / steps, weight = i % steps == 0 ? 1 : i % 2 == 1 ? 4 : 2;
          red += weight * range.size() / steps / 3 * extinction.at(z) * (0.5 + f.at(z) / 8) *
                 std::exp(-depth - extinction.integral(range.low, z));
        }
        depth += extinction.integral(range.low, range.high);
      }
      const Pixel found = reference.pixel(x, y);
      ASSERT_NEAR(found.a, -std::expm1(-depth), rounding) << type.name << " at " << x << ", " << y;
      ASSERT_NEAR(found.r, red, rounding) << type.name;
      hits += depth > 0 ? 1 : 0;
    }
    EXPECT_GT(hits, 5) << type.name;
  }
}

/// Steps and steep ramps, where the field is at most cubic along rays, compared with the integral for grids.
TEST(CurvedReference, SeesTheKnotsOfTheTransferFunctionWhereTheFieldPassesThem) {
  // A step is a hundred units of extinction. Rounding of the field moves the step by 1e-15, and by a hundred times as
  // much where the field almost has a turning point.
  constexpr double error = 1e-11;
  const TransferFunction transfer_function({{-0.5, {1, 0, 0}, 0},
                                            {-0.2, {1, 1, 0}, 2},
                                            {-0.2, {0, 1, 0}, 0},
                                            {0.1, {0, 1, 1}, 0},
                                            {0.1, {0, 1, 1}, 100},
                                            {0.11, {0, 0, 1}, 100},
                                            {0.11, {1, 0, 1}, 0.5},
                                            {0.5, {1, 0.2, 0}, 3},
                                            {0.501, {0, 1, 0}, 40},
                                            {0.502, {1, 1, 1}, 0}});
  for (const TypeCase& type : all_types()) {
    const Bend bend = bend_or_shear(type);
    const auto field = [&](const auto& x, const auto& y, const auto& z) {
      auto f = 1.3 * x + -1.1 * y;
      if (type.degree < 4) f = f + 0.9 * z;
      if (type.degree >= 2 && !type.bezier) f = f + 1.2 * (x * x) + -1.5 * (x * y);
      return f;
    };
    CurvedMesh mesh;
    mesh.add(type, bend, [&](const glm::dvec3& p) { return field(p.x, p.y, p.z); });
    for (const scene::Emission emission : {scene::Emission::absorption, scene::Emission::independent}) {
      const scene::Camera camera = cameras()[1];
      const CurvedReference reference(mesh.cells(), camera, size, transfer_function, emission);
      int hits = 0;
      for (int n = 0; n < 100; ++n) {
        const double x = 1.13 + 1.7 * (n % 10), y = 1.37 + 1.7 * (n / 10);
        const WorldRay ray = world_ray(camera, size, x, y);
        const auto p = unbent(ray, bend);
        const Polynomial f = field(p[0], p[1], p[2]);
        GridIntegral truth(transfer_function.knots(), emission);
        for (const DepthRange& range : inside(p, polytope(type))) {
          // As a cubic over [0, 1], from its derivatives at the front.
          Cubic cubic;
          Polynomial derivative = f;
          double factor = 1;
          for (std::size_t i = 0; i < 4; ++i) {
            cubic.c[i] = factor * derivative.at(range.low);
            derivative = derivative.derivative();
            factor *= range.size() / static_cast<double>(i + 1);
          }
          truth.add(range.size() * glm::length(ray.direction), cubic, middle_depth + range.low,
                    middle_depth + range.high);
        }
        const Pixel found = reference.pixel(x, y);
        ASSERT_NEAR(found.r, truth.color()[0], error) << type.name << " at " << x << ", " << y;
        ASSERT_NEAR(found.g, truth.color()[1], error) << type.name << " at " << x << ", " << y;
        ASSERT_NEAR(found.b, truth.color()[2], error) << type.name << " at " << x << ", " << y;
        ASSERT_NEAR(found.a, truth.opacity(), error) << type.name << " at " << x << ", " << y;
        if (std::isfinite(truth.first_visible_depth())) {
          ASSERT_NEAR(found.z, truth.first_visible_depth(), 1e-10) << type.name << " at " << x << ", " << y;
        }
        hits += truth.opacity() > 0 ? 1 : 0;
      }
      EXPECT_GT(hits, 5) << type.name;
    }
  }
}

/// Cells on top of and next to each other, of compatible types: the space between the outer faces is counted once.
TEST(CurvedReference, NeighboursShareACurvedFaceWithNoGapAndNoOverlap) {
  const auto types = all_types();
  const auto named = [&](const std::string& name) {
    return *std::find_if(types.begin(), types.end(), [&](const TypeCase& t) { return t.name == name; });
  };
  const Bend bend = bend_of(named("quadratic tet"));
  const auto placed = [&](auto map) { return [=](const glm::dvec3& p) { return bend(map(p)); }; };
  const Scalar one = [](const glm::dvec3&) { return 1.0; };
  CurvedMesh mesh;
  // The cube below is a hexahedron, the one above two wedges, the half cube on top of it a pyramid between four tets.
  mesh.add(named("triquadratic hexahedron"), placed([](const glm::dvec3& p) { return p; }), one);
  mesh.add(named("biquadratic-quadratic wedge"), placed([](const glm::dvec3& p) { return p + glm::dvec3(0, 0, 1); }),
           one);
  mesh.add(named("Lagrange wedge 2"), placed([](const glm::dvec3& p) { return glm::dvec3(1 - p.x, 1 - p.y, 1 + p.z); }),
           one);
  mesh.add(named("triquadratic pyramid"), placed([](const glm::dvec3& p) { return p + glm::dvec3(0, 0, 2); }), one);
  const std::vector<HalfSpace> column{{1, 0, 0, 0},  {0, 1, 0, 0},  {0, 0, 1, 0},
                                      {-1, 0, 0, 1}, {0, -1, 0, 1}, {0, 0, -1, 2}};
  const std::vector<HalfSpace> top{{0, 0, 1, -2}, {1, 0, -0.5, 1}, {-1, 0, -0.5, 2}, {0, 1, -0.5, 1}, {0, -1, -0.5, 2}};
  const glm::dvec3 centre(0.5, 0.5, 1.8);
  const scene::Camera camera =
      looking(centre + glm::dvec3(2, -4, 1.5), centre, ProjectionKind::perspective, 40, {0, 0, 1});
  const CurvedReference reference(mesh.cells(), camera, size, TransferFunction({{0, {1, 1, 1}, 1}}));
  int several = 0;
  for (const PixelIndex& p : all_pixels(size)) {
    const double x = p.x + 0.4873, y = p.y + 0.5241;
    const WorldRay ray = world_ray(camera, size, x, y);
    double length = 0;
    for (const auto& part : {column, top})
      for (const DepthRange& range : inside(unbent(ray, bend), part))
        length += range.size() * glm::length(ray.direction);
    const std::vector<CurvedSegment> segments = reference.segments(x, y);
    double found = 0;
    for (std::size_t i = 0; i < segments.size(); ++i) {
      found += segments[i].length;
      if (i == 0) continue;
      // No overlap, and no gap, up to rounding.
      const double gap = segments[i].front - segments[i - 1].back;
      EXPECT_GT(gap, -1e-12);
    }
    EXPECT_NEAR(found, length, rounding) << x << ", " << y;
    several += segments.size() > 2 ? 1 : 0;
  }
  EXPECT_GT(several, 8);
}

TEST(CurvedReference, OfStraightTetsMatchesTheTetReference) {
  const Field field = [](const glm::dvec3& p) { return p.x + 2 * p.y - 0.5 * p.z; };
  const TransferFunction transfer_function(
      {{-0.2, {1, 0, 0}, 0.1}, {0.4, {0, 1, 0}, 4}, {0.4, {0, 0, 1}, 0}, {1, {1, 1, 0}, 2}, {2, {0, 0, 1}, 0}});
  const scene::TetMesh tets = box_of_tets(2, {0, 0, 0}, {1, 1, 1}, field, 0.15);
  CurvedMesh linear, quadratic, per_cell;
  const CellShape shape = cell_shape(24, 10, {}, "test");
  for (std::size_t t = 0; t < tets.tets.size(); ++t) {
    std::vector<glm::dvec3> corners, nodes;
    for (const std::uint32_t v : tets.tets[t]) corners.push_back(tets.positions[v]);
    for (const glm::dvec3& p : shape.nodes)
      nodes.push_back(corners[0] + p.x * (corners[1] - corners[0]) + p.y * (corners[2] - corners[0]) +
                      p.z * (corners[3] - corners[0]));
    linear.add(10, {}, corners);
    quadratic.add(24, {}, nodes);
    for (const glm::dvec3& p : corners) linear.scalars.push_back(field(p));
    for (const glm::dvec3& p : nodes) quadratic.scalars.push_back(field(p));
  }
  per_cell = quadratic;
  per_cell.association = Association::cell;
  const scene::TetMesh constant = with_cell_data(tets, field);
  per_cell.scalars = constant.scalars;
  for (const scene::Camera& camera : cameras()) {
    // In orthographic views, the reference for tets rounds vertices by 2^-33 pixel, and the one for curved cells does
    // not. At steps, this changes the light.
    const double error = camera.projection == ProjectionKind::perspective ? 1e-10 : 1e-8;
    const Reference truth(tets, camera, size, transfer_function), of_cells(constant, camera, size, transfer_function);
    const CurvedReference one(linear.cells(), camera, size, transfer_function),
        two(quadratic.cells(), camera, size, transfer_function),
        three(per_cell.cells(), camera, size, transfer_function);
    for (const PixelIndex& p : all_pixels(size)) {
      const double x = p.x + 0.4873, y = p.y + 0.5241;
      const auto same = [&](const Pixel& found, const Pixel& wanted) {
        EXPECT_NEAR(found.r, wanted.r, error) << x << ", " << y;
        EXPECT_NEAR(found.g, wanted.g, error);
        EXPECT_NEAR(found.b, wanted.b, error);
        EXPECT_NEAR(found.a, wanted.a, error);
        EXPECT_NEAR(found.length, wanted.length, error);
        if (std::isfinite(wanted.z)) {
          EXPECT_NEAR(found.z, wanted.z, error);
        }
      };
      same(one.pixel(x, y), truth.pixel(x, y));
      same(two.pixel(x, y), truth.pixel(x, y));
      same(three.pixel(x, y), of_cells.pixel(x, y));
    }
  }
}

}  // namespace
}  // namespace tessera::reference::curved_closed_form_test
