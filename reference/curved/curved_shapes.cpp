// SPDX-License-Identifier: BSD-3-Clause
#include "reference/curved/curved_shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <initializer_list>

#include "reference/curved/curved_nodes.hpp"
#include "scene/error.hpp"
#include "tessera/cell_type.hpp"

namespace tessera::reference {
namespace {

/// A polynomial over a domain.
using Function = std::function<double(const glm::dvec3&)>;

double power(double x, int n) { return n == 0 ? 1 : x * power(x, n - 1); }

/// (2r - 1)^i (2s - 1)^j (2t - 1)^k: monomials about the middle, which are better conditioned.
Function monomial(int i, int j, int k) {
  return [=](const glm::dvec3& p) { return power(2 * p.x - 1, i) * power(2 * p.y - 1, j) * power(2 * p.z - 1, k); };
}

/// r^i s^j t^k.
Function corner_monomial(int i, int j, int k) {
  return [=](const glm::dvec3& p) { return power(p.x, i) * power(p.y, j) * power(p.z, k); };
}

/// Returns the shape whose functions span the whole basis.
CellShape full(const BernsteinBasis& basis, std::vector<glm::dvec3> nodes) {
  // The nodes are the lattice points in another order.
  const std::vector<glm::dvec3> lattice = basis.lattice();
  const Matrix from_lattice = basis.from_lattice();
  CellShape shape{basis, std::move(nodes), Matrix(basis.size(), basis.size()), basis.faces()};
  for (std::size_t node = 0; node < shape.nodes.size(); ++node) {
    std::size_t at = 0;
    const auto distance = [&](std::size_t n) {
      const glm::dvec3 d = lattice[n] - shape.nodes[node];
      return std::abs(d.x) + std::abs(d.y) + std::abs(d.z);
    };
    for (std::size_t n = 0; n < lattice.size(); ++n)
      if (distance(n) < distance(at)) at = n;
    for (std::size_t row = 0; row < basis.size(); ++row) shape.to_bernstein(row, node) = from_lattice(row, at);
  }
  return shape;
}

/// Returns the shape whose functions span `space`, which has as many functions as nodes, within the basis.
CellShape spanned(const BernsteinBasis& basis, std::vector<glm::dvec3> nodes, const std::vector<Function>& space) {
  const auto values_at = [&](const std::vector<glm::dvec3>& places) {
    Matrix values(places.size(), space.size());
    for (std::size_t i = 0; i < places.size(); ++i)
      for (std::size_t j = 0; j < space.size(); ++j) values(i, j) = space[j](places[i]);
    return values;
  };
  const Matrix at_lattice = product(values_at(basis.lattice()), inverse(values_at(nodes)));
  return {basis, std::move(nodes), product(basis.from_lattice(), at_lattice), basis.faces()};
}

/// Returns a shape whose nodes are the control points.
CellShape bezier(const BernsteinBasis& basis, std::vector<glm::dvec3> nodes) {
  CellShape shape = full(basis, std::move(nodes));
  const std::vector<glm::dvec3> lattice = basis.lattice();
  for (std::size_t row = 0; row < basis.size(); ++row)
    for (std::size_t node = 0; node < basis.size(); ++node) {
      const glm::dvec3 d = lattice[row] - shape.nodes[node];
      shape.to_bernstein(row, node) = std::abs(d.x) + std::abs(d.y) + std::abs(d.z) < 1e-6 ? 1 : 0;
    }
  return shape;
}

std::vector<glm::dvec3> first(std::size_t count, std::vector<glm::dvec3> places) {
  places.resize(count);
  return places;
}

/// Adds the eight-node serendipity functions in (r, s), times powers of t up to `most_t`.
void add_serendipity(int most_t, std::vector<Function>& space) {
  constexpr std::array<std::array<int, 2>, 8> exponents{
      {{0, 0}, {1, 0}, {0, 1}, {1, 1}, {2, 0}, {0, 2}, {2, 1}, {1, 2}}};
  for (int k = 0; k <= most_t; ++k)
    for (const auto& e : exponents) space.push_back(monomial(e[0], e[1], k));
}

/// The hexahedron with 20 nodes: the monomials whose degree is at most two if variables to the first power are not
/// counted (Arnold, Awanou, "The Serendipity Family of Finite Elements", Foundations of Computational Mathematics
/// 2011).
CellShape quadratic_hexahedron() {
  std::vector<Function> space;
  add_serendipity(1, space);
  for (const auto& [i, j] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 1}}) space.push_back(monomial(i, j, 2));
  return spanned(BernsteinBasis(Domain::box, {2, 2, 2}), first(20, hexahedron_nodes({2, 2, 2})), space);
}

