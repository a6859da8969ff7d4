// SPDX-License-Identifier: BSD-3-Clause
#include "reference/curved/curved_nodes.hpp"

#include <initializer_list>

namespace tessera::reference {
namespace {

using Places = std::vector<glm::dvec3>;

/// Adds the `order` - 1 places that divide the line from a to b evenly.
void add_between(const glm::dvec3& a, const glm::dvec3& b, int order, Places& places) {
  for (int i = 1; i < order; ++i)
    places.push_back((a * static_cast<double>(order - i) + b * static_cast<double>(i)) / static_cast<double>(order));
}

/// Adds the places inside the triangle abc of a given `order`. These places form a smaller triangle: its corners, its
/// edges, and recursively its inside.
void add_triangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, int order, Places& places) {
  if (order < 3) return;
  const glm::dvec3 along_b = (b - a) / static_cast<double>(order), along_c = (c - a) / static_cast<double>(order);
  const glm::dvec3 p = a + along_b + along_c, q = b - along_b + (along_c - along_b),
                   r = c - along_c + (along_b - along_c);
  places.push_back(p);
  if (order == 3) return;  // the triangle has only this place
  places.push_back(q);
  places.push_back(r);
  add_between(p, q, order - 3, places);
  add_between(q, r, order - 3, places);
  add_between(r, p, order - 3, places);
  add_triangle(p, q, r, order - 3, places);
}

/// Adds a tet with corners `c`; the inside is a smaller tet.
void add_tet(const std::array<glm::dvec3, 4>& c, int order, Places& places) {
  if (order == 0) {
    places.push_back(c[0]);
    return;
  }
  for (const glm::dvec3& corner : c) places.push_back(corner);
  add_between(c[0], c[1], order, places);
  add_between(c[1], c[2], order, places);
  add_between(c[2], c[0], order, places);
  for (std::size_t i = 0; i < 3; ++i) add_between(c[i], c[3], order, places);
  add_triangle(c[0], c[1], c[3], order, places);
  add_triangle(c[2], c[3], c[1], order, places);
  add_triangle(c[0], c[3], c[2], order, places);
  add_triangle(c[0], c[2], c[1], order, places);
  if (order < 4) return;
  const glm::dvec3 centre = (c[0] + c[1] + c[2] + c[3]) / 4.0;
  std::array<glm::dvec3, 4> inner;
  for (std::size_t i = 0; i < 4; ++i) inner[i] = centre + (c[i] - centre) * (static_cast<double>(order - 4) / order);
  add_tet(inner, order - 4, places);
}

/// Adds the places inside a parallelogram with corner a and sides ab and ad, in rows along ab.
void add_quad(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& d, int order_ab, int order_ad,
              Places& places) {
  for (int j = 1; j < order_ad; ++j)
    for (int i = 1; i < order_ab; ++i)
      places.push_back(a + (b - a) * (static_cast<double>(i) / order_ab) +
                       (d - a) * (static_cast<double>(j) / order_ad));
}

/// Adds the places inside a wedge's cross section at height t, in rows along r.
void add_section(double t, int order, Places& places) {
  for (int j = 1; j < order; ++j)
    for (int i = 1; i + j < order; ++i)
      places.emplace_back(static_cast<double>(i) / order, static_cast<double>(j) / order, t);
}

}  // namespace

std::vector<glm::dvec3> tet_nodes(int order) {
  Places places;
  add_tet({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, order, places);
  return places;
}

std::vector<glm::dvec3> wedge_nodes(int order, int order_along) {
  const std::array<glm::dvec3, 6> c{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}}};
  Places places(c.begin(), c.end());
  for (const std::size_t end : {0, 3})
    for (std::size_t i = 0; i < 3; ++i) add_between(c[end + i], c[end + (i + 1) % 3], order, places);
  for (std::size_t i = 0; i < 3; ++i) add_between(c[i], c[i + 3], order_along, places);
  for (const double t : {0.0, 1.0}) add_section(t, order, places);
  for (std::size_t i = 0; i < 3; ++i) add_quad(c[i], c[(i + 1) % 3], c[i + 3], order, order_along, places);
  for (int k = 1; k < order_along; ++k) add_section(static_cast<double>(k) / order_along, order, places);
  return places;
}

std::vector<glm::dvec3> hexahedron_nodes(std::array<int, 3> orders) {
  const std::array<glm::dvec3, 8> c{
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};
  const auto [nr, ns, nt] = orders;
  Places places(c.begin(), c.end());
  for (const std::size_t end : {0, 4}) {  // all edges point in the positive direction of their axis
    add_between(c[end], c[end + 1], nr, places);
    add_between(c[end + 1], c[end + 2], ns, places);
    add_between(c[end + 3], c[end + 2], nr, places);
    add_between(c[end], c[end + 3], ns, places);
  }
  for (std::size_t i = 0; i < 4; ++i) add_between(c[i], c[i + 4], nt, places);
  for (const double end : {0.0, 1.0}) add_quad({end, 0, 0}, {end, 1, 0}, {end, 0, 1}, ns, nt, places);
  for (const double end : {0.0, 1.0}) add_quad({0, end, 0}, {1, end, 0}, {0, end, 1}, nr, nt, places);
  for (const double end : {0.0, 1.0}) add_quad({0, 0, end}, {1, 0, end}, {0, 1, end}, nr, ns, places);
  for (int k = 1; k < nt; ++k) {
    const double t = static_cast<double>(k) / nt;
    add_quad({0, 0, t}, {1, 0, t}, {0, 1, t}, nr, ns, places);
  }
  return places;
}

std::vector<glm::dvec3> lagrange_pyramid_nodes(int order) {
  const std::array<glm::dvec3, 5> c{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}}};
  constexpr std::array<std::array<std::size_t, 2>, 4> base{{{0, 1}, {1, 2}, {3, 2}, {0, 3}}};
  Places places(c.begin(), c.end());
  for (const auto& [from, to] : base) add_between(c[from], c[to], order, places);
  for (std::size_t i = 0; i < 4; ++i)  // in the box, these edges are parallel to t
    for (int k = 1; k < order; ++k) places.emplace_back(c[i].x, c[i].y, static_cast<double>(k) / order);
  const auto add_layer = [&](int k) {
    const double t = static_cast<double>(k) / order;
    add_quad({0, 0, t}, {1, 0, t}, {0, 1, t}, order - k, order - k, places);
  };
  add_layer(0);
  for (const auto& [from, to] : base)
    for (int k = 1; k < order; ++k) {
      const glm::dvec3 up(0, 0, static_cast<double>(k) / order);
      add_between(c[from] + up, c[to] + up, order - k, places);
    }
  for (int k = 1; k < order; ++k) add_layer(k);
  return places;
}

std::vector<glm::dvec3> pyramid_nodes() {
  const double third = 1.0 / 3;
  return {{0, 0, 0},       {1, 0, 0},       {1, 1, 0},       {0, 1, 0},       {0, 0, 1},
          {0.5, 0, 0},     {1, 0.5, 0},     {0.5, 1, 0},     {0, 0.5, 0},     {0, 0, 0.5},
          {1, 0, 0.5},     {1, 1, 0.5},     {0, 1, 0.5},     {0.5, 0.5, 0},   {0.5, 0, third},
          {1, 0.5, third}, {0.5, 1, third}, {0, 0.5, third}, {0.5, 0.5, 0.25}};
}

}  // namespace tessera::reference
