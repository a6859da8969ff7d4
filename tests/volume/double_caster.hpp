// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <limits>
#include <numbers>
#include <vector>

#include "scene/camera.hpp"
#include "scene/grid.hpp"
#include "scene/optical_model.hpp"
#include "scene/transfer_function.hpp"

namespace tessera::tests {

/// RGBA and planar depth of first light along one ray, in double precision: each voxel separately, with its segment of
/// the ray cut where the field crosses a knot (dense samples and bisection), and Simpson's rule in between. Slow;
/// shares no code with volume/.
struct DoubleCaster {
  scene::GridGeometry geometry;
  std::function<double(std::int64_t, std::int64_t, std::int64_t)> sample;  ///< values; NaN means blank
  scene::TransferFunction function;
  scene::Emission emission = scene::Emission::absorption;

  struct Pixel {
    double rgba[4] = {0, 0, 0, 0};
    double depth = std::numeric_limits<double>::infinity();
  };

  Pixel cast(const scene::Camera& camera, scene::ImageSize size, double px, double py) const {
    const scene::ViewBasis basis = scene::view_basis(camera);
    const bool perspective = camera.projection == scene::ProjectionKind::perspective;
    const double half = perspective ? std::tan(camera.view_angle * std::numbers::pi / 360) : camera.parallel_scale;
    const double u = (px - size.width / 2.0) * 2 * half / size.height,
                 v = -(py - size.height / 2.0) * 2 * half / size.height;
    glm::dvec3 origin = camera.position, direction = basis.forward;
    if (perspective)
      direction += basis.right * u + basis.up * v;
    else
      origin += basis.right * u + basis.up * v;
    const double length_per_depth = glm::length(direction);
    const glm::dvec3 o = scene::index_of_world(geometry, origin);
    const glm::dvec3 d = scene::world_to_local(geometry) * direction;
    const scene::GridIndex voxels = geometry.voxels();
    // Depths of all lattice planes.
    double near = 0, far = 1e300;
    if (camera.clipping_range)
      near = std::max(near, camera.clipping_range->near_distance), far = camera.clipping_range->far_distance;
    const glm::dvec3 local = scene::world_to_local(geometry) * (origin - geometry.origin);
    std::vector<double> cuts;
    for (int a = 0; a < 3; ++a) {
      const auto axis = static_cast<std::size_t>(a);
      const double first = geometry.lattice(axis, 0), last = geometry.lattice(axis, voxels[axis]);
      if (d[a] == 0) {
        if (local[a] < first || local[a] > last) return {};
        continue;
      }
      const double t0 = (first - local[a]) / d[a], t1 = (last - local[a]) / d[a];
      near = std::max(near, std::min(t0, t1)), far = std::min(far, std::max(t0, t1));
      for (std::int64_t k = 0; k <= voxels[axis]; ++k) cuts.push_back((geometry.lattice(axis, k) - local[a]) / d[a]);
    }
    (void)o;
    if (!(near < far)) return {};
    cuts.push_back(near), cuts.push_back(far);
    std::sort(cuts.begin(), cuts.end());
    Pixel pixel;
    double optical_depth = 0;
    for (std::size_t n = 1; n < cuts.size(); ++n) {
      const double from = std::max(cuts[n - 1], near), to = std::min(cuts[n], far);
      if (!(from < to)) continue;
      const glm::dvec3 middle = scene::index_of_world(geometry, origin + direction * (0.5 * (from + to)));
      std::array<std::int64_t, 3> voxel;
      glm::dvec3 low, high;
      for (int a = 0; a < 3; ++a) {
        const auto axis = static_cast<std::size_t>(a);
        voxel[axis] = std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(middle[a])), 0, voxels[axis] - 1);
        low[a] = geometry.lattice(axis, voxel[axis]), high[a] = geometry.lattice(axis, voxel[axis] + 1);
      }
      double corner[8];
      bool blank = false;
      for (int c = 0; c < 8; ++c) {
        corner[c] = geometry.association == scene::Association::cell
                        ? sample(voxel[0], voxel[1], voxel[2])
                        : sample(voxel[0] + (c & 1), voxel[1] + (c >> 1 & 1), voxel[2] + (c >> 2));
        blank = blank || !std::isfinite(corner[c]);
      }
      if (blank) continue;
      const auto field = [&](double t) {
        const glm::dvec3 w = (local + d * t - low) / (high - low);
        double s = 0;
        for (int c = 0; c < 8; ++c)
          s += corner[c] * (c & 1 ? w.x : 1 - w.x) * (c >> 1 & 1 ? w.y : 1 - w.y) * (c >> 2 ? w.z : 1 - w.z);
        return geometry.association == scene::Association::cell ? corner[0] : s;
      };
      stretch(field, from, to, length_per_depth, optical_depth, pixel);
      if (optical_depth > 40) break;
    }
    pixel.rgba[3] = -std::expm1(-optical_depth);
    return pixel;
  }

 private:
  template <class Field>
  void stretch(const Field& field, double from, double to, double length_per_depth, double& optical_depth,
               Pixel& pixel) const {
    std::vector<double> cuts{from};
    // Extrema are found by ternary search in parts that are not monotone. Between them, a knot is crossed at most once.
    constexpr int parts = 32;
    std::vector<double> marks{from};
    for (int n = 0; n < parts; ++n) {
      const double a = marks.back(), b = n + 1 == parts ? to : from + (to - from) * (n + 1) / parts;
      for (const double sign : {1.0, -1.0}) {
        double low = a, high = b;
        for (int i = 0; i < 80; ++i) {
          const double l = low + (high - low) / 3, h = high - (high - low) / 3;
          (sign * field(l) < sign * field(h) ? low : high) = sign * field(l) < sign * field(h) ? l : h;
        }
        const double m = 0.5 * (low + high);
        if (m > a + 1e-6 * (b - a) && m < b - 1e-6 * (b - a)) marks.push_back(m);
      }
      marks.push_back(b);
    }
    std::sort(marks.begin(), marks.end());
    for (std::size_t n = 1; n < marks.size(); ++n) {
      const double a = marks[n - 1], b = marks[n];
      const double sa = field(a), sb = field(b);
      std::vector<double> found;
      for (const scene::Knot& knot : function.knots()) {
        if ((sa < knot.value) == (sb < knot.value)) continue;
        double low = a, high = b;
        for (int i = 0; i < 60; ++i) {
          const double m = 0.5 * (low + high);
          ((field(m) < knot.value) == (sa < knot.value) ? low : high) = m;
        }
        found.push_back(0.5 * (low + high));
      }
      std::sort(found.begin(), found.end());
      cuts.insert(cuts.end(), found.begin(), found.end());
      cuts.push_back(b);
    }
    const bool independent = emission == scene::Emission::independent;
    for (std::size_t n = 1; n < cuts.size(); ++n) {
      if (!(cuts[n] > cuts[n - 1])) continue;
      constexpr int steps = 12;
      const double h = (cuts[n] - cuts[n - 1]) * length_per_depth / steps;
      // Just inside the cuts, so that the correct side of a step is used.
      const double eps = 1e-9 * (cuts[n] - cuts[n - 1]);
      const double step = (cuts[n] - cuts[n - 1] - 2 * eps) / steps;
      for (int i = 0; i < steps; ++i) {
        const double a = cuts[n - 1] + eps + i * step;
        const scene::Knot k[3] = {function.evaluate(field(a)), function.evaluate(field(a + 0.5 * step)),
                                  function.evaluate(field(a + step))};
        const double whole = h / 6 * (k[0].extinction + 4 * k[1].extinction + k[2].extinction);
        const double first_half = h / 24 * (5 * k[0].extinction + 8 * k[1].extinction - k[2].extinction);
        const double through[3] = {1, std::exp(-first_half), std::exp(-whole)};
        for (int c = 0; c < 3; ++c) {
          const auto term = [&](int j) { return (independent ? 1.0 : k[j].extinction) * k[j].color[c] * through[j]; };
          pixel.rgba[c] += std::exp(-optical_depth) * h / 6 * (term(0) + 4 * term(1) + term(2));
        }
        if (whole > 0 && std::isinf(pixel.depth)) pixel.depth = cuts[n - 1];
        optical_depth += whole;
      }
    }
  }
};

}  // namespace tessera::tests