/// The hexahedron with 24 nodes: serendipity in (r, s), quadratic in t.
CellShape biquadratic_hexahedron() {
  std::vector<Function> space;
  add_serendipity(2, space);
  return spanned(BernsteinBasis(Domain::box, {2, 2, 2}), first(24, hexahedron_nodes({2, 2, 2})), space);
}

/// The wedge with 15 nodes: products of quadratic functions in the triangle with linear functions in t, and of linear
/// functions in the triangle with quadratic functions in t.
CellShape quadratic_wedge() {
  std::vector<Function> space;
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j <= 2; ++j)
      for (int i = 0; i + j <= 2; ++i) space.push_back(corner_monomial(i, j, k));
  for (const auto& [i, j] : {std::pair{0, 0}, {1, 0}, {0, 1}}) space.push_back(corner_monomial(i, j, 2));
  return spanned(BernsteinBasis(Domain::prism, {2, 0, 2}), first(15, wedge_nodes(2, 2)), space);
}

/// The linear pyramid: the bilinear functions in the box that are constant on the face of the apex.
CellShape linear_pyramid() {
  std::vector<Function> space{corner_monomial(0, 0, 0), corner_monomial(0, 0, 1)};
  space.emplace_back([](const glm::dvec3& p) { return p.x * (1 - p.z); });
  space.emplace_back([](const glm::dvec3& p) { return p.y * (1 - p.z); });
  space.emplace_back([](const glm::dvec3& p) { return p.x * p.y * (1 - p.z); });
  return spanned(BernsteinBasis(Domain::box, {1, 1, 1}), first(5, pyramid_nodes()), space);
}

/// Returns a function of x = 2r - 1, y = 2s - 1 and w = 2 - 2t; w vanishes at the apex.
Function towards_apex(std::function<double(double x, double y, double w)> f) {
  return [f = std::move(f)](const glm::dvec3& p) { return f(2 * p.x - 1, 2 * p.y - 1, 2 - 2 * p.z); };
}

/// Returns the functions that both quadratic pyramids have. They are quadratic on every edge. Together with the
/// functions that each pyramid adds, they span all polynomials of second degree, except that x^2 + y^2 is replaced by a
/// rational function.
std::vector<Function> quadratic_pyramid_space() {
  std::vector<Function> space;
  for (int k = 0; k <= 2; ++k) space.push_back(corner_monomial(0, 0, k));
  for (int k = 1; k <= 2; ++k) {
    space.push_back(towards_apex([k](double x, double, double w) { return x * power(w, k); }));
    space.push_back(towards_apex([k](double, double y, double w) { return y * power(w, k); }));
    space.push_back(towards_apex([k](double x, double y, double w) { return x * y * power(w, k); }));
  }
  space.push_back(towards_apex([](double x, double y, double w) { return x * y * y * w * w; }));
  space.push_back(towards_apex([](double x, double y, double w) { return x * x * y * w * w; }));
  return space;
}

/// The pyramid with 13 nodes: the serendipity hexahedron of 20 nodes with the nodes of one face collapsed, corrected to
/// be quadratic on the triangles (Felippa, "Advanced Finite Element Methods", chapter on pyramids).
CellShape quadratic_pyramid() {
  std::vector<Function> space = quadratic_pyramid_space();
  space.push_back(towards_apex([](double x, double y, double w) { return (x * x - y * y) * w * w; }));
  space.push_back(towards_apex([](double x, double y, double w) {
    const double xx = x * x, yy = y * y;
    return 2 * w * (xx + yy - xx * yy) - w * w * ((xx + yy) / 2 - xx * yy);
  }));
  return spanned(BernsteinBasis(Domain::box, {2, 2, 2}), first(13, pyramid_nodes()), space);
}

