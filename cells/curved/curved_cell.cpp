// SPDX-License-Identifier: BSD-3-Clause
#include "cells/curved/curved_cell.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>

#include "cells/curved/bernstein.hpp"
#include "cells/curved/curved_pyramid.hpp"
#include "scene/position_order.hpp"

namespace tessera::cells {
namespace {

constexpr int highest_order = 100;
using Basis = std::array<double, highest_order + 1>;
constexpr std::size_t most_pyramid_nodes =
    (highest_pyramid_order + 1) * (highest_pyramid_order + 2) * (2 * highest_pyramid_order + 3) / 6;

/// Evaluates the Lagrange polynomials of degree n for nodes 0, 1/n, ..., 1 at x.
void lagrange(int n, double x, Basis& out) {
  if (n == 1) {
    out[0] = 1 - x, out[1] = x;
    return;
  }
  if (n == 2) {
    out[0] = (1 - x) * (1 - 2 * x), out[1] = 4 * x * (1 - x), out[2] = x * (2 * x - 1);
    return;
  }
  for (int i = 0; i <= n; ++i) {
    double value = 1;
    for (int j = 0; j <= n; ++j)
      if (j != i) value *= (n * x - j) / (i - j);
    out[static_cast<std::size_t>(i)] = value;
  }
}

/// Evaluates the Silvester polynomials of barycentric coordinate x: the product of (n x - m) / (k - m) over m < k.
void silvester(int n, double x, Basis& out) {
  out[0] = 1;
  for (int k = 1; k <= n; ++k)
    out[static_cast<std::size_t>(k)] = out[static_cast<std::size_t>(k - 1)] * (n * x - (k - 1)) / k;
}

/// Converts the coefficients of a Bezier cell along one of its axes, or on a triangle or tet, to values on the lattice.
/// There are `count` numbers, `stride` apart; `corners` is the number of corners of the simplex.
void to_values(int corners, int degree, glm::dvec4* first, std::size_t count, std::size_t stride) {
  if (degree < 2) return;
  const std::vector<double>& matrix = bernstein_values(corners, degree);
  std::vector<glm::dvec4> values(count, glm::dvec4(0));
  for (std::size_t at = 0; at < count; ++at)
    for (std::size_t of = 0; of < count; ++of) values[at] += matrix[at * count + of] * first[of * stride];
  for (std::size_t at = 0; at < count; ++at) first[at * stride] = values[at];
}

/// Converts all rows along an axis, of n + 1 numbers each.
void rows_to_values(int n, std::size_t stride, std::span<glm::dvec4> all) {
  const std::size_t count = static_cast<std::size_t>(n) + 1;
  for (std::size_t k = 0; k < all.size(); ++k)
    if (k / stride % count == 0) to_values(2, n, &all[k], count, stride);
}

/// Converts the coefficients of the whole cell.
void cell_to_values(const CurvedLattice& lattice, std::span<glm::dvec4> all) {
  const auto& n = lattice.order;
  const auto number = [](int order) { return static_cast<std::size_t>(order); };
  if (lattice.family == CurvedFamily::tet) return to_values(4, n[0], all.data(), all.size(), 1);
  std::size_t layer = (number(n[0]) + 1) * (number(n[1]) + 1);
  if (lattice.family == CurvedFamily::wedge) {
    layer = (number(n[0]) + 1) * (number(n[0]) + 2) / 2;
    for (std::size_t k = 0; k < all.size(); k += layer) to_values(3, n[0], &all[k], layer, 1);
  } else {
    rows_to_values(n[0], 1, all);
    rows_to_values(n[1], number(n[0]) + 1, all);
  }
  rows_to_values(n[2], layer, all);
}

/// Returns the value in the middle of a quadratic triangle, given the sums over its corners and its mid-edge nodes.
glm::dvec4 middle_of_triangle(const glm::dvec4& corners, const glm::dvec4& edges) {
  return (4.0 * edges - corners) / 9.0;
}

glm::dvec4 evaluate_triangle(std::span<const glm::dvec4> nodes, int n, double u, double v) {
  Basis a, b, c;
  silvester(n, u, a), silvester(n, v, b), silvester(n, 1 - u - v, c);
  glm::dvec4 sum(0);
  std::size_t at = 0;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i + j <= n; ++i)
      sum += a[static_cast<std::size_t>(i)] * b[static_cast<std::size_t>(j)] * c[static_cast<std::size_t>(n - i - j)] *
             nodes[at++];
  return sum;
}

}  // namespace

