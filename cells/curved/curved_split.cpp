// SPDX-License-Identifier: BSD-3-Clause
#include "cells/curved/curved_split.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <stdexcept>

#include "cells/curved/bernstein.hpp"
#include "scene/position_order.hpp"

namespace tessera::cells {
namespace {

using scene::Tet;

constexpr std::array<std::array<int, 2>, 6> edges_of_tet = {{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};
constexpr std::array<std::array<int, 3>, 4> faces_of_tet = {{{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}}};

/// Factor by which the coefficients inside a tet may exceed those on its edges: up to 1.5 for a second-degree
/// polynomial written in a higher degree. If edges are halved down to the tolerance divided by this factor, inner
/// points, which do not shorten edges, are rarely needed.
double room_inside(int degree) { return degree <= 2 ? 1 : 1.5; }

/// Rational functions have their largest curvature near one corner, the apex of a pyramid. Pyramids needed three to
/// four times as many tets as predicted from their initial edges, which is this factor to the power of 3/2.
constexpr double worst_of_fractions = 2.5;

}  // namespace

double cost_of_tet(const CurvedLattice& lattice) {
  const auto& n = lattice.order;
  const int degree = std::min(lattice.family == CurvedFamily::tet ? n[0] : n[0] + n[1] + n[2], highest_degree);
  return std::max((degree + 1) * (degree + 2) * (degree + 3) / 120.0, 1.0);  // the cost is 1 for 20 coefficients
}

void CurvedError::add(const CurvedError& other) {
  position = std::max(position, other.position);
  field = std::max(field, other.field);
}

void CurvedSplitter::begin(const CurvedLattice& lattice, std::span<const glm::dvec3> positions,
                           std::span<const double> values, std::span<const double> weights) {
  cell_.set(lattice, positions, values, weights);
  corners_ = corners_of(lattice.family).size();
  places_.clear(), faces_.clear(), values_.clear(), edges_.clear(), face_points_.clear();
  open_.clear(), tets_.clear(), open_nets_.clear();
  error_ = {};
  degree_ = std::min(cell_.degree_on(0), highest_degree);
  net_ = &bernstein_net(degree_);
  nets_are_exact_ = cell_.is_polynomial() && cell_.degree_on(0) == degree_;
  for (std::size_t c = 0; c < corners_; ++c) {
    places_.push_back(cell_.place_of_corner(c));
    faces_.push_back(cell_.faces_of_corner(c));
    const glm::dvec3& p = positions[c];
    values_.emplace_back(p.x, p.y, p.z, values.empty() ? 0 : values[c]);
  }
}

void CurvedSplitter::split(const CurvedLattice& lattice, std::span<const glm::dvec3> positions,
                           std::span<const double> values, std::span<const double> weights, std::span<const Tet> first,
                           std::size_t limit) {
  begin(lattice, positions, values, weights);
  for (std::size_t k = first.size(); k > 0; --k) open(first[k - 1]);
  while (!open_.empty()) {
    const Tet tet = open_.back();
    open_.pop_back();
    if (nets_are_exact_) {
      const auto net = open_nets_.end() - static_cast<std::ptrdiff_t>(net_->size());
      tet_net_.assign(net, open_nets_.end());
      open_nets_.erase(net, open_nets_.end());
    }
    if (!halve_worst_edge(tet) && !divide_worst_face(tet)) {
      error_.add(tet_error_);
      tets_.push_back(tet);
    }
    if (tets_.size() + open_.size() > limit) throw std::length_error("tets");
  }
}

void CurvedSplitter::open(const Tet& tet) {
  open_.push_back(tet);
  if (!nets_are_exact_) return;
  make_net(tet);
  open_nets_.insert(open_nets_.end(), tet_net_.begin(), tet_net_.end());
}

void CurvedSplitter::make_net(const Tet& tet) {
  const std::span<const glm::dvec4> off = departures(tet);
  // departures() sorts the corners and omits their coefficients.
  std::array<CellPlace, 4> place;
  for (std::size_t k = 0; k < 4; ++k) place[k] = places_[tet[k]];
  cell_.order(place, 0);
  std::array<std::size_t, 4> at{};  // index in the tet of each sorted corner
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t c = 0; c < 4; ++c)
      if (places_[tet[c]] == place[k]) at[k] = c;
  tet_net_.clear();
  for (const auto& point : net_->points()) {
    glm::dvec4 straight(0);
    for (std::size_t c = 0; c < 4; ++c) straight += static_cast<double>(point[c]) / degree_ * values_[tet[c]];
    tet_net_.push_back(straight);
  }
  if (degree_ < 2) return;
  const auto& ordered = bernstein_form(4, degree_).points;
  for (std::size_t k = 0; k < off.size(); ++k) {
    std::array<int, 4> point{};
    for (std::size_t c = 0; c < 4; ++c) point[at[c]] = ordered[k][c];
    tet_net_[net_->index(point)] += off[k];
  }
}

void CurvedSplitter::tally_excess(const CurvedLattice& lattice, std::span<const glm::dvec3> positions,
                                  std::span<const double> values, std::span<const double> weights,
                                  std::span<const Tet> first, const std::function<void(double)>& report) {
  begin(lattice, positions, values, weights);
  for (const Tet& tet : first) {
    double worst = 0;
    for (const auto& [a, b] : edges_of_tet)
      worst = std::max<double>(worst, edge(tet[static_cast<std::size_t>(a)], tet[static_cast<std::size_t>(b)]).excess);
    // Nodes within faces and cells can curve the interior even if the edges are straight.
    if (lattice.has_bubbles || worst <= 1) worst = std::max(worst, excess_of(departures(tet)) / room_inside(degree_));
    report(cell_.is_polynomial() ? worst : worst_of_fractions * worst);
  }
}

unsigned CurvedSplitter::faces_on(Corners corners) const {
  unsigned faces = ~0u;
  for (const std::uint32_t v : corners) faces &= faces_[v];
  return faces;
}

std::span<const glm::dvec4> CurvedSplitter::departures(Corners corners) {
  const unsigned faces = faces_on(corners);
  const int degree = std::min(cell_.degree_on(faces), highest_degree);
  samples_.clear(), coefficients_.clear();
  if (degree < 2) return coefficients_;
  std::array<CellPlace, 4> place;
  for (std::size_t k = 0; k < corners.size(); ++k) place[k] = places_[corners[k]];
  const std::span places(place.data(), corners.size());
  cell_.order(places, faces);
  std::array<glm::dvec4, 4> value{};
  for (std::size_t k = 0; k < corners.size(); ++k)
    for (const std::uint32_t v : corners)
      if (places_[v] == place[k]) value[k] = values_[v];
  const BernsteinForm& form = bernstein_form(static_cast<int>(corners.size()), degree);
  weight_samples_.clear();
  for (const auto& weights : form.points) {
    glm::dvec4 straight(0);
    for (std::size_t k = 0; k < corners.size(); ++k) straight += static_cast<double>(weights[k]) * value[k];
    const auto [at, weight] = cell_.between(places, std::span(weights).first(corners.size()), degree, faces);
    samples_.push_back(at - straight / static_cast<double>(degree));
    if (cell_.has_weights()) samples_.back() *= weight, weight_samples_.push_back(weight);
  }
  const std::size_t n = samples_.size();
  coefficients_.assign(n, glm::dvec4(0));
  for (std::size_t j = 0; j < n; ++j)  // computed column by column, so that the sums are independent
    for (std::size_t k = 0; k < n; ++k) coefficients_[k] += form.matrix[j * n + k] * samples_[j];
  if (cell_.has_weights()) {
    const double scale = 1 / least_weight(places, faces, form);
    for (glm::dvec4& coefficient : coefficients_) coefficient *= scale;
  }
  return coefficients_;
}

/// Returns a lower bound of the weights by which the samples of departures() are multiplied: the least of the weights'
/// Bernstein coefficients.
double CurvedSplitter::least_weight(std::span<const CellPlace> places, unsigned faces, const BernsteinForm& form) {
  std::array<double, 4> at_corner{};
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < places.size(); ++k) {
    std::array<int, 4> alone{};
    alone[k] = 1;
    at_corner[k] = cell_.between(places, std::span(alone).first(places.size()), 1, faces).weight;
    least = std::min(least, at_corner[k]);
  }
  const std::size_t n = form.points.size();
  const auto straight = [&](std::size_t point) {
    double sum = 0, total = 0;
    for (std::size_t c = 0; c < places.size(); ++c)
      sum += form.points[point][c] * at_corner[c], total += form.points[point][c];
    return sum / total;
  };
  for (std::size_t k = 0; k < n; ++k) weight_samples_[k] -= straight(k);
  for (std::size_t k = 0; k < n; ++k) {
    double coefficient = straight(k);
    for (std::size_t j = 0; j < n; ++j) coefficient += form.matrix[j * n + k] * weight_samples_[j];
    least = std::min(least, coefficient);
  }
  return std::max(least, cell_.least_weight());
}