/// The pyramid with 19 nodes, which also has bubble functions on faces and inside.
CellShape triquadratic_pyramid() {
  std::vector<Function> space = quadratic_pyramid_space();
  space.push_back(towards_apex([](double x, double y, double w) { return x * (1 - y * y) * w * w * w; }));
  space.push_back(towards_apex([](double x, double y, double w) { return y * (1 - x * x) * w * w * w; }));
  space.push_back(towards_apex([](double x, double y, double w) { return x * x * (1 - y * y) * w * w * w; }));
  space.push_back(towards_apex([](double x, double y, double w) { return y * y * (1 - x * x) * w * w * w; }));
  space.push_back(towards_apex([](double x, double, double w) { return x * x * w * w; }));
  space.push_back(towards_apex([](double, double y, double w) { return y * y * w * w; }));
  space.push_back(towards_apex([](double x, double y, double w) { return x * x * y * y * w * w; }));
  space.push_back(towards_apex([](double x, double y, double w) { return w * (x * x + y * y - x * x * y * y); }));
  return spanned(BernsteinBasis(Domain::box, {2, 2, 3}), pyramid_nodes(), space);
}

/// The Lagrange pyramid: the rational functions of Bergot, Cohen and Durufle ("Higher-order finite elements for hybrid
/// meshes using new nodal pyramidal elements", Journal of Scientific Computing 2010). In the box they are x^i y^j w^k,
/// with k from max(i, j) up to the order.
CellShape lagrange_pyramid(int order) {
  std::vector<Function> space;
  for (int i = 0; i <= order; ++i)
    for (int j = 0; j <= order; ++j)
      for (int k = std::max(i, j); k <= order; ++k)
        space.push_back(
            towards_apex([=](double x, double y, double w) { return power(x, i) * power(y, j) * power(w / 2, k); }));
  return spanned(BernsteinBasis(Domain::box, {order, order, order}), lagrange_pyramid_nodes(order), space);
}

/// Returns the centres of a tet's faces, and of the tet, in the order of the cell of 15 nodes.
std::vector<glm::dvec3> tet_middles() {
  constexpr double third = 1.0 / 3;
  return {{third, third, 0}, {third, 0, third}, {third, third, third}, {0, third, third}, glm::dvec3(0.25)};
}

/// Adds all polynomials on the tet up to a degree.
void add_complete(int degree, std::vector<Function>& space) {
  for (int k = 0; k <= degree; ++k)
    for (int j = 0; j + k <= degree; ++j)
      for (int i = 0; i + j + k <= degree; ++i) space.push_back(corner_monomial(i, j, k));
}

/// Returns the fourth barycentric coordinate, 1 - r - s - t.
double fourth(const glm::dvec3& p) { return 1 - p.x - p.y - p.z; }

/// Adds the cubic bubbles of the tet's faces.
void add_face_bubbles(std::vector<Function>& space) {
  space.emplace_back([](const glm::dvec3& p) { return p.x * p.y * p.z; });
  space.emplace_back([](const glm::dvec3& p) { return p.x * p.y * fourth(p); });
  space.emplace_back([](const glm::dvec3& p) { return p.x * p.z * fourth(p); });
  space.emplace_back([](const glm::dvec3& p) { return p.y * p.z * fourth(p); });
}

/// The tets of 5, 7, 8, 11, 14 and 15 nodes: all polynomials of first degree, or of second degree from 11 nodes on,
/// with a cubic bubble function for each face that has a node, and a quartic one if a node is inside. With 7 nodes, the
/// base's edges are quadratic.
CellShape enriched_tet(std::size_t count) {
  const bool is_quadratic = count > 10, has_faces = count == 8 || count >= 14,
             has_inside = count != 7 && count != 8 && count != 14;
  std::vector<glm::dvec3> nodes = count == 7 ? first(7, tet_nodes(2)) : tet_nodes(is_quadratic ? 2 : 1);
  const std::vector<glm::dvec3> middles = tet_middles();
  if (has_faces) nodes.insert(nodes.end(), middles.begin(), middles.begin() + 4);
  if (has_inside) nodes.push_back(middles.back());
  std::vector<Function> space;
  add_complete(is_quadratic ? 2 : 1, space);
  if (count == 7) {
    space.emplace_back([](const glm::dvec3& p) { return p.x * fourth(p); });
    space.emplace_back([](const glm::dvec3& p) { return p.x * p.y; });
    space.emplace_back([](const glm::dvec3& p) { return p.y * fourth(p); });
  }
  if (has_faces) add_face_bubbles(space);
  if (has_inside) space.emplace_back([](const glm::dvec3& p) { return p.x * p.y * p.z * fourth(p); });
  return spanned(BernsteinBasis(Domain::tet, {4, 4, 4}), std::move(nodes), space);
}

