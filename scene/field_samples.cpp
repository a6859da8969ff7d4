// SPDX-License-Identifier: BSD-3-Clause
#include "scene/field_samples.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <limits>
#include <utility>

namespace tessera::scene {
namespace {

constexpr std::uint64_t most_examined_tets = 1 << 16;
constexpr double points_in_all = 1 << 14;
constexpr int most_points_a_tet = 4096;
constexpr std::int64_t points_along_axis = 40;

/// Returns element j of a sequence that fills [0, 1) evenly if `step` is an irrational number that fractions
/// approximate badly.
double uniform(std::uint64_t j, double step) {
  const double u = 0.5 + step * static_cast<double>(j & 0xffffffff);
  return u - std::floor(u);
}

/// Returns the barycentric coordinates of point j of a sequence that fills a tet evenly. Source: Roberts, "The
/// unreasonable effectiveness of quasirandom sequences", 2018, for the R3 sequence; differences of sorted uniform
/// numbers are uniform barycentric coordinates (Devroye, "Non-Uniform Random Variate Generation", 1986, V.2.1).
std::array<double, 4> barycentric(std::uint64_t j) {
  std::array<double, 3> u{uniform(j, 0.8191725133961645), uniform(j, 0.6710436067037893),
                          uniform(j, 0.5497004779019703)};
  std::ranges::sort(u);
  return {u[0], u[1] - u[0], u[2] - u[1], 1 - u[2]};
}

float between(double x) { return static_cast<float>(std::clamp(x, 0.0, 1.0)); }

}  // namespace

FieldSamples sample_mesh(const TetMeshView& part, std::span<const std::uint64_t> global_tet, const MeshFacts& whole) {
  FieldSamples out;
  if (whole.box.empty()) return out;
  const glm::dvec3 extent = whole.box.high - whole.box.low;
  out.longest = std::max({extent.x, extent.y, extent.z});
  if (!(out.longest > 0) || !std::isfinite(out.longest)) return {};
  out.sides = extent / out.longest;
  const double face =
      std::max({out.sides.x * out.sides.y, out.sides.y * out.sides.z, out.sides.z * out.sides.x, 1e-300});
  // The volume must be at least that of all tets. volume_sum() rounds the volume of each tet down, and in a box whose
  // length is 1e12 times its width, it rounds to zero. If the volume were too small, every tet would have the maximum
  // number of points.
  const double volume = (whole.mean_thickness + std::numeric_limits<double>::denorm_min()) / out.longest * face +
                        static_cast<double>(whole.tets) * 0x1p-100;
  const std::uint64_t stride = std::max<std::uint64_t>(1, (whole.tets + most_examined_tets - 1) / most_examined_tets);
  for (std::size_t t = 0; t < part.tets.size(); ++t) {
    const std::uint64_t number = global_tet.empty() ? t : global_tet[t];
    if (number % stride != 0) continue;
    std::array<glm::dvec3, 4> corner{};
    std::array<double, 4> scalar{};
    for (std::size_t c = 0; c < 4; ++c) {
      corner[c] = (part.positions[part.tets[t][c]] - whole.box.low) / out.longest;
      scalar[c] = part.association == Association::point ? part.scalars[part.tets[t][c]] : part.scalars[t];
    }
    const double tet_volume =
        std::abs(glm::dot(corner[1] - corner[0], glm::cross(corner[2] - corner[0], corner[3] - corner[0]))) / 6;
    if (!(tet_volume > 0)) continue;
    const int points =
        static_cast<int>(std::clamp(std::ceil(tet_volume / volume * points_in_all), 1.0, double{most_points_a_tet}));
    for (int j = 0; j < points; ++j) {
      // Each tet uses another part of the sequence. Otherwise all samples of a regular mesh would be at the same place
      // in their cells.
      const std::array<double, 4> share = barycentric(number * 127 + static_cast<std::uint64_t>(j));
      glm::dvec3 at(0);
      double value = 0;
      for (std::size_t c = 0; c < 4; ++c) at += share[c] * corner[c], value += share[c] * scalar[c];
      if (part.association == Association::cell) value = scalar[0];
      if (!std::isfinite(value)) continue;
      FieldSample sample{value, static_cast<float>(tet_volume * static_cast<double>(stride) / points), {}, number};
      for (std::size_t a = 0; a < 3; ++a) {
        const auto axis = static_cast<int>(a);
        sample.at[a] = out.sides[axis] > 0 ? between(at[axis] / out.sides[axis]) : 0.5F;
      }
      out.samples.push_back(sample);
    }
  }
  return out;
}

namespace {

/// Parts of equal length of one axis of a grid, in index space.
struct AxisParts {
  std::int64_t parts = 1;
  double length = 0;       ///< length of each part, in lattice steps
  std::int64_t cells = 1;  ///< number of cells that contain places

  AxisParts(const GridGeometry& geometry, std::size_t axis) {
    const std::int64_t steps = geometry.points[axis] - 1;
    if (steps <= 0) return;
    parts = std::max(points_along_axis, steps / std::max<std::int64_t>(1, steps / points_along_axis));
    length = static_cast<double>(steps) / static_cast<double>(parts);
    cells = steps;
  }
  /// Returns the cell, and the position in this cell, at a fraction of part `i`.
  [[nodiscard]] std::pair<std::int64_t, double> at(std::int64_t i, double fraction) const {
    const double x = (static_cast<double>(i) + fraction) * length;
    const std::int64_t cell = std::clamp<std::int64_t>(static_cast<std::int64_t>(x), 0, cells - 1);
    return {cell, std::clamp(x - static_cast<double>(cell), 0.0, 1.0)};
  }
};

/// The rows of samples around places that have the same y and z. The field at such places is interpolated from these
/// rows.
class SampleRows {
 public:
  explicit SampleRows(const SampleSource& source)
      : source_(source),
        count_(source.geometry().samples()),
        cells_(source.geometry().association == Association::cell),
        values_(static_cast<std::size_t>(4 * count_[0])) {}