std::span<const glm::dvec4> CurvedSplitter::net_departures(const Tet& tet) {
  const auto points = net_->points();
  const double scale = 1.0 / degree_;
  const std::array<glm::dvec4, 4> corner = {scale * values_[tet[0]], scale * values_[tet[1]], scale * values_[tet[2]],
                                            scale * values_[tet[3]]};
  coefficients_.resize(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    glm::dvec4 off = tet_net_[k];
    for (std::size_t c = 0; c < 4; ++c) off -= static_cast<double>(points[k][c]) * corner[c];
    coefficients_[k] = off;
  }
  return coefficients_;
}

double CurvedSplitter::excess_of(std::span<const glm::dvec4> departures) const {
  double position = 0, field = 0;  // position squared
  for (const glm::dvec4& d : departures) {
    position = std::max(position, d.x * d.x + d.y * d.y + d.z * d.z);
    field = std::max(field, std::abs(d.w));
  }
  return std::max(std::sqrt(position) / tolerance_.position, field / tolerance_.field);
}

CurvedSplitter::Edge& CurvedSplitter::edge(std::uint32_t a, std::uint32_t b) {
  const std::uint64_t key = std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
  const auto [place, is_new] = edges_.try_emplace(key, Edge{0, none});
  if (!is_new) return place->second;
  const std::array<std::uint32_t, 2> ends = {a, b};
  // An edge is only halved if its midpoint is a whole number of units; otherwise the neighbours might not agree on it.
  const CellPlace &p = places_[a], &q = places_[b];
  const bool can_be_halved = ((p[0] + q[0]) | (p[1] + q[1]) | (p[2] + q[2])) % 2 == 0;
  if (can_be_halved) {
    const int degree = std::min(cell_.degree_on(faces_on(ends)), highest_degree);
    place->second.excess = static_cast<float>(excess_of(departures(ends)) * room_inside(degree));
  }
  return place->second;
}