/// Returns a bubble function of the hexahedron. If `inside`, it is (1 - x^2)(1 - y^2)(1 - z^2); otherwise it is (1 -
/// x^2)(1 - y^2) z^k, with z as the axis `along`, and k = 0 or 1.
Function hexahedron_bubble(int along, int k, bool inside) {
  return [=](const glm::dvec3& p) {
    double value = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const double x = 2 * p[axis] - 1;
      value *= axis == along && !inside ? power(x, k) : 1 - x * x;
    }
    return value;
  };
}

/// The hexahedra of 9, 16, 21 and 26 nodes. With 9 nodes, the functions are trilinear; with 16, serendipity in (r, s)
/// and linear in t; with 21 and 26, those of the hexahedron of 20 nodes. A bubble function is added for each node that
/// is in a face (26) or inside (9, 21).
CellShape incomplete_hexahedron(std::size_t count) {
  const std::vector<glm::dvec3> all = hexahedron_nodes({2, 2, 2});
  std::vector<Function> space;
  if (count == 16) {
    add_serendipity(1, space);
    return spanned(BernsteinBasis(Domain::box, {2, 2, 2}), first(16, all), space);
  }
  std::vector<glm::dvec3> nodes = first(count == 9 ? 8 : count == 21 ? 20 : 26, all);
  if (count == 9) {
    for (int k = 0; k < 2; ++k)
      for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) space.push_back(monomial(i, j, k));
  } else {
    add_serendipity(1, space);
    for (const auto& [i, j] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 1}}) space.push_back(monomial(i, j, 2));
  }
  for (int along = 0; along < 3 && count == 26; ++along)
    for (int k = 0; k < 2; ++k) space.push_back(hexahedron_bubble(along, k, false));
  if (count != 26) {
    nodes.push_back(all.back());
    space.push_back(hexahedron_bubble(0, 0, true));
  }
  return spanned(BernsteinBasis(Domain::box, {2, 2, 2}), std::move(nodes), space);
}

/// The wedges of 16 and 20 nodes: the functions of the wedge of 15 nodes, and bubble functions inside (16) or for the
/// five faces (20).
CellShape incomplete_wedge(std::size_t count) {
  const std::vector<glm::dvec3> quadratic = wedge_nodes(2, 2);
  std::vector<glm::dvec3> nodes(quadratic.begin(), quadratic.begin() + 15);
  std::vector<Function> space;
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j <= 2; ++j)
      for (int i = 0; i + j <= 2; ++i) space.push_back(corner_monomial(i, j, k));
  for (const auto& [i, j] : {std::pair{0, 0}, {1, 0}, {0, 1}}) space.push_back(corner_monomial(i, j, 2));
  constexpr double third = 1.0 / 3;
  const auto bubble = [](const glm::dvec3& p) { return p.x * p.y * (1 - p.x - p.y); };
  const auto along = [](const glm::dvec3& p) { return p.z * (1 - p.z); };
  if (count == 16) {
    nodes.emplace_back(third, third, 0.5);
    space.emplace_back([=](const glm::dvec3& p) { return bubble(p) * along(p); });
  } else {
    for (const double t : {0.0, 1.0}) nodes.emplace_back(third, third, t);
    nodes.insert(nodes.end(), quadratic.begin() + 15, quadratic.end());
    space.emplace_back(bubble);
    space.emplace_back([=](const glm::dvec3& p) { return bubble(p) * p.z; });
    space.emplace_back([=](const glm::dvec3& p) { return p.x * p.y * along(p); });
    space.emplace_back([=](const glm::dvec3& p) { return p.x * (1 - p.x - p.y) * along(p); });
    space.emplace_back([=](const glm::dvec3& p) { return p.y * (1 - p.x - p.y) * along(p); });
  }
  return spanned(BernsteinBasis(Domain::prism, {3, 0, 2}), std::move(nodes), space);
}

/// The wedge of 21 nodes: quadratic with a cubic bubble function in the triangle, quadratic in t.
CellShape enriched_wedge() {
  const std::vector<glm::dvec3> quadratic = wedge_nodes(2, 2);
  const double third = 1.0 / 3;
  std::vector<glm::dvec3> nodes(quadratic.begin(), quadratic.begin() + 15);
  for (const double t : {0.0, 1.0}) nodes.emplace_back(third, third, t);
  nodes.insert(nodes.end(), quadratic.begin() + 15, quadratic.end());
  nodes.emplace_back(third, third, 0.5);
  std::vector<Function> space;
  for (int k = 0; k <= 2; ++k) {
    for (int j = 0; j <= 2; ++j)
      for (int i = 0; i + j <= 2; ++i) space.push_back(corner_monomial(i, j, k));
    space.emplace_back([k](const glm::dvec3& p) { return p.x * p.y * (1 - p.x - p.y) * power(p.z, k); });
  }
  return spanned(BernsteinBasis(Domain::prism, {3, 0, 2}), std::move(nodes), space);
}

