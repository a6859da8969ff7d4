// SPDX-License-Identifier: BSD-3-Clause
#include "projection/steps.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <type_traits>

#include "scene/frame_watch.hpp"

namespace tessera::projection {
namespace {

static_assert(PreparedMesh::block_tets == 64);  // a word of bits
/// Upper bound of the change of a pixel that all crossings of a ray together may cause.
constexpr double tolerance = 5e-6;
/// In float lanes and under perspective, the position of a crossing has this error, relative to the segment's length.
constexpr double relative_error = 0x1p-22;

constexpr auto value_above = [](double value, const Step& step) { return value < step.value; };

/// The number of steps at or below `value`.
std::size_t steps_passed(std::span<const Step> steps, double value) {
  return static_cast<std::size_t>(std::upper_bound(steps.begin(), steps.end(), value, value_above) - steps.begin());
}

/// Determines whether a cell must be cut at steps.
class Rule {
 public:
  Rule(const PreparedMesh& prepared, std::span<const Step> steps, double longest_ray, const scene::Lattice* lattice,
       std::span<const scene::MagnifiedRange> magnified)
      : prepared_(prepared),
        mesh_(prepared.mesh()),
        steps_(steps),
        longest_ray_(longest_ray),
        lattice_(lattice),
        magnified_(magnified) {
    double most = 0;
    if (lattice == nullptr)
      for (const Step& step : steps) most = std::max(most, std::abs(step.value));
    most_error_ = lattice != nullptr ? (planes_error + scene::Lattice::limit * float_error) * lattice->scalar_unit
                                     : 2 * most * double_error;
  }

  /// Returns the largest number of pieces of the cell in a pixel; 0 if the lattice or double precision is accurate
  /// enough without cutting. `passed` is the number of steps below the previous cell, which is mostly the same for the
  /// next cell of the file. It may have any value in the first call.
  [[nodiscard]] std::size_t pieces(std::size_t tet, std::size_t& passed) const {
    const auto [low, high] = prepared_.scalar_bounds(tet);
    if (reach_magnified(low, high)) return most_pieces(low, high);
    if (!passed_alone(passed, low - most_error_)) passed = steps_passed(steps_, low - most_error_);
    for (std::size_t i = passed; i < steps_.size(); ++i) {
      if (steps_[i].value > high + most_error_) break;
      if (steps_[i].kind == Step::Kind::range_end) continue;
      if (steps_[i].kind == Step::Kind::surface) {
        if (lattice_ == nullptr ? low < steps_[i].value && steps_[i].value <= high : passes_corner(steps_[i], tet))
          return most_pieces(low, high);
        continue;
      }
      if (level(low, high) ? rounded_across(steps_[i], low) : inexact(steps_[i], low, high, tet))
        return most_pieces(low, high);
    }
    return 0;
  }

  /// Whether pieces() is 0 for all cells of a block.
  [[nodiscard]] bool spares(std::size_t block) const {
    const auto [low, high] = prepared_.block_scalar_bounds(block);
    if (reach_magnified(low, high)) return false;
    const std::size_t next = steps_passed(steps_, low - most_error_);
    return next == steps_.size() || steps_[next].value > high + most_error_;
  }

 private:
  /// Whether exactly the first `count` steps are at or below `value`.
  [[nodiscard]] bool passed_alone(std::size_t count, double value) const {
    return (count == 0 || steps_[count - 1].value <= value) && (count == steps_.size() || steps_[count].value > value);
  }

  /// Returns the largest number of pieces of a cell with these scalars, including crossings of surfaces.
  [[nodiscard]] std::size_t most_pieces(double low, double high) const {
    return 1 + 2 * (steps_passed(steps_, high) - steps_passed(steps_, low));
  }

  // planes_error: in lattice steps; a corner's scalar and two gradients, each over 16 pixels, are rounded to integer
  // steps. float_error: the last place of a float. usual_part: two standard deviations of either error are less than
  // half of its bound.
  static constexpr double planes_error = 17, float_error = 0x1p-24, usual_part = 0.5, double_error = 0x1p-51;