bool CurvedSplitter::before(std::uint32_t a, std::uint32_t b) const {
  const glm::dvec3 p(values_[a]), q(values_[b]);
  return p != q ? scene::is_before(p, q) : a < b;
}

std::uint32_t CurvedSplitter::add_point(const CellPlace& place, unsigned faces) {
  places_.push_back(place);
  faces_.push_back(faces);
  values_.push_back(cell_.at(place, faces));
  return static_cast<std::uint32_t>(places_.size() - 1);
}

/// If two edges deviate equally, their positions decide, so that neighbours choose the same edge.
bool CurvedSplitter::halve_worst_edge(const Tet& tet) {
  std::array<std::uint32_t, 2> worst{};
  float excess = 1;
  for (const auto& [i, j] : edges_of_tet) {
    std::array<std::uint32_t, 2> ends = {tet[static_cast<std::size_t>(i)], tet[static_cast<std::size_t>(j)]};
    if (before(ends[1], ends[0])) std::swap(ends[0], ends[1]);
    const float own = edge(ends[0], ends[1]).excess;
    const bool is_worse =
        own > excess ||
        (own == excess && own > 1 && (before(ends[0], worst[0]) || (ends[0] == worst[0] && before(ends[1], worst[1]))));
    if (is_worse) worst = ends, excess = own;
  }
  if (excess <= 1) return false;
  Edge& halved = edge(worst[0], worst[1]);
  if (halved.middle == none) {
    const CellPlace &p = places_[worst[0]], &q = places_[worst[1]];
    halved.middle =
        add_point({(p[0] + q[0]) / 2, (p[1] + q[1]) / 2, (p[2] + q[2]) / 2}, faces_[worst[0]] & faces_[worst[1]]);
  }
  std::array<int, 2> corner{};
  for (std::size_t end = 0; end < 2; ++end) {
    Tet half = tet;
    const auto at = std::find(half.begin(), half.end(), worst[end]);
    corner[end] = static_cast<int>(at - half.begin());
    *at = halved.middle;
    open_.push_back(half);
  }
  if (!nets_are_exact_) return true;
  const std::size_t first = open_nets_.size(), size = net_->size();
  open_nets_.resize(first + 2 * size);
  const std::span<glm::dvec4> halves(open_nets_);
  // The first of the two halves does not contain corner[0].
  net_->halve(tet_net_, corner[1], corner[0], halves.subspan(first, size), halves.subspan(first + size, size));
  return true;
}

