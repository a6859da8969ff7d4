// SPDX-License-Identifier: BSD-3-Clause
#include "cells/curved/curved_pyramid.hpp"

#include <algorithm>

#include "cells/curved/inverse_matrix.hpp"

namespace tessera::cells {
namespace {

/// Evaluates the functions that VTK's two quadratic pyramids share. x and y are from -1 to 1 across the pyramid at any
/// height; w is from 2 at the base to 0 at the apex. Returns the number of functions.
std::size_t quadratic_functions(double x, double y, double w, std::span<double> out) {
  const double ww = w * w;
  const std::array<double, 11> values = {1,      w,      ww,         x * w,          y * w,         x * y * w,
                                         x * ww, y * ww, x * y * ww, x * y * y * ww, x * x * y * ww};
  std::copy(values.begin(), values.end(), out.begin());
  return values.size();
}

/// Evaluates the Legendre polynomials of degree 0 to n.
void legendre(int n, double x, std::span<double> out) {
  out[0] = 1;
  if (n > 0) out[1] = x;
  for (int k = 2; k <= n; ++k) {
    const auto at = static_cast<std::size_t>(k);
    out[at] = ((2 * k - 1) * x * out[at - 1] - (k - 1) * out[at - 2]) / k;
  }
}

/// Evaluates the products of polynomials of degree i in x, j in y and up to n - max(i, j) in height, times
/// height^max(i, j).
void lagrange_functions(int n, double x, double y, double height, std::span<double> out) {
  std::array<double, highest_pyramid_order + 1> across_x{}, across_y{}, along{};
  legendre(n, x, across_x), legendre(n, y, across_y), legendre(n, 2 * height - 1, along);
  std::size_t at = 0;
  double power = 1;
  for (int most = 0; most <= n; ++most, power *= height)
    for (int i = 0; i <= most; ++i)
      for (int j = 0; j <= most; ++j) {
        if (std::max(i, j) != most) continue;
        const double product = across_x[static_cast<std::size_t>(i)] * across_y[static_cast<std::size_t>(j)] * power;
        for (int k = 0; k <= n - most; ++k) out[at++] = product * along[static_cast<std::size_t>(k)];
      }
}

}  // namespace

void pyramid_functions(const CurvedLattice& lattice, const std::array<double, 3>& place, std::span<double> values) {
  const double height = 1 - place[2], x = height > 0 ? 2 * place[0] / height - 1 : 0,
               y = height > 0 ? 2 * place[1] / height - 1 : 0, w = 2 * height, ww = w * w;
  const double xx = x * x, yy = y * y;
  if (lattice.nodes.size() == 13) {
    std::size_t at = quadratic_functions(x, y, w, values);
    values[at++] = (xx - yy) * ww;
    values[at] = 2 * w * (xx + yy - xx * yy) - ww * ((xx + yy) / 2 - xx * yy);
  } else if (lattice.has_bubbles) {
    const std::size_t at = quadratic_functions(x, y, w, values);
    const double www = ww * w;
    const std::array<double, 8> bubbles = {
        x * (1 - yy) * www, y * (1 - xx) * www,     xx * (1 - yy) * www, yy * (1 - xx) * www, xx * ww, yy * ww,
        xx * yy * ww,       w * (xx + yy - xx * yy)};
    std::copy_n(bubbles.begin(), lattice.nodes.size() - at, values.begin() + static_cast<std::ptrdiff_t>(at));
  } else {
    lagrange_functions(lattice.order[0], x, y, height, values);
  }
}

std::vector<double> pyramid_matrix(const CurvedLattice& lattice) {
  const std::size_t n = lattice.nodes.size();
  std::vector<double> values(n);
  std::vector<long double> all;
  for (std::size_t node = 0; node < n; ++node) {
    const glm::dvec3 p = lattice.place(node);
    pyramid_functions(lattice, {p.x, p.y, p.z}, values);
    all.insert(all.end(), values.begin(), values.end());
  }
  return inverse_matrix(std::move(all), n);
}

}  // namespace tessera::cells