  /// If the scalars of a face differ by more than this number of errors, an error moves the line in which a surface
  /// intersects the face by less than 1/1024 pixel, in a cell of a hundred pixels.
  static constexpr double most_slope = 1e5;

  static bool level(double low, double high) { return low == high; }

  /// Whether a cell's scalars, with their errors, reach a magnified range. If the cell has a single scalar, rounding
  /// moves the scalar at most to the end of a range, so its error is not added.
  [[nodiscard]] bool reach_magnified(double low, double high) const {
    const double error = level(low, high) ? 0 : most_error_;
    return std::ranges::any_of(magnified_, [&](const scene::MagnifiedRange& range) {
      return low - error < range.high && high + error >= range.low;
    });
  }

  /// Whether rounding can move a scalar across the step. A face with a single scalar keeps the scalar, so only the
  /// scalar's own rounding can change its side.
  [[nodiscard]] bool rounded_across(const Step& step, double scalar) const {
    if (lattice_ == nullptr) return false;
    const auto on_lanes = [&](double v) { return static_cast<float>(lattice_->scalar_step(v)); };
    return (scalar >= step.value) != (on_lanes(scalar) >= on_lanes(step.value));
  }

  /// Returns the error that a scalar near the step has on the lattice.
  [[nodiscard]] double lattice_error(const Step& step) const {
    return planes_error * lattice_->scalar_unit + std::abs(step.value - lattice_->scalar_origin) * float_error;
  }

  /// Whether a surface almost coincides with one of the cell's faces on the lattice, or passes through a vertex. All
  /// cells at this face or vertex must agree on the surface's position, and on whether the ray's crossing is in front
  /// of a face or behind it; this requires double precision.
  [[nodiscard]] bool passes_corner(const Step& step, std::size_t tet) const {
    const scene::Tet& corners = prepared_.tets()[tet];
    const double error = lattice_error(step);
    std::array<double, 4> s;
    for (std::size_t i = 0; i < 4; ++i) s[i] = mesh_.scalars[corners[i]];
    for (const double scalar : s)
      if (std::abs(scalar - step.value) <= error) return true;
    // A face has three of the cell's corners, so its scalars include the lowest or the highest scalar of the cell.
    const auto order = [&](std::size_t i, std::size_t j) {
      const double low = std::min(s[i], s[j]), high = std::max(s[i], s[j]);
      s[i] = low, s[j] = high;
    };
    order(0, 1), order(2, 3), order(0, 2), order(1, 3), order(1, 2);
    const auto coincides = [&](double low, double high) {
      return high - low <= most_slope * error && step.value >= low - error && step.value <= high + error;
    };
    return coincides(s[0], s[2]) || coincides(s[1], s[3]) || coincides(s[0], s[3]);
  }

  [[nodiscard]] bool inexact(const Step& step, double low, double high, std::size_t tet) const {
    const scene::Tet& corners = prepared_.tets()[tet];
    const double error = lattice_ != nullptr
                             ? lattice_error(step)
                             : std::max({std::abs(low), std::abs(high), std::abs(step.value)}) * double_error;
    if (step.value < low - error || step.value > high + error) return false;
    if (step.contrast * longest_ray_ * (usual_part * error) > tolerance * (high - low)) return true;
    if (lattice_ == nullptr || step.contrast * longest_ray_ * relative_error <= tolerance) return false;
    double longest = 0;
    for (std::size_t i = 1; i < 4; ++i)
      for (std::size_t j = 0; j < i; ++j)
        longest = std::max(longest, glm::length(mesh_.positions[corners[i]] - mesh_.positions[corners[j]]));
    return step.contrast * longest * relative_error > tolerance;
  }