void CurvedCell::set(const CurvedLattice& lattice, std::span<const glm::dvec3> positions,
                     std::span<const double> values, std::span<const double> weights) {
  lattice_ = &lattice;
  parts_made_ = 0;
  const std::size_t nodes = positions.size(), slots = static_cast<std::size_t>(lattice.all_slots);
  values_.assign(slots, glm::dvec4(0));
  weights_.assign(weights.empty() ? 0 : slots, glm::dvec4(0));
  for (std::size_t k = 0; k < nodes; ++k) {
    const auto slot = static_cast<std::size_t>(lattice.slot_of_node[k]);
    const glm::dvec3& p = positions[k];
    values_[slot] = glm::dvec4(p.x, p.y, p.z, values.empty() ? 0 : values[k]);
    if (weights.empty()) continue;
    values_[slot] *= weights[k];
    weights_[slot].x = weights[k];
  }
  least_weight_ = weights.empty() ? 1 : *std::min_element(weights.begin(), weights.end());
  const std::size_t corners = corners_of(lattice.family).size();
  for (std::size_t k = 0; k < corners; ++k) corner_position_[k] = positions[k];
  corner_faces_.assign(corners, 0);
  const auto faces = faces_of(lattice.family);
  for (std::size_t f = 0; f < faces.size(); ++f)
    for (int k = 0; k < faces[f].size; ++k) corner_faces_[faces[f].corner[static_cast<std::size_t>(k)]] |= 1u << f;
  if (!lattice.is_complete) add_missing_nodes();
  make_inside();
}

/// Prepares the operands from which inner values are computed.
void CurvedCell::make_inside() {
  inside_.clear(), inside_weights_ = weights_;
  if (lattice_->family == CurvedFamily::pyramid) {
    const std::size_t n = lattice_->nodes.size();
    inside_.assign(n, glm::dvec4(0));
    for (std::size_t m = 0; m < n; ++m)
      for (std::size_t k = 0; k < n; ++k)
        inside_[m] +=
            lattice_->pyramid_matrix[m * n + k] * values_[static_cast<std::size_t>(lattice_->slot_of_node[k])];
    return;
  }
  inside_.assign(values_.begin(), values_.begin() + lattice_->slots);
  if (lattice_->has_control_points) {
    cell_to_values(*lattice_, inside_);
    cell_to_values(*lattice_, inside_weights_);
  }
  if (lattice_->has_bubbles) make_bubbles();
}

/// The coefficient of a bubble is the difference between the node in the middle of a face or cell and the sum of the
/// previous functions there, divided by the value of the bubble's function there. Without the node the coefficient is
/// 0, except that the inside of a wedge is interpolated between its triangles.
void CurvedCell::make_bubbles() {
  const auto faces = faces_of(lattice_->family);
  const auto middle = [](const LatticePlace& a, const LatticePlace& b) {
    return LatticePlace{(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2};
  };
  std::size_t made = 0;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (faces[f].size != 3) continue;
    bubbles_[made++] = glm::dvec4(0);
    if (lattice_->slot_of_middle[f] < 0) continue;
    glm::dvec4 corners(0), edges(0);
    for (std::size_t k = 0; k < 3; ++k) {
      const LatticePlace a = lattice_corner(faces[f].corner[k]), b = lattice_corner(faces[f].corner[(k + 1) % 3]);
      corners += node(a), edges += node(middle(a, b));
    }
    const glm::dvec4& own = values_[static_cast<std::size_t>(lattice_->slot_of_middle[f])];
    bubbles_[made - 1] = 27.0 * (own - middle_of_triangle(corners, edges));
  }
  const bool is_wedge = lattice_->family == CurvedFamily::wedge;
  if (lattice_->slot_of_inside < 0) {
    bubbles_[made] = is_wedge ? 0.5 * (bubbles_[0] + bubbles_[1]) : glm::dvec4(0);
    return;
  }
  const glm::dvec4& own = values_[static_cast<std::size_t>(lattice_->slot_of_inside)];
  if (is_wedge) {
    bubbles_[made] = 27.0 * (own - middle_of_triangle(node({0, 0, 1}) + node({2, 0, 1}) + node({0, 2, 1}),
                                                      node({1, 0, 1}) + node({1, 1, 1}) + node({0, 1, 1})));
    return;
  }
  glm::dvec4 corners(0), all(0), on_faces(0);
  for (std::size_t k = 0; k < 4; ++k) corners += node(lattice_corner(k)), on_faces += bubbles_[k];
  for (const glm::dvec4& value : inside_) all += value;
  bubbles_[made] = 256.0 * (own - ((all - corners) / 4.0 - corners / 8.0 + on_faces / 64.0));
}

