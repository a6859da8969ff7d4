// SPDX-License-Identifier: BSD-3-Clause
#include "reference/bernstein.hpp"

#include <algorithm>

namespace tessera::reference {
namespace {

constexpr std::size_t most = BernsteinBasis::highest_degree + 1;
using Powers = std::array<double, most>;

constexpr std::array<std::array<double, most>, most> pascal() {
  std::array<std::array<double, most>, most> triangle{};
  for (std::size_t n = 0; n < most; ++n) {
    triangle[n][0] = 1;
    for (std::size_t k = 1; k <= n; ++k) triangle[n][k] = triangle[n - 1][k - 1] + (k < n ? triangle[n - 1][k] : 0);
  }
  return triangle;
}
constexpr auto binomials = pascal();

double binomial(int n, int k) { return binomials[static_cast<std::size_t>(n)][static_cast<std::size_t>(k)]; }

double entry(const Powers& of, int i) { return of[static_cast<std::size_t>(i)]; }

/// Returns x to the powers 0 to n.
Powers powers(double x, int n) {
  Powers result{1};
  for (std::size_t i = 1; i <= static_cast<std::size_t>(n); ++i) result[i] = result[i - 1] * x;
  return result;
}

/// Values and slopes of the Bernstein polynomials of one degree in one variable.
struct Line {
  Powers value{}, slope{};

  Line(int n, double x) {
    const Powers rising = powers(x, n), falling = powers(1 - x, n);
    for (int i = 0; i <= n; ++i) {
      const double factor = binomial(n, i);
      value[static_cast<std::size_t>(i)] = factor * entry(rising, i) * entry(falling, n - i);
      const double rise = i > 0 ? i * entry(rising, i - 1) * entry(falling, n - i) : 0;
      const double fall = i < n ? (n - i) * entry(rising, i) * entry(falling, n - i - 1) : 0;
      slope[static_cast<std::size_t>(i)] = factor * (rise - fall);
    }
  }
};

/// Returns the value of a polynomial on a simplex, and its gradient in `gradient`. `at` contains the powers of r, s, t
/// and of the fourth coordinate.
double simplex_function(int n, const std::array<int, 3>& e, const std::array<Powers, 4>& at, glm::dvec3& gradient) {
  const int last = n - e[0] - e[1] - e[2];
  const double factor = binomial(n, e[0]) * binomial(n - e[0], e[1]) * binomial(n - e[0] - e[1], e[2]);
  const std::array<double, 4> x{entry(at[0], e[0]), entry(at[1], e[1]), entry(at[2], e[2]), entry(at[3], last)};
  const auto slope = [&](std::size_t along, int exponent) {
    return exponent > 0 ? factor * exponent * entry(at[along], exponent - 1) : 0;
  };
  const double of_last = slope(3, last) * x[0] * x[1] * x[2];
  gradient = {slope(0, e[0]) * x[1] * x[2] * x[3] - of_last, slope(1, e[1]) * x[0] * x[2] * x[3] - of_last,
              slope(2, e[2]) * x[0] * x[1] * x[3] - of_last};
  return factor * x[0] * x[1] * x[2] * x[3];
}

/// Returns the matrix that converts equally spaced values to coefficients, for polynomials of one degree on a simplex
/// of one, two or three dimensions.
Matrix simplex_from_lattice(const std::vector<std::array<int, 3>>& exponents, int n) {
  Matrix values(exponents.size(), exponents.size());
  for (std::size_t row = 0; row < exponents.size(); ++row) {
    glm::dvec3 place(0);
    if (n > 0) place = glm::dvec3(exponents[row][0], exponents[row][1], exponents[row][2]) / static_cast<double>(n);
    const std::array<Powers, 4> at{powers(place.x, n), powers(place.y, n), powers(place.z, n),
                                   powers(1 - place.x - place.y - place.z, n)};
    for (std::size_t column = 0; column < exponents.size(); ++column) {
      glm::dvec3 unused;
      values(row, column) = simplex_function(n, exponents[column], at, unused);
    }
  }
  return inverse(values);
}

std::vector<std::array<int, 3>> line_exponents(int n) {
  std::vector<std::array<int, 3>> result;
  for (int i = 0; i <= n; ++i) result.push_back({i, 0, 0});
  return result;
}

std::vector<std::array<int, 3>> triangle_exponents(int n) {
  std::vector<std::array<int, 3>> result;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i + j <= n; ++i) result.push_back({i, j, 0});
  return result;
}

}  // namespace

bool holds(Domain domain, const glm::dvec3& place, double tolerance) {
  if (!(std::min({place.x, place.y, place.z}) >= -tolerance)) return false;
  switch (domain) {
    case Domain::tet:
      return place.x + place.y + place.z <= 1 + tolerance;
    case Domain::prism:
      return std::max(place.x + place.y, place.z) <= 1 + tolerance;
    case Domain::box:
      break;
  }
  return std::max({place.x, place.y, place.z}) <= 1 + tolerance;
}

BernsteinBasis::BernsteinBasis(Domain domain, std::array<int, 3> degree) : domain_(domain), degree_(degree) {
  if (domain != Domain::box) degree_[1] = degree_[0];
  if (domain == Domain::tet) degree_[2] = degree_[0];
  for (int k = 0; k <= degree_[2]; ++k)
    for (int j = 0; j <= degree_[1]; ++j)
      for (int i = 0; i <= degree_[0]; ++i) {
        const int total = i + j + (domain == Domain::tet ? k : 0);
        if (domain == Domain::box || total <= degree_[0]) exponents_.push_back({i, j, k});
      }
}

