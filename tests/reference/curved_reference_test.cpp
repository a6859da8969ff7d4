// SPDX-License-Identifier: BSD-3-Clause
#include "reference/curved/curved_reference.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <ctime>
#include <limits>
#include <random>

#include "reference/curved_cells.hpp"
#include "reference/small_meshes.hpp"
#include "scene/error.hpp"
#include "support/some_cases.hpp"

namespace tessera::reference::curved_reference_test {
namespace {

using scene::ProjectionKind;
using scene::TransferFunction;

constexpr scene::ImageSize size{32, 32};
constexpr double rounding = 1e-12;  // lengths of order one, seen from a few units away, up to flat crossings

const TypeCase& named(const std::string& name) {
  static const std::vector<TypeCase> types = all_types();
  return *std::find_if(types.begin(), types.end(), [&](const TypeCase& t) { return t.name == name; });
}

/// Smooth, not a polynomial, and close enough to the identity to be one-to-one.
glm::dvec3 warped(const glm::dvec3& p) {
  return p + 0.11 * glm::dvec3(std::sin(2 * p.y + p.z), std::cos(1.5 * p.x - 2 * p.z), std::sin(2.2 * p.x + 1.7 * p.y));
}
double any_field(const glm::dvec3& p) { return std::sin(1.7 * p.x + p.y) + p.z * p.z; }

/// A cell by brute force, independent of the reference's ray methods: points are inside if Newton's method finds their
/// place from some start.
class Brute {
 public:
  Brute(const TypeCase& type, const CurvedMesh& mesh) : shape_(type.shape()), mesh_(&mesh) {
    for (const double r : {0.2, 0.6})
      for (const double s : {0.2, 0.6})
        for (const double t : {0.2, 0.6}) starts_.emplace_back(r, s, t);
    starts_.emplace_back(0.25, 0.25, 0.25);
  }

  /// The position of a place.
  [[nodiscard]] glm::dvec3 point(const glm::dvec3& place) const {
    const std::vector<double> n = shape_functions(shape_, place);
    glm::dvec3 sum(0);
    for (std::size_t i = 0; i < n.size(); ++i) sum += n[i] * mesh_->positions[i];
    return sum;
  }
  [[nodiscard]] double scalar(const glm::dvec3& place) const {
    const std::vector<double> n = shape_functions(shape_, place);
    double sum = 0;
    for (std::size_t i = 0; i < n.size(); ++i) sum += n[i] * mesh_->scalars[i];
    return sum;
  }
  [[nodiscard]] std::optional<glm::dvec3> place(const glm::dvec3& wanted) const {
    if (last_)
      if (const auto found = from(wanted, *last_)) return last_ = found;
    for (const glm::dvec3& start : starts_)
      if (const auto found = from(wanted, start)) return last_ = found;
    return std::nullopt;
  }
  [[nodiscard]] bool is_inside(const glm::dvec3& p) const { return place(p).has_value(); }

 private:
  /// Newton's method with derivatives by differences.
  [[nodiscard]] std::optional<glm::dvec3> from(const glm::dvec3& wanted, glm::dvec3 place) const {
    constexpr double step = 1e-5;
    for (int n = 0; n < 20; ++n) {
      const glm::dvec3 missing = wanted - point(place);
      std::array<glm::dvec3, 3> d;
      for (int a = 0; a < 3; ++a) {
        glm::dvec3 aside(0);
        aside[a] = step;
        d[static_cast<std::size_t>(a)] = (point(place + aside) - point(place - aside)) / (2 * step);
      }
      const double determinant = glm::dot(d[0], glm::cross(d[1], d[2]));
      const glm::dvec3 move =
          glm::dvec3(glm::dot(missing, glm::cross(d[1], d[2])), glm::dot(missing, glm::cross(d[2], d[0])),
                     glm::dot(missing, glm::cross(d[0], d[1]))) /
          determinant;
      place += move;
      if (!(glm::length(place) < 5)) return std::nullopt;
      if (glm::length(move) < 1e-13) break;
      if (n == 19 && glm::length(move) > 1e-10) return std::nullopt;
    }
    return holds(shape_.basis.domain(), place, 0) ? std::optional(place) : std::nullopt;
  }