LatticePlace CurvedCell::lattice_corner(std::size_t corner) const {
  const LatticePlace& p = corners_of(lattice_->family)[corner];
  return {p[0] * lattice_->order[0], p[1] * lattice_->order[1], p[2] * lattice_->order[2]};
}

CellPlace CurvedCell::place_of_corner(std::size_t corner) const {
  const LatticePlace& p = corners_of(lattice_->family)[corner];
  return {p[0] * cell_unit, p[1] * cell_unit, p[2] * cell_unit};
}

bool CurvedCell::before(std::size_t corner, std::size_t other) const {
  const glm::dvec3 &a = corner_position_[corner], &b = corner_position_[other];
  return scene::is_before(a, b) || (a == b && corner < other);
}

std::array<std::size_t, 3> CurvedCell::first_corners(const CellFace& face) const {
  const auto size = static_cast<std::size_t>(face.size);
  std::size_t first = 0;
  for (std::size_t k = 1; k < size; ++k)
    if (before(face.corner[k], face.corner[first])) first = k;
  std::size_t next = face.corner[(first + 1) % size], last = face.corner[(first + size - 1) % size];
  if (before(last, next)) std::swap(next, last);
  return {face.corner[first], next, last};
}

const CurvedCell::Part& CurvedCell::part_on(unsigned faces) {
  for (std::size_t k = 0; k < parts_made_; ++k)
    if (parts_[k].first == faces) return parts_[k].second;
  if (parts_made_ == parts_.size()) parts_.emplace_back();
  auto& [key, part] = parts_[parts_made_++];
  key = faces;
  part.nodes.clear(), part.weights.clear();
  part.has_bubble = false;
  part.dimensions = faces == 0 ? 3 : std::popcount(faces) == 1 ? 2 : 1;
  if (part.dimensions == 2)
    make_face(faces, part);
  else if (part.dimensions == 1)
    make_edge(faces, part);
  return part;
}

void CurvedCell::make_edge(unsigned faces, Part& part) const {
  std::array<std::size_t, 2> end{};
  std::size_t found = 0;
  for (std::size_t c = 0; c < corner_faces_.size() && found < 2; ++c)
    if ((corner_faces_[c] & faces) == faces) end[found++] = c;
  if (before(end[1], end[0])) std::swap(end[0], end[1]);
  const LatticePlace a = lattice_corner(end[0]), b = lattice_corner(end[1]);
  part.origin = place_of_corner(end[0]);
  int n = 1;
  for (std::size_t x = 0; x < 3; ++x)
    if (a[x] != b[x]) {
      n = std::abs(b[x] - a[x]);
      part.axis[0] = static_cast<int>(x);
      part.inverse[0] = b[x] > a[x] ? 1 : -1;
    }
  part.order = {n, 0};
  for (int k = 0; k <= n; ++k)
    add_to(part, {a[0] + k * (b[0] - a[0]) / n, a[1] + k * (b[1] - a[1]) / n, a[2] + k * (b[2] - a[2]) / n});
  if (!lattice_->has_control_points) return;
  rows_to_values(n, 1, part.nodes);
  rows_to_values(n, 1, part.weights);
}

void CurvedCell::add_to(Part& part, const LatticePlace& place) const {
  const auto slot = static_cast<std::size_t>(lattice_->slot(place));
  part.nodes.push_back(values_[slot]);
  if (!weights_.empty()) part.weights.push_back(weights_[slot]);
}