  const PreparedMesh& prepared_;
  scene::TetMeshView mesh_;
  std::span<const Step> steps_;
  double longest_ray_;
  const scene::Lattice* lattice_;
  std::span<const scene::MagnifiedRange> magnified_;
  double most_error_;  ///< upper bound of the error of any scalar near a step
};

}  // namespace

bool has_steps(const scene::TransferFunction& function) {
  const auto same_value = [](const scene::Knot& a, const scene::Knot& b) { return a.value == b.value; };
  return std::ranges::adjacent_find(function.knots(), same_value) != function.knots().end();
}

std::vector<Step> steps_of(const scene::TransferFunction& function, scene::Emission emission, double longest_ray) {
  std::vector<Step> steps;
  const auto knots = function.knots();
  const bool independent = emission == scene::Emission::independent;
  const double brightest = std::max(1.0, function.max_color() * (independent ? longest_ray : 1));
  for (std::size_t i = 1; i < knots.size(); ++i) {
    const scene::Knot &below = knots[i - 1], &above = knots[i];
    if (below.value != above.value) continue;
    const glm::dvec3 light =
        independent ? above.color - below.color : above.color * above.extinction - below.color * below.extinction;
    const glm::dvec3 change = glm::abs(light);
    steps.push_back({above.value, std::abs(above.extinction - below.extinction) * brightest +
                                      std::max({change.x, change.y, change.z})});
  }
  return steps;
}

std::vector<Step> with_cuts(std::vector<Step> steps, const IsoView* iso,
                            std::span<const scene::MagnifiedRange> magnified) {
  if (iso != nullptr)
    for (const double value : iso->values()) steps.push_back({value, 0, Step::Kind::surface});
  for (const scene::MagnifiedRange& range : magnified)
    for (const double value : {range.low, range.high}) steps.push_back({value, 0, Step::Kind::range_end});
  std::ranges::stable_sort(steps, {}, &Step::value);
  return steps;
}

CellsAtSteps::CellsAtSteps(const PreparedMesh& prepared, std::span<const Step> steps, double longest_ray,
                           const scene::Lattice* lattice, std::span<const scene::MagnifiedRange> magnified,
                           const std::stop_token& stop, scene::Team* team) {
  const std::size_t count = prepared.tets().size();
  if (steps.empty() || count == 0) return;
  if (lattice == nullptr && prepared.mesh().association == scene::Association::cell) return;
  const Rule rule(prepared, steps, longest_ray, lattice, magnified);
  const std::size_t words = (count + 63) / 64;
  if (team == nullptr)
    bits_.reset(words);
  else
    bits_.refer(team->memory_of<std::uint64_t>(scene::Team::Room::cells_at_steps, words), words);
  const scene::Share own = scene::share_of(words, team);
  std::fill(bits_.data() + own.first, bits_.data() + own.last, 0);
  struct Most {
    std::size_t pieces = 0;
  };
  const Most most = tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(own.first, own.last, 64), Most{},
      [&](const auto& range, Most so_far) {
        scene::throw_if_stopped(stop);
        std::size_t passed = 0;
        for (std::size_t word = range.begin(); word < range.end(); ++word) {
          if (rule.spares(word)) continue;
          for (std::size_t tet = 64 * word; tet < std::min(count, 64 * word + 64); ++tet) {
            const std::size_t pieces = rule.pieces(tet, passed);
            if (pieces == 0) continue;
            bits_[word] |= std::uint64_t{1} << tet % 64;
            so_far.pieces = std::max(so_far.pieces, pieces);
          }
        }
        return so_far;
      },
      [](Most a, Most b) { return Most{std::max(a.pieces, b.pieces)}; });
  const std::size_t pieces = scene::largest_of(std::uint64_t{most.pieces}, team);
  if (pieces == 0) bits_ = {};
  most_pieces_ = std::max<std::size_t>(pieces, 1);
}