/// Returns the number of nodes of types for which it is fixed.
std::size_t nodes_of(CellType type) {
  switch (type) {
    case CellType::tetra:
      return 4;
    case CellType::voxel:
    case CellType::hexahedron:
      return 8;
    case CellType::wedge:
      return 6;
    case CellType::pyramid:
      return 5;
    case CellType::quadratic_tetra:
      return 10;
    case CellType::quadratic_hexahedron:
      return 20;
    case CellType::quadratic_wedge:
      return 15;
    case CellType::quadratic_pyramid:
      return 13;
    case CellType::triquadratic_hexahedron:
      return 27;
    case CellType::quadratic_linear_wedge:
      return 12;
    case CellType::biquadratic_quadratic_wedge:
      return 18;
    case CellType::biquadratic_quadratic_hexahedron:
      return 24;
    case CellType::triquadratic_pyramid:
      return 19;
    default:
      return 0;
  }
}

CellShape fixed_shape(CellType type) {
  switch (type) {
    case CellType::tetra:
      return full(BernsteinBasis(Domain::tet, {1, 1, 1}), tet_nodes(1));
    case CellType::voxel: {
      std::vector<glm::dvec3> nodes = hexahedron_nodes({1, 1, 1});
      std::swap(nodes[2], nodes[3]);
      std::swap(nodes[6], nodes[7]);
      return full(BernsteinBasis(Domain::box, {1, 1, 1}), std::move(nodes));
    }
    case CellType::hexahedron:
      return full(BernsteinBasis(Domain::box, {1, 1, 1}), hexahedron_nodes({1, 1, 1}));
    case CellType::wedge:
      return full(BernsteinBasis(Domain::prism, {1, 1, 1}), wedge_nodes(1, 1));
    case CellType::pyramid:
      return linear_pyramid();
    case CellType::quadratic_tetra:
      return full(BernsteinBasis(Domain::tet, {2, 2, 2}), tet_nodes(2));
    case CellType::quadratic_hexahedron:
      return quadratic_hexahedron();
    case CellType::quadratic_wedge:
      return quadratic_wedge();
    case CellType::quadratic_pyramid:
      return quadratic_pyramid();
    case CellType::triquadratic_hexahedron:
      return full(BernsteinBasis(Domain::box, {2, 2, 2}), hexahedron_nodes({2, 2, 2}));
    case CellType::quadratic_linear_wedge:
      return full(BernsteinBasis(Domain::prism, {2, 2, 1}), wedge_nodes(2, 1));
    case CellType::biquadratic_quadratic_wedge:
      return full(BernsteinBasis(Domain::prism, {2, 2, 2}), wedge_nodes(2, 2));
    case CellType::biquadratic_quadratic_hexahedron:
      return biquadratic_hexahedron();
    default:
      return triquadratic_pyramid();
  }
}

constexpr int highest_order = 10;

}  // namespace

bool without_volume(std::uint8_t vtk_type) {
  constexpr std::array types{CellType::empty_cell,
                             CellType::vertex,
                             CellType::poly_vertex,
                             CellType::line,
                             CellType::poly_line,
                             CellType::triangle,
                             CellType::triangle_strip,
                             CellType::polygon,
                             CellType::pixel,
                             CellType::quad,
                             CellType::quadratic_edge,
                             CellType::quadratic_triangle,
                             CellType::quadratic_quad,
                             CellType::biquadratic_quad,
                             CellType::quadratic_linear_quad,
                             CellType::biquadratic_triangle,
                             CellType::cubic_line,
                             CellType::quadratic_polygon,
                             CellType::lagrange_curve,
                             CellType::lagrange_triangle,
                             CellType::lagrange_quadrilateral,
                             CellType::bezier_curve,
                             CellType::bezier_triangle,
                             CellType::bezier_quadrilateral};
  return std::find(types.begin(), types.end(), CellType{vtk_type}) != types.end();
}

