#include "projection/lattice_surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace tessera::projection {

namespace {

/// The surfaces that a cell with scalars between these steps may have. Rounding may move a scalar over a value: a
/// float's last place (64 steps at most), the value's own, and a gradient's over the square.
IsoView::Range range_between(std::span<const float> values, std::int32_t low, std::int32_t high) {
  constexpr float margin = 256;
  const float below = static_cast<float>(low) - margin, above = static_cast<float>(high) + margin;
  std::size_t first = 0;
  while (first < values.size() && values[first] < below) ++first;
  std::size_t last = first;
  while (last < values.size() && values[last] <= above) ++last;
  return {first, last};
}

}  // namespace

std::uint32_t LatticeSurfaces::find(const LatticeView& view, std::span<const TileEntry> cells, std::uint32_t without) {
  const IsoView& iso = *view.projected.iso;
  std::uint32_t crossed = 0;
  std::fill_n(limits_.low, most_cells, std::numeric_limits<float>::infinity());
  std::fill_n(limits_.high, most_cells, -std::numeric_limits<float>::infinity());
  for (std::size_t t = 0; t < cells.size(); ++t) {
    if ((without >> t & 1) != 0) continue;
    // Of the lattice's own vertices, which set-up has just read.
    const scene::Tet& corners = view.projected.mesh->tets()[cells[t].tet];
    const auto scalar = [&](std::size_t i) { return view.vertices[corners[i]].scalar; };
    const auto [low, high] = std::minmax({scalar(0), scalar(1), scalar(2), scalar(3)});
    ranges_[t] = range_between(iso.surfaces->on_lattice(), low, high);
    if (ranges_[t].first == ranges_[t].last) continue;
    crossed |= 1u << t;
    limits_.low[t] = iso.surfaces->on_lattice()[ranges_[t].first];
    limits_.high[t] = iso.surfaces->on_lattice()[ranges_[t].last - 1];
    normals_[t] = unit(gradient_direction(*view.projected.mesh, cells[t].tet));
    cosines_[t] = 1;
    if (!view.perspective && normals_[t] != glm::dvec3(0))
      cosines_[t] = std::min(std::abs(glm::dot(iso.space->direction(0, 0), normals_[t])), 1.0);
  }
  return crossed;
}

void LatticeSurfaces::cross(const LatticeView& view, std::span<const std::uint32_t> segments, int x0, int y0,
                            SegmentStream& out) {
  const IsoView& iso = *view.projected.iso;
  const glm::dvec3 corner = iso.space->direction(x0 + 0.5, y0 + 0.5);
  const glm::dvec3 right = iso.space->direction(x0 + 1.5, y0 + 0.5) - corner;
  const glm::dvec3 down = iso.space->direction(x0 + 0.5, y0 + 1.5) - corner;
  for (const std::uint32_t i : segments) {
    const std::int32_t hit = out.hit[i];
    const auto t = static_cast<std::size_t>(hit & 15);
    const glm::dvec3& normal = normals_[t];
    double cosine = cosines_[t];
    if (view.perspective && normal != glm::dvec3(0)) {
      const glm::dvec3 ray =
          corner + right * static_cast<double>(hit >> 4 & 31) + down * static_cast<double>(hit >> 20 & 31);
      cosine = std::min(std::abs(glm::dot(ray, normal)) / std::sqrt(glm::dot(ray, ray)), 1.0);
    }
    cross_segment(iso, i, ranges_[t], static_cast<float>(cosine), out);
  }
}

void LatticeSurfaces::cross_segment(const IsoView& iso, std::size_t segment, const IsoView::Range& range, float cosine,
                                    SegmentStream& out) {
  const std::span<const float> on_lattice = iso.surfaces->on_lattice();
  const std::int32_t front = out.front[segment], back = out.back[segment];
  const float from = out.scalar_front[segment], to = out.scalar_back[segment];
  const bool rises = from < to;
  const double length = static_cast<double>(back) - front, slope = length / (static_cast<double>(to) - from);
  // The part that is not cut yet: at first the segment itself, then what is behind a crossing.
  std::size_t rest = segment;
  const auto add = [&](std::int32_t f, std::int32_t b, float at_front, float at_back) {
    const std::size_t at = out.size++;
    out.front[at] = f, out.back[at] = b;
    out.scalar_front[at] = at_front, out.scalar_back[at] = at_back;
    out.pixel[at] = out.pixel[segment];
    return at;
  };
  for (std::size_t k = 0; k < range.last - range.first; ++k) {
    const std::size_t surface = rises ? range.first + k : range.last - 1 - k;
    const float value = on_lattice[surface];
    if ((from >= value) == (to >= value)) continue;
    if (out.size + 2 > out.front.size() - SegmentStream::padding) out.reserve(2 * out.size + 2);
    const double along = std::clamp((static_cast<double>(value) - from) * slope, 0.0, length);
    const auto at = LatticePlace::of(static_cast<std::int32_t>(std::nearbyint(front + along)), front, back);
    const float mark = LatticeMark::of({iso.surfaces->crossing(surface, rises, at.place), cosine});
    if (at.place == scene::SurfaceSet::Place::back_end || front == back) {
      add(at.depth, at.depth, mark, value);
    } else if (at.depth == out.front[rest]) {
      // A second one there: the first stands alone.
      if (is_crossing(out.scalar_front[rest])) add(at.depth, at.depth, out.scalar_front[rest], value);
      out.scalar_front[rest] = mark;
    } else {
      const std::size_t behind = add(at.depth, back, mark, to);
      out.back[rest] = at.depth, out.scalar_back[rest] = value;
      rest = behind;
    }
  }
}

}  // namespace tessera::projection