namespace {

/// Returns the origin of a cell's scalars: the step nearest to them or, if a face of the cell is in a surface, the
/// value of this surface, so that the face's scalars are exactly zero.
double origin_of(const ProjectedMesh& projected, std::span<const Step> near, std::size_t tet, double low, double high) {
  for (const Step& step : near) {
    if (step.kind != Step::Kind::surface) continue;
    int level = 0;
    for (const std::uint32_t v : projected.mesh->tets()[tet])
      level += projected.mesh->mesh().scalars[v] == step.value ? 1 : 0;
    if (level == 3) return step.value;
  }
  const auto distance = [&](const Step& s) { return std::max({0.0, low - s.value, s.value - high}); };
  return std::min_element(near.begin(), near.end(),
                          [&](const Step& a, const Step& b) { return distance(a) < distance(b); })
      ->value;
}

}  // namespace

template <class Segments>
const Segments& SplitRasterizer<Segments>::rasterize(const ProjectedMesh& projected, std::span<const Step> steps,
                                                     const TileEntry& entry, const scene::PixelRect& rect,
                                                     RasterCounts& counts) {
  const auto area = static_cast<std::size_t>(rect.area());
  if (whole_.capacity() < area) whole_.reserve(area);
  whole_.size = 0;
  const std::array<double, 2> bounds = projected.mesh->scalar_bounds(entry.tet);
  const double low = bounds[0], high = bounds[1];
  if (!(low < high) || steps.empty()) {  // the cell has a single scalar, which is not rounded
    rasterize_planes(projected, {&entry, 1}, rect, whole_, counts);
    return whole_;
  }
  // The steps inside the cell's range, and one to either side.
  const std::size_t above_low = steps_passed(steps, low), above_high = steps_passed(steps, high);
  const std::size_t first = above_low - (above_low > 0 ? 1 : 0);
  const auto near = steps.subspan(first, std::min(steps.size(), above_high + 1) - first);
  const double origin = origin_of(projected, near, entry.tet, low, high);

  ProjectedMesh relative = projected;
  relative.scalar_origin = origin;
  rasterize_planes(relative, {&entry, 1}, rect, whole_, counts);
  const std::size_t most = whole_.size * (2 * near.size() + 1);
  const auto surfaces = projected.iso != nullptr ? projected.iso->within(low, high) : IsoView::Range{0, 0};
  const glm::dvec3 normal =
      surfaces.first < surfaces.last ? gradient_direction(*projected.mesh, entry.tet) : glm::dvec3(0);
  if (pieces_.capacity() < most) pieces_.reserve(most);
  pieces_.size = 0;
  for (std::size_t i = 0; i < whole_.size; ++i) {
    whole_.scalar_front[i] = std::clamp(whole_.scalar_front[i], low - origin, high - origin);
    whole_.scalar_back[i] = std::clamp(whole_.scalar_back[i], low - origin, high - origin);
    split(i, near, origin);
    if (surfaces.first == surfaces.last) continue;
    const auto pixel = static_cast<int>(whole_.pixel(i));
    const int x = rect.x0 + pixel % rect.width(), y = rect.y0 + pixel / rect.width();
    const glm::dvec3 ray = projected.iso->space->direction(x + 0.5, y + 0.5);
    cross(i, *projected.iso, surfaces, origin, ray, normal);
  }
  return pieces_;
}

