#include "scene/field_samples.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <utility>

namespace tessera::scene {
namespace {

constexpr std::uint64_t tets_looked_at = 1 << 16;
constexpr double points_in_all = 1 << 14;
constexpr int most_points_a_tet = 4096;
constexpr std::int64_t points_along_axis = 40;

/// Barycentric coordinates of point j of a sequence that fills a tet evenly. Source: Roberts, "The unreasonable
/// effectiveness of quasirandom sequences", 2018, for the R3 sequence; differences of sorted uniform numbers are
/// uniform barycentric coordinates (Devroye, "Non-Uniform Random Variate Generation", 1986, V.2.1).
std::array<double, 4> barycentric(std::uint64_t j) {
  const auto uniform = [&](double step) {
    const double u = 0.5 + step * static_cast<double>(j & 0xffffffff);
    return u - std::floor(u);
  };
  std::array<double, 3> u{uniform(0.8191725133961645), uniform(0.6710436067037893), uniform(0.5497004779019703)};
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
  const double volume = whole.mean_thickness / out.longest * face;  // of all tets
  const std::uint64_t stride = std::max<std::uint64_t>(1, (whole.tets + tets_looked_at - 1) / tets_looked_at);
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
    const int points = static_cast<int>(
        std::clamp(std::ceil(tet_volume / std::max(volume, 1e-300) * points_in_all), 1.0, double{most_points_a_tet}));
    for (int j = 0; j < points; ++j) {
      // Another stretch of the sequence in every tet; else all samples of a regular mesh lay at one place of its cells.
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

FieldSamples sample_grid(const SampleSource& source) {
  const Grid& grid = source.grid();
  const GridGeometry& geometry = grid.geometry;
  const GridIndex samples = geometry.samples();
  FieldSamples out;
  std::array<std::vector<std::int64_t>, 3> chosen;
  std::array<std::vector<double>, 3> place, width;  // along each axis: where, and how much of the axis it stands for
  glm::dvec3 extent(0);
  for (std::size_t a = 0; a < 3; ++a) {
    const std::int64_t stride = std::max<std::int64_t>(1, samples[a] / points_along_axis);
    const std::int64_t last = geometry.points[a] - 1;
    extent[static_cast<int>(a)] = geometry.lattice(a, last) - geometry.lattice(a, 0);
    const bool cells = geometry.association == Association::cell;
    for (std::int64_t i = stride / 2; i < samples[a]; i += stride) {
      chosen[a].push_back(i);
      const double low = geometry.lattice(a, std::max<std::int64_t>(i - stride / 2, 0));
      const double high = geometry.lattice(a, std::min(i - stride / 2 + stride, last));
      place[a].push_back(cells ? (geometry.lattice(a, i) + geometry.lattice(a, i + 1)) / 2 : geometry.lattice(a, i));
      width[a].push_back(std::max(high - low, 0.0));
    }
  }
  out.longest = std::max({extent.x, extent.y, extent.z});
  if (!(out.longest > 0) || !std::isfinite(out.longest)) return {};
  out.sides = extent / out.longest;
  std::vector<double> row(static_cast<std::size_t>(samples[0]));
  for (std::size_t c = 0; c < chosen[2].size(); ++c)
    for (std::size_t b = 0; b < chosen[1].size(); ++b) {
      const std::int64_t j = chosen[1][b], k = chosen[2][c];
      source.read(SampleBox{{0, j, k}, {samples[0], j + 1, k + 1}}, std::span<double>(row));
      for (std::size_t a = 0; a < chosen[0].size(); ++a) {
        const double stored = row[static_cast<std::size_t>(chosen[0][a])];
        if (!std::isfinite(stored)) continue;
        const double volume = width[0][a] / out.longest * (width[1][b] / out.longest) * (width[2][c] / out.longest);
        const auto along = [&](std::size_t axis, std::size_t at) {
          return between((place[axis][at] - geometry.lattice(axis, 0)) / extent[static_cast<int>(axis)]);
        };
        out.samples.push_back(
            {grid.value(stored), static_cast<float>(volume), {along(0, a), along(1, b), along(2, c)}, 0});
      }
    }
  return out;
}

}  // namespace tessera::scene