  CellShape shape_;
  const CurvedMesh* mesh_;
  std::vector<glm::dvec3> starts_;
  mutable std::optional<glm::dvec3> last_;
};

/// Depths of a ray inside a cell, by sampling and bisection.
std::vector<DepthRange> sampled(const Brute& cell, const WorldRay& ray, double near, double far) {
  constexpr int samples = 100;
  std::vector<DepthRange> ranges;
  const auto inside = [&](double z) { return cell.is_inside(ray.origin + z * ray.direction); };
  const auto edge = [&](double in, double out) {
    for (int n = 0; n < 50; ++n) {
      const double middle = (in + out) / 2;
      (inside(middle) ? in : out) = middle;
    }
    return in;
  };
  bool before = false;
  for (int i = 0; i <= samples; ++i) {
    const double z = near + (far - near) * i / samples, last = near + (far - near) * (i - 1) / samples;
    const bool now = inside(z);
    if (now && !before) ranges.push_back({edge(z, last), z});
    if (!now && before) ranges.back().high = edge(last, z);
    before = now;
  }
  return ranges;
}

TEST(CurvedReference, AgreesWithBruteForceInAnyCell) {
  // Bisection and differences give lengths to 1e-11; Simpson's rule with 200 steps gives the other results to 1e-9.
  constexpr double error = 2e-10;
  const TransferFunction transfer_function({{-2, {0, 1, 0.5}, 0}, {3, {1, 0, 0.5}, 4}});
  const scene::Camera camera = looking({2.9, -2.3, 2.6}, {0.4, 0.4, 0.4}, ProjectionKind::perspective, 30, {0, 0, 1});
  const double distance = glm::length(camera.position - camera.focal_point);
  const View view(camera, size);
  test::SomeCases some(7);
  for (const TypeCase& type : all_types()) {
    if (type.nodes > 30 || !some.next()) continue;  // brute force is slow
    CurvedMesh mesh;
    mesh.add(type, warped, any_field);
    const Brute brute(type, mesh);
    const CurvedReference reference(mesh.cells(), camera, size, transfer_function);
    for (const glm::dvec3& aim : {glm::dvec3(0.21, 0.33, 0.27), glm::dvec3(0.11, 0.24, 0.52),
                                  glm::dvec3(0.55, 0.14, 0.12), glm::dvec3(0.08, 0.43, 0.31)}) {
      const glm::dvec3 pixel = view.project(brute.point(aim)).homogeneous;
      const double x = pixel.x / pixel.z, y = pixel.y / pixel.z;
      const WorldRay ray = world_ray(camera, size, x, y);
      const double scale = glm::length(ray.direction);
      double length = 0, depth = 0;
      for (const DepthRange& range : sampled(brute, ray, distance - 1.5, distance + 1.5)) {
        length += range.size() * scale;
        constexpr int steps = 200;
        for (int i = 0; i <= steps; ++i) {
          const double z = range.low + range.size() * (i == 0 ? 1e-9 : i == steps ? 1 - 1e-9 : double(i) / steps);
          const auto place = brute.place(ray.origin + z * ray.direction);
          ASSERT_TRUE(place) << type.name;
          const double weight = i % steps == 0 ? 1 : i % 2 == 1 ? 4 : 2;
          depth += weight * range.size() * scale / steps / 3 * 0.8 * (brute.scalar(*place) + 2);
        }
      }
      const Pixel found = reference.pixel(x, y);
      EXPECT_NEAR(found.length, length, 1e-10) << type.name << " at " << x << ", " << y;
      EXPECT_NEAR(-std::log1p(-found.a), depth, error) << type.name << " at " << x << ", " << y;
      EXPECT_GT(length, 0.05) << type.name;
    }
  }
}

/// The same cell as two types.
void expect_same(const CurvedMesh& one, const CurvedMesh& other, const std::string& name) {
  const TransferFunction transfer_function(
      {{-1, {1, 0, 0}, 0.5}, {0.3, {0, 1, 0}, 2}, {0.3, {0, 0, 1}, 0}, {1, {1, 1, 0}, 3}});
  const scene::Camera camera = looking({2.9, -2.3, 2.6}, {0.5, 0.5, 0.4}, ProjectionKind::perspective, 30, {0, 0, 1});
  const CurvedReference a(one.cells(), camera, size, transfer_function),
      b(other.cells(), camera, size, transfer_function);
  int hits = 0;
  const std::vector<PixelIndex> all = all_pixels(size);
  const std::vector<Pixel> in_a = a.pixels(all), in_b = b.pixels(all);
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_NEAR(in_a[i].length, in_b[i].length, rounding) << name;
    EXPECT_NEAR(in_a[i].r, in_b[i].r, 10 * rounding) << name;
    EXPECT_NEAR(in_a[i].a, in_b[i].a, 10 * rounding) << name;
    hits += in_a[i].a > 0 ? 1 : 0;
  }
  EXPECT_GT(hits, 50) << name;
}

TEST(CurvedReference, IsTheSameForEveryTypeThatACellIsGivenAs) {
  const auto warped_as = [](const std::string& name) {
    CurvedMesh mesh;
    mesh.add(named(name), warped, any_field);
    return mesh;
  };
  expect_same(warped_as("quadratic tet"), warped_as("Lagrange tet 2"), "tet");
  expect_same(warped_as("triquadratic hexahedron"), warped_as("Lagrange hexahedron 2"), "hexahedron");
  expect_same(warped_as("biquadratic-quadratic wedge"), warped_as("Lagrange wedge 2"), "wedge");
  expect_same(warped_as("hexahedron"), warped_as("voxel"), "linear hexahedron");
  expect_same(warped_as("wedge"), warped_as("Lagrange wedge 1"), "linear wedge");

  /// Converts a cell to another type with the same functions, by evaluating it at that type's nodes.
  const auto as = [](const CurvedMesh& mesh, const TypeCase& from, const TypeCase& to) {
    CurvedMesh result;
    std::vector<glm::dvec3> points;
    for (const glm::dvec3& place : to.shape().nodes) {
      const std::vector<double> n = shape_functions(from.shape(), place);
      glm::dvec3 point(0);
      double scalar = 0;
      for (std::size_t i = 0; i < n.size(); ++i) point += n[i] * mesh.positions[i], scalar += n[i] * mesh.scalars[i];
      points.push_back(point);
      result.scalars.push_back(scalar);
    }
    result.add(to.type, to.orders, points);
    return result;
  };
  for (const auto& [from, to] :
       std::vector<std::pair<std::string, std::string>>{{"quadratic hexahedron", "triquadratic hexahedron"},
                                                        {"biquadratic-quadratic hexahedron", "Lagrange hexahedron 3"},
                                                        {"quadratic wedge", "Lagrange wedge 2"},
                                                        {"quadratic-linear wedge", "Lagrange wedge 3"},
                                                        {"quadratic pyramid", "Lagrange hexahedron 2"},
                                                        {"enriched Lagrange tet", "Lagrange tet 4"},
                                                        {"enriched Lagrange wedge", "Lagrange wedge 3"},
                                                        {"triquadratic hexahedron", "Lagrange hexahedron 3, 2, 4"},
                                                        {"Bezier tet 2", "quadratic tet"},
                                                        {"Bezier tet 3", "Lagrange tet 3"},
                                                        {"Bezier hexahedron 3", "Lagrange hexahedron 3"},
                                                        {"Bezier wedge 2", "Lagrange wedge 2"},
                                                        {"Bezier wedge 3", "Lagrange wedge 3"}})
    expect_same(warped_as(from), as(warped_as(from), named(from), named(to)), from + " as " + to);
}

TEST(CurvedReference, AHexahedronWithCoincidingNodesIsAWedge) {
  CurvedMesh wedge, collapsed;
  wedge.add(named("wedge"), warped, any_field);
  const std::vector<glm::dvec3>& p = wedge.positions;
  const std::vector<double>& f = wedge.scalars;
  collapsed.add(12, {}, {p[0], p[1], p[2], p[2], p[3], p[4], p[5], p[5]});
  collapsed.scalars = {f[0], f[1], f[2], f[2], f[3], f[4], f[5], f[5]};
  expect_same(wedge, collapsed, "collapsed hexahedron");
}

/// Six hexahedra of one order between the surface of a cube of half side 0.3 and the unit sphere, and one in the cube.
CurvedMesh ball_of(int order) {
  const TypeCase& type = named("Lagrange hexahedron " + std::to_string(order));
  CurvedMesh mesh;
  const Scalar one = [](const glm::dvec3&) { return 1.0; };
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0})
      mesh.add(
          type,
          [=](const glm::dvec3& p) {
            glm::dvec3 on_cube;
            on_cube[axis] = side;
            on_cube[(axis + 1) % 3] = 2 * p.x - 1;
            on_cube[(axis + 2) % 3] = 2 * p.y - 1;
            return 0.3 * (1 - p.z) * on_cube + p.z * glm::normalize(on_cube);
          },
          one);
  mesh.add(
      type, [](const glm::dvec3& p) { return 0.6 * p - 0.3; }, one);
  return mesh;
}

