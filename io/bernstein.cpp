#include "io/bernstein.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <utility>

namespace tessera::io {
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

/// Gauss and Jordan's elimination with partial pivoting, in long double.
std::vector<double> inverse(std::vector<long double> a, std::size_t n) {
  std::vector<long double> b(n * n, 0);
  for (std::size_t i = 0; i < n; ++i) b[i * n + i] = 1;
  for (std::size_t column = 0; column < n; ++column) {
    std::size_t pivot = column;
    for (std::size_t row = column + 1; row < n; ++row)
      if (std::abs(a[row * n + column]) > std::abs(a[pivot * n + column])) pivot = row;
    for (std::size_t k = 0; k < n; ++k) {
      std::swap(a[pivot * n + k], a[column * n + k]);
      std::swap(b[pivot * n + k], b[column * n + k]);
    }
    const long double scale = 1 / a[column * n + column];
    for (std::size_t k = 0; k < n; ++k) a[column * n + k] *= scale, b[column * n + k] *= scale;
    for (std::size_t row = 0; row < n; ++row) {
      const long double factor = a[row * n + column];
      if (row == column || factor == 0) continue;
      for (std::size_t k = 0; k < n; ++k) {
        a[row * n + k] -= factor * a[column * n + k];
        b[row * n + k] -= factor * b[column * n + k];
      }
    }
  }
  return {b.begin(), b.end()};
}

BernsteinForm make_form(int corners, int degree) {
  BernsteinForm form;
  form.points = lattice_of(corners, degree, false);
  const std::size_t n = form.points.size();
  std::vector<long double> values(n * n);
  for (std::size_t at = 0; at < n; ++at)
    for (std::size_t of = 0; of < n; ++of) values[of * n + at] = bernstein(form.points[of], form.points[at], degree);
  form.matrix = inverse(std::move(values), n);  // of the transpose, as the matrix is kept
  return form;
}

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

namespace {

/// One of each degree, made when it is first asked for.
template <class Made, class Make>
const Made& of_degree(int degree, std::array<std::unique_ptr<const Made>, highest_degree + 1>& all,
                      std::array<std::once_flag, highest_degree + 1>& made, const Make& make) {
  const auto at = static_cast<std::size_t>(degree);
  std::call_once(made[at], [&] { all[at] = std::make_unique<const Made>(make()); });
  return *all[at];
}

}  // namespace

const BernsteinNet& bernstein_net(int degree) {
  static std::array<std::unique_ptr<const BernsteinNet>, highest_degree + 1> nets;
  static std::array<std::once_flag, highest_degree + 1> made;
  return of_degree(degree, nets, made, [&] { return BernsteinNet(degree); });
}

const BernsteinForm& bernstein_form(int corners, int degree) {
  static std::array<std::array<std::unique_ptr<const BernsteinForm>, highest_degree + 1>, 3> forms;
  static std::array<std::array<std::once_flag, highest_degree + 1>, 3> made;
  const auto of = static_cast<std::size_t>(corners - 2);
  return of_degree(degree, forms[of], made[of], [&] { return make_form(corners, degree); });
}

}  // namespace tessera::io
