#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

#include "projection/pixel_space.hpp"
#include "projection/prepared_mesh.hpp"
#include "projection/segment_windows.hpp"
#include "scene/lattice.hpp"
#include "scene/surface_set.hpp"

/// Where rays cross iso-surfaces. A crossing travels among the ray segments as one of length zero at its depth, whose
/// scalars say which crossing it is and how it is lit: stores, sorting and the wire know nothing of it. The cell's own
/// segment is cut there, so that in depth order the crossing lies between its parts.
namespace tessera::projection {

/// Which crossing (scene::SurfaceSet), and the cosine of the angle between ray and normal.
struct Crossing {
  std::uint32_t number;
  float cosine;
};

/// In double precision the front scalar is no number, and its lower bits are the crossing.
inline double marked(const Crossing& crossing) {
  constexpr std::uint64_t no_number = 0x7ff8ull << 48;
  return std::bit_cast<double>(no_number | static_cast<std::uint64_t>(crossing.number) << 32 |
                               std::bit_cast<std::uint32_t>(crossing.cosine));
}
inline bool is_crossing(double scalar_front) { return std::isnan(scalar_front); }
inline Crossing crossing_of(double scalar_front) {
  const auto bits = std::bit_cast<std::uint64_t>(scalar_front);
  return {static_cast<std::uint32_t>(bits >> 32 & 0xffff), std::bit_cast<float>(static_cast<std::uint32_t>(bits))};
}

/// On the lattice the front scalar lies beyond all of the field's, four times as far out as the lattice reaches, so
/// that crossings at one depth are in the order of their numbers; the back scalar is the cosine.
constexpr float first_mark = 0x1p32f, mark_step = 0x1p9f;
inline LatticeSegment marked(std::int32_t depth, const Crossing& crossing) {
  return {depth, depth, first_mark + mark_step * static_cast<float>(crossing.number), crossing.cosine};
}
inline bool is_crossing(float scalar_front) { return scalar_front >= first_mark; }
inline Crossing crossing_of(float scalar_front, float scalar_back) {
  return {static_cast<std::uint32_t>((std::min(scalar_front, 2 * first_mark) - first_mark) / mark_step), scalar_back};
}

/// The iso-surfaces of a frame, as rasterizers meet them.
struct IsoView {
  const scene::SurfaceSet* surfaces;
  const PixelSpace* space;
  const scene::Lattice* lattice = nullptr;  ///< to whose steps depths will be rounded; null: to none

  [[nodiscard]] std::span<const double> values() const { return surfaces->iso_values(); }

  /// The number of a crossing at `depth` of a segment from `front` to `back`.
  [[nodiscard]] std::uint32_t number(std::size_t iso, bool rises, double depth, double front, double back) const {
    const auto place = lattice != nullptr
                           ? scene::SurfaceSet::place_of(lattice->depth_step(depth), lattice->depth_step(front),
                                                         lattice->depth_step(back))
                           : scene::SurfaceSet::place_of(depth, front, back);
    return surfaces->crossing(iso, rises, place);
  }

  /// The range [first, last) of surfaces that a cell with these scalars has: those above `low`, up to `high`.
  struct Range {
    std::size_t first, last;
  };
  [[nodiscard]] Range within(double low, double high) const {
    const auto all = values();
    const auto first = std::upper_bound(all.begin(), all.end(), low), last = std::upper_bound(first, all.end(), high);
    return {static_cast<std::size_t>(first - all.begin()), static_cast<std::size_t>(last - all.begin())};
  }
};

/// The field's gradient in a tet, of any length: zero where the field is constant; in a flat tet its normal.
glm::dvec3 gradient_direction(const PreparedMesh& mesh, std::size_t tet);

/// Cosine of the angle between a ray of that direction and a normal, neither of unit length; 1 where there is no
/// normal.
float cosine_between(const glm::dvec3& ray, const glm::dvec3& normal);

}  // namespace tessera::projection