TEST(CurvedReference, BallsOfHigherOrderConvergeToTheSphere) {
  const TransferFunction transfer_function({{0, {1, 1, 1}, 0.8}});
  const scene::Camera camera = looking({1, 2, 4}, {0, 0, 0}, ProjectionKind::orthographic, 1.0);
  double error_before = 1;
  // Odd orders have no node in the middle of a face, where the sphere's deviation is largest, and are worse than the
  // previous even order.
  for (const int order : {1, 2, 4}) {
    const CurvedMesh mesh = ball_of(order);
    const CurvedReference reference(mesh.cells(), camera, size, transfer_function);
    double error = 0;
    for (const double x : {16.3, 19.1, 24.7})
      for (const double y : {16.4, 10.9}) {
        const double d = std::hypot(x - 16, y - 16) / 16;
        const Pixel found = reference.pixel(x, y);
        error = std::max(error, std::abs(found.a + std::expm1(-0.8 * 2 * std::sqrt(1 - d * d))));
        // Along any ray the cells tile the interval between the first and the last face.
        const std::vector<CurvedSegment> segments = reference.segments(x, y);
        for (std::size_t i = 1; i < segments.size(); ++i)
          EXPECT_NEAR(segments[i].front, segments[i - 1].back, rounding) << "order " << order;
      }
    EXPECT_LT(error, error_before / 3) << "order " << order;
    error_before = error;
  }
  EXPECT_LT(error_before, 2e-3);
}

