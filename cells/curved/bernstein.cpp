// SPDX-License-Identifier: BSD-3-Clause
#include "cells/curved/bernstein.hpp"

#include <algorithm>
#include <memory>
#include <mutex>
#include <utility>

#include "cells/curved/inverse_matrix.hpp"

namespace tessera::cells {
namespace {

using Multi = std::array<int, 4>;

std::vector<Multi> lattice_of(int corners, int degree, bool with_corners) {
  std::vector<Multi> points;
  const int last_k = corners > 2 ? degree : 0, last_l = corners > 3 ? degree : 0;
  for (int l = 0; l <= last_l; ++l)
    for (int k = 0; k <= last_k - l; ++k)
      for (int j = 0; j <= degree - k - l; ++j) {
        const Multi point = {degree - j - k - l, j, k, l};
        const bool is_corner = std::count(point.begin(), point.end(), degree) > 0;
        if (with_corners || !is_corner) points.push_back(point);
      }
  return points;
}

long double bernstein(const Multi& of, const Multi& at, int degree) {
  long double value = 1;
  int factor = degree;
  for (std::size_t c = 0; c < 4; ++c)
    for (int m = 1; m <= of[c]; ++m, --factor)
      value *= static_cast<long double>(factor) / m * static_cast<long double>(at[c]) / degree;
  return value;
}

BernsteinForm make_form(int corners, int degree) {
  BernsteinForm form;
  form.points = lattice_of(corners, degree, false);
  const std::size_t n = form.points.size();
  std::vector<long double> values(n * n);
  for (std::size_t at = 0; at < n; ++at)
    for (std::size_t of = 0; of < n; ++of) values[of * n + at] = bernstein(form.points[of], form.points[at], degree);
  form.matrix = inverse_matrix(std::move(values), n);  // transposed, because the matrix is stored transposed
  return form;
}

/// One object per degree, created when it is first requested.
template <class Made>
struct OfDegrees {
  std::array<std::unique_ptr<const Made>, highest_degree + 1> all;
  std::array<std::once_flag, highest_degree + 1> made;

  template <class Make>
  const Made& at(int degree, const Make& make) {
    const auto place = static_cast<std::size_t>(degree);
    std::call_once(made[place], [&] { all[place] = std::make_unique<const Made>(make()); });
    return *all[place];
  }
};

}  // namespace

BernsteinNet::BernsteinNet(int degree)
    : degree_(degree), side_(static_cast<std::size_t>(degree) + 1), points_(lattice_of(4, degree, true)) {
  index_.resize(side_ * side_ * side_);
  for (std::size_t k = 0; k < points_.size(); ++k) index_[place(points_[k])] = k;
  for (std::size_t c = 0; c < 4; ++c) {
    Multi point{};
    point[c] = degree;
    corner_[c] = index(point);
  }
}

void BernsteinNet::halve(std::span<const glm::dvec4> net, int i, int j, std::span<glm::dvec4> half_i,
                         std::span<glm::dvec4> half_j) const {
  std::array<std::size_t, 2> others{};
  for (std::size_t c = 0, n = 0; c < 4; ++c)
    if (static_cast<int>(c) != i && static_cast<int>(c) != j) others[n++] = c;
  std::array<glm::dvec4, highest_degree + 1> row;
  for (int k = 0; k <= degree_; ++k)
    for (int l = 0; k + l <= degree_; ++l) {
      const int n = degree_ - k - l;
      Multi point{};
      point[others[0]] = k, point[others[1]] = l;
      const auto at = [&](int t) {
        point[static_cast<std::size_t>(i)] = n - t, point[static_cast<std::size_t>(j)] = t;
        return index(point);
      };
      for (int t = 0; t <= n; ++t) row[static_cast<std::size_t>(t)] = net[at(t)];
      half_i[at(0)] = row[0];
      half_j[at(n)] = row[static_cast<std::size_t>(n)];
      for (int step = 1; step <= n; ++step) {
        for (int t = 0; t + step <= n; ++t)
          row[static_cast<std::size_t>(t)] =
              0.5 * (row[static_cast<std::size_t>(t)] + row[static_cast<std::size_t>(t) + 1]);
        half_i[at(step)] = row[0];
        half_j[at(n - step)] = row[static_cast<std::size_t>(n) - static_cast<std::size_t>(step)];
      }
    }
}

const BernsteinNet& bernstein_net(int degree) {
  static OfDegrees<BernsteinNet> nets;
  return nets.at(degree, [&] { return BernsteinNet(degree); });
}

const BernsteinForm& bernstein_form(int corners, int degree) {
  static std::array<OfDegrees<BernsteinForm>, 3> forms;
  return forms[static_cast<std::size_t>(corners - 2)].at(degree, [&] { return make_form(corners, degree); });
}

const std::vector<double>& bernstein_values(int corners, int degree) {
  static std::array<OfDegrees<std::vector<double>>, 3> values;
  return values[static_cast<std::size_t>(corners - 2)].at(degree, [&] {
    const std::vector<Multi> points = lattice_of(corners, degree, true);
    std::vector<double> made;
    made.reserve(points.size() * points.size());
    for (const Multi& at : points)
      for (const Multi& of : points) made.push_back(static_cast<double>(bernstein(of, at, degree)));
    return made;
  });
}

}  // namespace tessera::cells