std::size_t BernsteinBasis::index(int i, int j, int k) const {
  const std::array<int, 3> wanted{i, j, k};
  return static_cast<std::size_t>(std::find(exponents_.begin(), exponents_.end(), wanted) - exponents_.begin());
}

void BernsteinBasis::evaluate(const glm::dvec3& place, std::span<double> values,
                              std::span<glm::dvec3> gradients) const {
  if (domain_ == Domain::box) {
    const Line r(degree_[0], place.x), s(degree_[1], place.y), t(degree_[2], place.z);
    for (std::size_t n = 0; n < size(); ++n) {
      const auto& [i, j, k] = exponents_[n];
      const double vr = entry(r.value, i), vs = entry(s.value, j), vt = entry(t.value, k);
      values[n] = vr * vs * vt;
      gradients[n] = {entry(r.slope, i) * vs * vt, vr * entry(s.slope, j) * vt, vr * vs * entry(t.slope, k)};
    }
    return;
  }
  const bool prism = domain_ == Domain::prism;
  const double z = prism ? 0 : place.z;
  const std::array<Powers, 4> at{powers(place.x, degree_[0]), powers(place.y, degree_[0]), powers(z, degree_[0]),
                                 powers(1 - place.x - place.y - z, degree_[0])};
  const Line t(prism ? degree_[2] : 0, place.z);
  for (std::size_t n = 0; n < size(); ++n) {
    const auto& [i, j, k] = exponents_[n];
    values[n] = simplex_function(degree_[0], {i, j, prism ? 0 : k}, at, gradients[n]);
    if (!prism) continue;
    const double along = entry(t.value, k);
    gradients[n] = {gradients[n].x * along, gradients[n].y * along, values[n] * entry(t.slope, k)};
    values[n] *= along;
  }
}

std::vector<glm::dvec3> BernsteinBasis::lattice() const {
  std::vector<glm::dvec3> places;
  for (const auto& e : exponents_) {
    glm::dvec3 place(0);
    for (int a = 0; a < 3; ++a) {
      const auto axis = static_cast<std::size_t>(a);
      if (degree_[axis] > 0) place[a] = static_cast<double>(e[axis]) / degree_[axis];
    }
    places.push_back(place);
  }
  return places;
}

Matrix BernsteinBasis::from_lattice() const {
  if (domain_ == Domain::tet) return simplex_from_lattice(exponents_, degree_[0]);
  const auto line = [](int n) { return simplex_from_lattice(line_exponents(n), n); };
  if (domain_ == Domain::prism)
    return kronecker(line(degree_[2]), simplex_from_lattice(triangle_exponents(degree_[0]), degree_[0]));
  return kronecker(line(degree_[2]), kronecker(line(degree_[1]), line(degree_[0])));
}

std::vector<FacePatch> BernsteinBasis::faces() const {
  std::vector<FacePatch> result;
  const auto [nr, ns, nt] = degree_;
  // `exponents(i, j)` returns the exponents of the cell's function with index (i, j) on the face.
  const auto add = [&](bool triangle, int nu, int nv, const glm::dvec3& origin, const glm::dvec3& u,
                       const glm::dvec3& v, const auto& exponents) {
    FacePatch face{triangle, nu, nv, origin, u, v, {}};
    for (int j = 0; j <= nv; ++j)
      for (int i = 0; i <= (triangle ? nu - j : nu); ++i) {
        const std::array<int, 3> e = exponents(i, j);
        face.control.push_back(index(e[0], e[1], e[2]));
      }
    result.push_back(face);
  };
  using Exponents = std::array<int, 3>;
  const int n = degree_[0], m = degree_[2];
  switch (domain_) {
    case Domain::tet:
      add(true, n, n, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, [](int i, int j) { return Exponents{i, j, 0}; });
      add(true, n, n, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}, [](int i, int j) { return Exponents{i, 0, j}; });
      add(true, n, n, {0, 0, 0}, {0, 1, 0}, {0, 0, 1}, [](int i, int j) { return Exponents{0, i, j}; });
      add(true, n, n, {0, 0, 1}, {1, 0, -1}, {0, 1, -1}, [n](int i, int j) { return Exponents{i, j, n - i - j}; });
      break;
    case Domain::prism:
      for (const int end : {0, 1})
        add(true, n, n, {0, 0, end}, {1, 0, 0}, {0, 1, 0}, [&](int i, int j) { return Exponents{i, j, end * m}; });
      add(false, n, m, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}, [](int i, int j) { return Exponents{i, 0, j}; });
      add(false, n, m, {0, 0, 0}, {0, 1, 0}, {0, 0, 1}, [](int i, int j) { return Exponents{0, i, j}; });
      add(false, n, m, {1, 0, 0}, {-1, 1, 0}, {0, 0, 1}, [n](int i, int j) { return Exponents{n - i, i, j}; });
      break;
    case Domain::box:
      for (const int end : {0, 1}) {
        const int at_r = end * degree_[0], at_s = end * degree_[1], at_t = end * degree_[2];
        add(false, ns, nt, {end, 0, 0}, {0, 1, 0}, {0, 0, 1}, [&](int i, int j) { return Exponents{at_r, i, j}; });
        add(false, nr, nt, {0, end, 0}, {1, 0, 0}, {0, 0, 1}, [&](int i, int j) { return Exponents{i, at_s, j}; });
        add(false, nr, ns, {0, 0, end}, {1, 0, 0}, {0, 1, 0}, [&](int i, int j) { return Exponents{i, j, at_t}; });
      }
      break;
  }
  return result;
}

}  // namespace tessera::reference