TEST(CurvedReference, EyeInsideAndClippingCutStretches) {
  CurvedMesh mesh;
  mesh.add(named("triquadratic hexahedron"), warped, any_field);
  const TransferFunction transfer_function({{0, {1, 1, 1}, 1}});
  scene::Camera camera = looking({-3, 0.6, 0.5}, {0.5, 0.5, 0.5}, ProjectionKind::perspective, 20, {0, 0, 1});
  const CurvedReference whole(mesh.cells(), camera, size, transfer_function);
  const double x = 16.3, y = 15.8;
  const std::vector<CurvedSegment> all = whole.segments(x, y);
  ASSERT_EQ(all.size(), 1u);
  camera.clipping_range = {{all[0].front + 0.2, all[0].back - 0.3}};
  const CurvedReference clipped(mesh.cells(), camera, size, transfer_function);
  EXPECT_NEAR(clipped.pixel(x, y).length,
              all[0].length * (all[0].back - all[0].front - 0.5) / (all[0].back - all[0].front), rounding);
  // The eye moves forward along the view axis, and with it the ray's origin along the ray.
  scene::Camera inside = looking({-3, 0.6, 0.5}, {0.5, 0.5, 0.5}, ProjectionKind::orthographic, 0.5, {0, 0, 1});
  const CurvedReference from_afar(mesh.cells(), inside, size, transfer_function);
  const std::vector<CurvedSegment> afar = from_afar.segments(x, y);
  ASSERT_EQ(afar.size(), 1u);
  const glm::dvec3 forward = glm::normalize(inside.focal_point - inside.position);
  const double move = afar[0].front + 0.25;
  inside.position += move * forward, inside.focal_point += move * forward;
  const CurvedReference from_inside(mesh.cells(), inside, size, transfer_function);
  EXPECT_NEAR(from_inside.pixel(x, y).length, afar[0].length - 0.25, rounding);
}