/// Adds a point inside a triangle or tet and returns its number; `none` if no such point has whole units. For a
/// triangle, both neighbours get the same point.
std::uint32_t CurvedSplitter::point_within(Corners corners) {
  const unsigned faces = faces_on(corners);
  std::array<CellPlace, 4> place;
  for (std::size_t k = 0; k < corners.size(); ++k) place[k] = places_[corners[k]];
  cell_.order(std::span(place.data(), corners.size()), faces);
  CellPlace point;
  for (std::size_t x = 0; x < 3; ++x) {
    const std::int32_t sum =
        place[0][x] + place[1][x] + (corners.size() == 3 ? 2 * place[2][x] : place[2][x] + place[3][x]);
    if (sum % 4 != 0) return none;
    point[x] = sum / 4;
  }
  if (corners.size() == 4) return add_point(point, faces);
  std::array<std::uint32_t, 3> key = {corners[0], corners[1], corners[2]};
  std::sort(key.begin(), key.end());
  const auto [known, is_new] = face_points_.try_emplace(key, none);
  if (is_new) known->second = add_point(point, faces);
  return known->second;
}

bool CurvedSplitter::divide_worst_face(const Tet& tet) {
  if (!nets_are_exact_) make_net(tet);
  const std::span<const glm::dvec4> inside = net_departures(tet);
  tet_error_ = error_of(inside);
  if (cell_.degree_on(faces_on(tet)) < 3) return false;  // all coefficients belong to edges
  // The result is NaN if coordinates are too large to be squared; then no point would reduce it.
  const double excess = excess_of(inside);
  if (!(excess > 0)) return false;
  for (const auto& [i, j, k] : faces_of_tet) {
    const std::array<std::uint32_t, 3> face = {tet[static_cast<std::size_t>(i)], tet[static_cast<std::size_t>(j)],
                                               tet[static_cast<std::size_t>(k)]};
    const int degree = cell_.degree_on(faces_on(face));
    // If face and tet have the same degree, the face's coefficients are among those of the tet. If all of the tet's
    // coefficients are below the tolerance by more than rounding, the face is not divided, and the tet on its other
    // side leads to the same decision. If the face has a lower degree, its coefficients are larger than the tet's.
    if (degree < 3 || (excess <= 0.9 && nets_are_exact_ && degree == degree_)) continue;
    if (!(excess_of(departures(face)) > 1)) continue;
    const std::uint32_t point = point_within(face);
    if (point == none) continue;
    for (const std::uint32_t corner : face) {
      Tet part = tet;
      std::replace(part.begin(), part.end(), corner, point);
      open(part);
    }
    return true;
  }
  if (excess <= 1) return false;
  const std::uint32_t point = point_within(tet);
  if (point == none) return false;
  for (const std::uint32_t corner : tet) {
    Tet part = tet;
    std::replace(part.begin(), part.end(), corner, point);
    open(part);
  }
  return true;
}

/// Returns the gradient of the field in space at a corner of the current tet. It is computed from the coefficients next
/// to the corner, which are the derivatives along the tet's edges. Zero where space is folded.
glm::dvec3 CurvedSplitter::gradient_at(std::size_t corner) const {
  const glm::dvec4& here = tet_net_[net_->corner(corner)];
  std::array<glm::dvec4, 3> along;
  for (std::size_t c = 0, n = 0; c < 4; ++c) {
    if (c == corner) continue;
    std::array<int, 4> next{};
    next[corner] = degree_ - 1;
    next[c] += 1;
    along[n++] = tet_net_[net_->index(next)] - here;
  }
  const auto& [b, c, d] = along;
  const glm::dmat3 edges(glm::dvec3(b.x, c.x, d.x), glm::dvec3(b.y, c.y, d.y), glm::dvec3(b.z, c.z, d.z));
  if (glm::determinant(edges) == 0) return glm::dvec3(0);
  const glm::dvec3 gradient = glm::inverse(edges) * glm::dvec3(b.w, c.w, d.w);
  const bool is_finite = std::isfinite(gradient.x) && std::isfinite(gradient.y) && std::isfinite(gradient.z);
  return is_finite ? gradient : glm::dvec3(0);
}

/// At a fixed point in space, the error of the field is its error at a fixed place of the cell minus the slope of the
/// field times the displacement of the place. The slopes are those of the cell, because those of a thin tet do not
/// represent its surroundings.
CurvedError CurvedSplitter::error_of(std::span<const glm::dvec4> departures) const {
  CurvedError error;
  for (const glm::dvec4& d : departures) error.position = std::max(error.position, d.x * d.x + d.y * d.y + d.z * d.z);
  error.position = std::sqrt(error.position);
  if (tolerance_.field == std::numeric_limits<double>::infinity()) return error;
  for (std::size_t corner = 0; corner < 4; ++corner) {
    const glm::dvec3 slope = gradient_at(corner);
    for (const glm::dvec4& d : departures)
      error.field = std::max(error.field, std::abs(d.w - glm::dot(slope, glm::dvec3(d.x, d.y, d.z))));
  }
  return error;
}

}  // namespace tessera::cells