void CurvedCell::make_face(unsigned faces, Part& part) const {
  const auto number = static_cast<std::size_t>(std::countr_zero(faces));
  const CellFace& face = faces_of(lattice_->family)[number];
  const auto [first, next, last] = first_corners(face);
  part.triangle = face.size == 3;
  part.origin = place_of_corner(first);
  const LatticePlace a = lattice_corner(first), b = lattice_corner(next), c = lattice_corner(last);
  // In the cell, the components of the face's two directions are -1, 0 or 1, so two axes are enough to distinguish the
  // directions.
  const auto &A = corners_of(lattice_->family)[first], &B = corners_of(lattice_->family)[next],
             &C = corners_of(lattice_->family)[last];
  for (const auto& [x, y] : {std::pair{0, 1}, std::pair{0, 2}, std::pair{1, 2}}) {
    const auto i = static_cast<std::size_t>(x), j = static_cast<std::size_t>(y);
    const int bx = B[i] - A[i], by = B[j] - A[j], cx = C[i] - A[i], cy = C[j] - A[j], determinant = bx * cy - by * cx;
    if (determinant == 0) continue;
    part.axis = {x, y};
    part.inverse = {cy * determinant, -cx * determinant, -by * determinant,
                    bx * determinant};  // instead of a division: the determinant is 1 or -1
    break;
  }
  part.order = {steps_between(a, b), steps_between(a, c)};
  const auto [n, m] = part.order;
  for (int j = 0; j <= m; ++j)
    for (int i = 0; i <= (part.triangle ? n - j : n); ++i) {
      LatticePlace p;
      for (std::size_t x = 0; x < 3; ++x) p[x] = a[x] + i * (b[x] - a[x]) / n + j * (c[x] - a[x]) / m;
      add_to(part, p);
    }
  if (part.triangle && lattice_->slot_of_middle[number] >= 0) {
    const auto& v = part.nodes;
    part.has_bubble = true;
    part.bubble = 27.0 * (values_[static_cast<std::size_t>(lattice_->slot_of_middle[number])] -
                          middle_of_triangle(v[0] + v[2] + v[5], v[1] + v[3] + v[4]));
  }
  if (lattice_->has_control_points) face_to_values(part);
}

void CurvedCell::face_to_values(Part& part) {
  for (std::vector<glm::dvec4>* all : {&part.nodes, &part.weights}) {
    if (all->empty()) continue;
    if (part.triangle) {
      to_values(3, part.order[0], all->data(), all->size(), 1);
      continue;
    }
    rows_to_values(part.order[0], 1, *all);
    rows_to_values(part.order[1], static_cast<std::size_t>(part.order[0]) + 1, *all);
  }
}

std::array<std::int32_t, 3> CurvedCell::coordinates(const Part& part, const CellPlace& place) {
  if (part.dimensions == 3) return place;
  const auto x = static_cast<std::size_t>(part.axis[0]), y = static_cast<std::size_t>(part.axis[1]);
  const std::int32_t a = place[x] - part.origin[x];
  if (part.dimensions == 1) return {part.inverse[0] * a, 0, 0};
  const std::int32_t b = place[y] - part.origin[y];
  return {part.inverse[0] * a + part.inverse[1] * b, part.inverse[2] * a + part.inverse[3] * b, 0};
}

glm::dvec4 CurvedCell::evaluate(const Part& part, const std::array<double, 3>& x) const {
  const glm::dvec4 value = sum_of(part, part.dimensions == 3 ? inside_ : part.nodes, x);
  return weights_.empty() ? value : value / weight(part, x);
}

double CurvedCell::weight(const Part& part, const std::array<double, 3>& x) const {
  return weights_.empty() ? 1 : sum_of(part, part.dimensions == 3 ? inside_weights_ : part.weights, x).x;
}

glm::dvec4 CurvedCell::sum_of(const Part& part, std::span<const glm::dvec4> nodes,
                              const std::array<double, 3>& x) const {
  if (part.dimensions == 3) return sum_inside(nodes, x);
  if (part.dimensions == 2 && part.triangle) {
    const glm::dvec4 sum = evaluate_triangle(nodes, part.order[0], x[0], x[1]);
    return part.has_bubble ? sum + (x[0] * x[1] * (1 - x[0] - x[1])) * part.bubble : sum;
  }
  Basis a, b;
  lagrange(part.order[0], x[0], a);
  glm::dvec4 sum(0);
  if (part.dimensions == 1) {
    for (std::size_t k = 0; k < nodes.size(); ++k) sum += a[k] * nodes[k];
    return sum;
  }
  lagrange(part.order[1], x[1], b);
  const auto n = static_cast<std::size_t>(part.order[0]), m = static_cast<std::size_t>(part.order[1]);
  for (std::size_t j = 0; j <= m; ++j)
    for (std::size_t i = 0; i <= n; ++i) sum += a[i] * b[j] * nodes[j * (n + 1) + i];
  return sum;
}