CellShape cell_shape(std::uint8_t vtk_type, std::size_t nodes, std::array<int, 3> orders, const std::string& where) {
  const CellType type{vtk_type};
  if (const std::size_t wanted = nodes_of(type); wanted > 0) {
    if (nodes != wanted)
      throw scene::bad_input(
          fmt::format("{}: cells of type {} have {} nodes, but this cell has {}; write all of its nodes", where,
                      vtk_type, wanted, nodes));
    return fixed_shape(type);
  }
  if (type == CellType::lagrange_pyramid) {
    const auto count = [](std::size_t n) { return (n + 1) * (n + 2) * (2 * n + 3) / 6; };
    std::size_t order = 1;
    while (order < highest_order && count(order) < nodes) ++order;
    if (count(order) != nodes)
      throw scene::bad_input(
          fmt::format("{}: {} nodes do not fit a Lagrange pyramid of order 1 to {}; write all of its "
                      "nodes",
                      where, nodes, highest_order));
    return lagrange_pyramid(static_cast<int>(order));
  }
  const bool of_tet = type == CellType::lagrange_tetrahedron || type == CellType::bezier_tetrahedron,
             of_hexahedron = type == CellType::lagrange_hexahedron || type == CellType::bezier_hexahedron,
             of_wedge = type == CellType::lagrange_wedge || type == CellType::bezier_wedge,
             is_bezier = type >= CellType::bezier_tetrahedron;
  if (!of_tet && !of_hexahedron && !of_wedge)
    throw scene::bad_input(
        fmt::format("{}: cells of type {} are not known to the reference; leave them out", where, vtk_type));
  const auto has = [&](std::initializer_list<std::size_t> counts) {
    return std::find(counts.begin(), counts.end(), nodes) != counts.end();
  };
  if (type == CellType::lagrange_tetrahedron && has({5, 7, 8, 11, 14, 15})) return enriched_tet(nodes);
  if (type == CellType::lagrange_hexahedron && orders == std::array{0, 0, 0} && has({9, 16, 21, 26}))
    return incomplete_hexahedron(nodes);
  if (type == CellType::lagrange_wedge && orders == std::array{0, 0, 0} && has({16, 20}))
    return incomplete_wedge(nodes);
  if (type == CellType::lagrange_wedge && nodes == 21) return enriched_wedge();
  const auto count = [&](const std::array<int, 3>& o) {
    const auto [a, b, c] =
        std::array{static_cast<std::size_t>(o[0]), static_cast<std::size_t>(o[1]), static_cast<std::size_t>(o[2])};
    if (of_tet) return (a + 1) * (a + 2) * (a + 3) / 6;
    if (of_wedge) return (a + 1) * (a + 2) / 2 * (c + 1);
    return (a + 1) * (b + 1) * (c + 1);
  };
  if (of_tet || orders == std::array{0, 0, 0}) {
    orders = {1, 1, 1};
    while (orders[0] < highest_order && count(orders) < nodes) orders = {orders[0] + 1, orders[0] + 1, orders[0] + 1};
  }
  for (const int order : orders)
    if (order < 1 || order > highest_order)
      throw scene::bad_input(
          fmt::format("{}: order {} is not one of 1 to {}; write a lower one", where, order, highest_order));
  if (count(orders) != nodes || (of_wedge && orders[0] != orders[1]))
    throw scene::bad_input(
        fmt::format("{}: {} nodes do not fit type {} of orders {}, {} and {}; write the orders in "
                    "HigherOrderDegrees",
                    where, nodes, vtk_type, orders[0], orders[1], orders[2]));
  const Domain domain = of_tet ? Domain::tet : of_wedge ? Domain::prism : Domain::box;
  std::vector<glm::dvec3> places = of_tet     ? tet_nodes(orders[0])
                                   : of_wedge ? wedge_nodes(orders[0], orders[2])
                                              : hexahedron_nodes(orders);
  const BernsteinBasis basis(domain, orders);
  return is_bezier ? bezier(basis, std::move(places)) : full(basis, std::move(places));
}

std::vector<double> shape_functions(const CellShape& shape, const glm::dvec3& place) {
  std::vector<double> values(shape.basis.size()), result(shape.nodes.size());
  std::vector<glm::dvec3> gradients(shape.basis.size());
  shape.basis.evaluate(place, values, gradients);
  for (std::size_t row = 0; row < values.size(); ++row)
    for (std::size_t node = 0; node < result.size(); ++node)
      result[node] += values[row] * shape.to_bernstein(row, node);
  return result;
}

}  // namespace tessera::reference