  /// Reads the rows around cell (j, k), for places at the fractions y and z of the cell.
  void read(std::int64_t j, std::int64_t k, double y, double z) {
    const std::int64_t high_j = cells_ ? j : std::min(j + 1, count_[1] - 1);
    const std::int64_t high_k = cells_ ? k : std::min(k + 1, count_[2] - 1);
    rows_ = high_j - j + 1;
    slices_ = high_k - k + 1;
    y_ = y;
    z_ = z;
    source_.read(SampleBox{{0, j, k}, {count_[0], high_j + 1, high_k + 1}},
                 std::span<double>(values_).first(static_cast<std::size_t>(count_[0] * rows_ * slices_)));
  }
  /// Returns the stored value, without scale and shift, at the fraction x of cell i. It is NaN if a sample around the
  /// place is NaN.
  [[nodiscard]] double at(std::int64_t i, double x) const {
    if (cells_) return value(i, 0, 0);
    const std::int64_t next = std::min(i + 1, count_[0] - 1);
    const auto along_x = [&](std::int64_t j, std::int64_t k) {
      return std::lerp(value(i, j, k), value(next, j, k), x);
    };
    const auto along_y = [&](std::int64_t k) { return std::lerp(along_x(0, k), along_x(rows_ - 1, k), y_); };
    return std::lerp(along_y(0), along_y(slices_ - 1), z_);
  }
  [[nodiscard]] double nearest(std::int64_t i, double x) const {
    if (cells_) return value(i, 0, 0);
    return value(std::min(i + (x < 0.5 ? 0 : 1), count_[0] - 1), y_ < 0.5 ? 0 : rows_ - 1, z_ < 0.5 ? 0 : slices_ - 1);
  }

 private:
  [[nodiscard]] double value(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return values_[static_cast<std::size_t>(i + count_[0] * (j + rows_ * k))];
  }

  const SampleSource& source_;
  GridIndex count_;
  bool cells_;
  std::vector<double> values_;
  std::int64_t rows_ = 1, slices_ = 1;
  double y_ = 0, z_ = 0;
};

}  // namespace

FieldSamples sample_grid(const SampleSource& source) {
  const Grid& grid = source.grid();
  const GridGeometry& geometry = grid.geometry;
  FieldSamples out;
  glm::dvec3 extent(0);
  for (std::size_t a = 0; a < 3; ++a)
    extent[static_cast<int>(a)] = geometry.lattice(a, geometry.points[a] - 1) - geometry.lattice(a, 0);
  out.longest = std::max({extent.x, extent.y, extent.z});
  if (!(out.longest > 0) || !std::isfinite(out.longest)) return {};
  out.sides = extent / out.longest;
  const std::array<AxisParts, 3> axes{AxisParts(geometry, 0), AxisParts(geometry, 1), AxisParts(geometry, 2)};
  // Returns the local coordinate of a place given by a cell and a fraction of the cell.
  const auto place = [&](std::size_t axis, const std::pair<std::int64_t, double>& at) {
    const std::int64_t next = std::min(at.first + 1, geometry.points[axis] - 1);
    return std::lerp(geometry.lattice(axis, at.first), geometry.lattice(axis, next), at.second);
  };
  const auto length = [&](std::size_t axis, std::int64_t part) {
    if (axes[axis].length == 0) return 0.0;
    return std::max(place(axis, axes[axis].at(part, 1)) - place(axis, axes[axis].at(part, 0)), 0.0) / out.longest;
  };
  const auto along = [&](std::size_t axis, const std::pair<std::int64_t, double>& at) {
    const double side = extent[static_cast<int>(axis)];
    return side > 0 ? between((place(axis, at) - geometry.lattice(axis, 0)) / side) : 0.5F;
  };
  SampleRows rows(source);
  for (std::int64_t c = 0; c < axes[2].parts; ++c)
    for (std::int64_t b = 0; b < axes[1].parts; ++b) {
      const auto number = static_cast<std::uint64_t>(b + axes[1].parts * c);
      const auto y = axes[1].at(b, uniform(number, 0.7548776662466927)),
                 z = axes[2].at(c, uniform(number, 0.5698402909980532));
      rows.read(y.first, z.first, y.second, z.second);
      const double face = length(1, b) * length(2, c);
      for (std::int64_t a = 0; a < axes[0].parts; ++a) {
        const auto x = axes[0].at(a, uniform(number + static_cast<std::uint64_t>(a) * 127, 0.6180339887498949));
        const double stored = rows.at(x.first, x.second);
        if (!std::isfinite(stored)) continue;
        out.samples.push_back(
            {grid.value(stored), static_cast<float>(length(0, a) * face), {along(0, x), along(1, y), along(2, z)}, 0});
        out.stored.push_back(grid.value(rows.nearest(x.first, x.second)));
      }
    }
  return out;
}

}  // namespace tessera::scene