glm::dvec4 CurvedCell::sum_inside(std::span<const glm::dvec4> nodes, const std::array<double, 3>& x) const {
  const auto& n = lattice_->order;
  glm::dvec4 sum(0);
  if (lattice_->family == CurvedFamily::pyramid) {
    std::array<double, most_pyramid_nodes> functions;
    pyramid_functions(*lattice_, x, functions);
    for (std::size_t k = 0; k < nodes.size(); ++k) sum += functions[k] * nodes[k];
    return sum;
  }
  Basis a, b, c, d;
  std::size_t at = 0;
  if (lattice_->family == CurvedFamily::hexahedron) {
    lagrange(n[0], x[0], a), lagrange(n[1], x[1], b), lagrange(n[2], x[2], c);
    for (std::size_t k = 0; k <= static_cast<std::size_t>(n[2]); ++k)
      for (std::size_t j = 0; j <= static_cast<std::size_t>(n[1]); ++j) {
        const double bc = b[j] * c[k];
        for (std::size_t i = 0; i <= static_cast<std::size_t>(n[0]); ++i) sum += a[i] * bc * nodes[at++];
      }
    return sum;
  }
  silvester(n[0], x[0], a), silvester(n[0], x[1], b);
  const bool is_wedge = lattice_->family == CurvedFamily::wedge;
  const double last = is_wedge ? 1 - x[0] - x[1] : 1 - x[0] - x[1] - x[2];
  silvester(n[0], last, d);
  if (is_wedge)
    lagrange(n[2], x[2], c);
  else
    silvester(n[2], x[2], c);
  for (int k = 0; k <= n[2]; ++k) {
    const int left = is_wedge ? n[0] : n[0] - k;
    for (int j = 0; j <= left; ++j)
      for (int i = 0; i + j <= left; ++i)
        sum += a[static_cast<std::size_t>(i)] * b[static_cast<std::size_t>(j)] * c[static_cast<std::size_t>(k)] *
               d[static_cast<std::size_t>(left - i - j)] * nodes[at++];
  }
  if (!lattice_->has_bubbles) return sum;
  if (is_wedge) return sum + x[0] * x[1] * last * (c[0] * bubbles_[0] + c[1] * bubbles_[2] + c[2] * bubbles_[1]);
  const std::array<double, 4> at_corner = {last, x[0], x[1], x[2]};
  const auto faces = faces_of(CurvedFamily::tet);
  for (std::size_t f = 0; f < 4; ++f) {
    double product = 1;
    for (std::size_t k = 0; k < 3; ++k) product *= at_corner[faces[f].corner[k]];
    sum += product * bubbles_[f];
  }
  return sum + last * x[0] * x[1] * x[2] * bubbles_[4];
}

glm::dvec4 CurvedCell::at(const CellPlace& place, unsigned faces) {
  const Part& part = part_on(faces);
  const auto x = coordinates(part, place);
  constexpr double unit = cell_unit;
  return evaluate(part, {x[0] / unit, x[1] / unit, x[2] / unit});
}

void CurvedCell::order(std::span<CellPlace> corners, unsigned faces) {
  const Part& part = part_on(faces);
  std::sort(corners.begin(), corners.end(),
            [&](const CellPlace& a, const CellPlace& b) { return coordinates(part, a) < coordinates(part, b); });
}

int CurvedCell::degree_on(unsigned faces) {
  const auto& n = lattice_->order;
  const Part& part = part_on(faces);
  const int weights = weights_.empty() ? 0 : 1, bubbles = lattice_->has_bubbles ? 1 : 0;
  if (part.dimensions == 1) return part.order[0] + weights;
  if (part.dimensions == 2)
    return (part.triangle ? part.order[0] + (part.has_bubble ? 1 : 0) : part.order[0] + part.order[1]) + weights;
  switch (lattice_->family) {
    case CurvedFamily::tet:
      return n[0] + 2 * bubbles + weights;
    case CurvedFamily::hexahedron:
      return n[0] + n[1] + n[2] + weights;
    case CurvedFamily::wedge:
      return n[0] + n[2] + bubbles + weights;
    case CurvedFamily::pyramid:
      return n[0] + 2 + bubbles;  // rational functions, which a polynomial of this degree approximates
  }
  return 1;
}

CurvedCell::Weighted CurvedCell::between(std::span<const CellPlace> corners, std::span<const int> weights, int total,
                                         unsigned faces) {
  const Part& part = part_on(faces);
  std::array<double, 3> x{};
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const auto c = coordinates(part, corners[k]);
    for (std::size_t a = 0; a < 3; ++a) x[a] += static_cast<double>(weights[k]) * c[a];
  }
  const double scale = static_cast<double>(total) * cell_unit;
  for (double& number : x) number /= scale;
  return {evaluate(part, x), weight(part, x)};
}

}  // namespace tessera::cells