TEST(CurvedReference, IsTheSameFromAfar) {
  CurvedMesh mesh;
  mesh.add(named("triquadratic hexahedron"), warped, any_field);
  const TransferFunction transfer_function({{-1, {1, 0, 0}, 0.5}, {1, {1, 1, 0}, 3}});
  const glm::dvec3 centre(0.5), towards = glm::normalize(glm::dvec3(1, -2, 1.5));
  const auto from = [&](double distance) {
    return looking(centre + distance * towards, centre, ProjectionKind::orthographic, 0.9, {0, 0, 1});
  };
  const CurvedReference near(mesh.cells(), from(4), size, transfer_function),
      far(mesh.cells(), from(4e5), size, transfer_function);
  for (const PixelIndex& p : all_pixels(size)) {
    // Positions have rounding errors of 1e-10, which grazing faces and the field magnify.
    const double x = p.x + 0.4873, y = p.y + 0.5241;
    EXPECT_NEAR(near.pixel(x, y).length, far.pixel(x, y).length, 1e-7) << x << ", " << y;
    EXPECT_NEAR(near.pixel(x, y).r, far.pixel(x, y).r, 1e-7) << x << ", " << y;
  }
}

TEST(CurvedReference, CellDataIsConstantInACell) {
  CurvedMesh mesh;
  mesh.add(named("quadratic tet"), warped, any_field);
  mesh.add(
      named("quadratic tet"), [](const glm::dvec3& p) { return warped(p) + glm::dvec3(0, 0, 1.5); }, any_field);
  mesh.association = Association::cell;
  mesh.scalars = {0.25, 0.5};  // the second value is on a step, where the upper side counts
  const TransferFunction transfer_function({{0, {1, 1, 1}, 0}, {0.5, {1, 1, 1}, 2}, {0.5, {1, 1, 1}, 3}});
  const scene::Camera camera = looking({0.3, -3, 1}, {0.3, 0.3, 1}, ProjectionKind::orthographic, 1.2, {0, 0, 1});
  const CurvedReference reference(mesh.cells(), camera, size, transfer_function);
  std::array<int, 2> hits{0, 0};
  for (const PixelIndex& p : all_pixels(size)) {
    double depth = 0;
    for (const CurvedSegment& segment : reference.segments(p.x + 0.5, p.y + 0.5)) {
      depth += segment.length * (segment.cell == 0 ? 1 : 3);
      ++hits[segment.cell];
    }
    EXPECT_NEAR(reference.pixel(p.x + 0.5, p.y + 0.5).a, -std::expm1(-depth), rounding);
  }
  EXPECT_GT(std::min(hits[0], hits[1]), 10);
}