template <class Segments>
void SplitRasterizer<Segments>::split(std::size_t segment, std::span<const Step> steps, double origin) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const double front = whole_.front[segment], back = whole_.back[segment];
  const double from = whole_.scalar_front[segment], to = whole_.scalar_back[segment];
  // The scalars are relative to `origin`, and there is no step between them.
  const auto add = [&](double piece_front, double piece_back, double a, double b) {
    std::size_t passed = 0;
    while (passed < steps.size() && steps[passed].value - origin <= std::min(a, b)) ++passed;
    const double low = passed > 0 ? steps[passed - 1].value : -infinity;
    const double high = passed < steps.size() ? steps[passed].value : infinity;
    double scalar_front = std::clamp(origin + a, low, high), scalar_back = std::clamp(origin + b, low, high);
    if (std::min(scalar_front, scalar_back) == high) {
      if (a <= b) scalar_front = std::nextafter(high, -infinity);
      if (b <= a) scalar_back = std::nextafter(high, -infinity);
    }
    const std::size_t at = pieces_.size++;
    pieces_.pixel_and_tet[at] = whole_.pixel_and_tet[segment];
    pieces_.front[at] = piece_front, pieces_.back[at] = piece_back;
    pieces_.scalar_front[at] = scalar_front, pieces_.scalar_back[at] = scalar_back;
    if constexpr (std::is_same_v<Segments, AttributeSegments>) {
      const double a0 = whole_.attribute_front[segment], a1 = whole_.attribute_back[segment];
      const auto attribute = [&](double depth) {
        return front < back ? a0 + (a1 - a0) * ((depth - front) / (back - front)) : a0;
      };
      pieces_.attribute_front[at] = attribute(piece_front), pieces_.attribute_back[at] = attribute(piece_back);
    }
  };
  if (!(front < back)) return add(front, back, from, from);
  double at = front, scalar = from;
  const auto cut = [&](const Step& step) {
    const double value = step.value - origin;
    if (!(std::min(scalar, to) < value && value < std::max(scalar, to))) return;
    const double depth = std::clamp(front + (back - front) * ((value - from) / (to - from)), at, back);
    if (at < depth) add(at, depth, scalar, value);
    at = depth, scalar = value;
  };
  if (from < to)
    std::for_each(steps.begin(), steps.end(), cut);
  else
    std::for_each(steps.rbegin(), steps.rend(), cut);
  if (at < back) add(at, back, scalar, to);
}

template <class Segments>
void SplitRasterizer<Segments>::cross(std::size_t segment, const IsoView& iso, IsoView::Range range, double origin,
                                      const glm::dvec3& ray, const glm::dvec3& normal) {
  const double front = whole_.front[segment], back = whole_.back[segment];
  const double from = whole_.scalar_front[segment], to = whole_.scalar_back[segment];
  const auto add = [&](std::size_t surface) {
    const double value = iso.values()[surface] - origin;
    if ((from >= value) == (to >= value)) return;
    double depth = std::clamp(front + (back - front) * ((value - from) / (to - from)), front, back);
    if (value == to) depth = back;
    const std::uint32_t number = iso.number(surface, from < to, depth, front, back);
    const std::size_t at = pieces_.size++;
    pieces_.pixel_and_tet[at] = whole_.pixel_and_tet[segment];
    pieces_.front[at] = pieces_.back[at] = depth;
    pieces_.scalar_front[at] = marked(Crossing{number, cosine_between(ray, normal)});
    pieces_.scalar_back[at] = iso.values()[surface];
  };
  if (from < to)
    for (std::size_t i = range.first; i < range.last; ++i) add(i);
  else
    for (std::size_t i = range.last; i-- > range.first;) add(i);
}

template class SplitRasterizer<RaySegments>;
template class SplitRasterizer<AttributeSegments>;

LatticeScalars lattice_scalars(double front, double back, std::span<const Step> steps, const scene::Lattice& lattice,
                               std::span<const scene::MagnifiedRange> magnified) {
  const double lowest = std::min(front, back);
  const auto range = std::ranges::find_if(magnified, [&](const auto& r) { return r.contains(lowest); });
  const auto on_lanes = [&](double v) {
    return static_cast<float>(lattice.scalar_step(range == magnified.end() ? v : range->moved(v)));
  };
  LatticeScalars s{on_lanes(front), on_lanes(back)};
  const std::size_t passed = steps_passed(steps, lowest);
  if (passed > 0) {
    const float low = on_lanes(steps[passed - 1].value);
    s = {std::max(s.front, low), std::max(s.back, low)};
  }
  if (passed == steps.size()) return s;
  const float high = on_lanes(steps[passed].value);
  s = {std::min(s.front, high), std::min(s.back, high)};
  if (std::min(s.front, s.back) == high) {
    const float below = std::min(high - 1, std::nextafter(high, -std::numeric_limits<float>::infinity()));
    if (front <= back) s.front = below;
    if (back <= front) s.back = below;
  }
  return s;
}

}  // namespace tessera::projection