/// Rays through edges and corners and along faces, flat, collapsed and folded cells: any finite result, quickly.
TEST(CurvedReference, EndsWithFiniteNumbersWhateverTheCell) {
  const TransferFunction transfer_function(
      {{-1, {1, 0, 0}, 0}, {0.2, {0, 1, 0}, 2}, {0.2, {0, 0, 1}, 0}, {1, {1, 1, 0}, 3}});
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  const std::clock_t begin = std::clock();
  int done = 0;
  test::SomeCases some(5);
  for (const TypeCase& type : all_types()) {
    if (type.nodes > 40 || !some.next()) continue;
    const std::vector<Map> maps{
        [](const glm::dvec3& p) { return p; },
        [](const glm::dvec3& p) { return glm::dvec3(p.x, p.y, 0.3); },
        [](const glm::dvec3&) { return glm::dvec3(0.5); },
        [](const glm::dvec3& p) { return glm::dvec3(p.x, p.y, p.z * p.x); },
        [](const glm::dvec3& p) { return glm::dvec3(p.x, (p.y - 0.5) * (p.y - 0.5), p.z); },
        [&](const glm::dvec3&) { return glm::dvec3(unit(random), unit(random), unit(random)); }};
    for (const Map& map : maps) {
      CurvedMesh mesh;
      mesh.add(type, map, any_field);
      const scene::Camera along = looking({0.5, 0.5, 4}, {0.5, 0.5, 0.5}, ProjectionKind::orthographic, 1);
      const CurvedReference reference(mesh.cells(), along, {8, 8}, transfer_function);
      const int rays = &map == &maps.back() ? 1 : 5;  // per direction, in quarters of the cell; cells of noise are slow
      for (int j = 0; j < rays; ++j)
        for (int i = 0; i < rays; ++i) {
          const Pixel found = rays == 1 ? reference.pixel(3.9, 4.2) : reference.pixel(2 + i, 2 + j);
          EXPECT_TRUE(std::isfinite(found.r + found.g + found.b + found.a + found.length)) << type.name;
          EXPECT_GE(found.a, 0) << type.name;
          EXPECT_LE(found.a, 1) << type.name;
          ++done;
        }
    }
  }
  const double took = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  EXPECT_LT(took / done, 0.1);  // seconds of processor time per ray, in any build; milliseconds if optimized
}

TEST(CurvedReference, RefusesArraysThatDoNotFit) {
  const TransferFunction transfer_function({{0, {1, 1, 1}, 1}});
  const scene::Camera camera = looking({0.3, -3, 1}, {0.3, 0.3, 1}, ProjectionKind::orthographic, 1.2, {0, 0, 1});
  CurvedMesh good;
  good.add(named("quadratic tet"), warped, any_field);
  const auto render = [&](const CurvedMesh& mesh) {
    return CurvedReference(mesh.cells(), camera, size, transfer_function);
  };
  EXPECT_NO_THROW(render(good));
  CurvedMesh mesh = good;
  mesh.scalars.pop_back();
  EXPECT_THROW(render(mesh), scene::Error);
  mesh = good;
  mesh.offsets.pop_back();
  EXPECT_THROW(render(mesh), scene::Error);
  mesh = good;
  mesh.offsets.back() = 11;
  EXPECT_THROW(render(mesh), scene::Error);
  mesh = good;
  mesh.offsets.back() = 9;
  EXPECT_THROW(render(mesh), scene::Error);
  mesh = good;
  mesh.connectivity[4] = 10;
  EXPECT_THROW(render(mesh), scene::Error);
  mesh = good;
  mesh.positions[3].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(render(mesh), scene::Error);
  mesh = good;
  mesh.scalars[3] = std::numeric_limits<double>::infinity();
  EXPECT_THROW(render(mesh), scene::Error);
  mesh = good;
  mesh.degrees.push_back({});
  EXPECT_THROW(render(mesh), scene::Error);
  mesh = good;
  mesh.types[0] = 42;
  EXPECT_THROW(render(mesh), scene::Error);
  EXPECT_THROW(CurvedReference(good.cells(), camera, size, TransferFunction()), scene::Error);
  // Cells without volume are skipped.
  mesh = good;
  mesh.types[0] = 22;
  EXPECT_EQ(render(mesh).pixel(16.5, 16.5).segments, 0u);
}

}  // namespace
}  // namespace tessera::reference::curved_reference_test
