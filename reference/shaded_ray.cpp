// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "reference/integral.hpp"
#include "reference/kept_interval.hpp"
#include "reference/reference.hpp"

namespace tessera::reference {
namespace {

/// How far, in pixels, a ray may be moved to decide that it meets two faces at the same depth: twice the rounding of a
/// vertex (View::project), plus the rounding of a pixel coordinate from long double to double.
constexpr double shift = 0x1p-32, last_places = 0x1p-50;

/// Depths that differ by more than this, relative to a face's own depth, are never equal.
constexpr double most_reach = 1e-9;

}  // namespace

/// Computes the light of one ray.
class Reference::Ray {
 public:
  Ray(const Reference& reference, std::span<const RaySegment> segments, double x, double y,
      const std::optional<Peel>& peel = std::nullopt)
      : reference_(reference),
        segments_(segments),
        x_(x),
        y_(y),
        integral_(reference.knots_, reference.emission_, peel),
        direction_(reference.view_.ray(x, y).step),
        kept_(kept_interval(reference.view_, x, y, reference.kept_)) {
    add_marks();
    put_marks_in_order();
    progress_.resize(segments.size());
    for (std::size_t s = 0; s < segments.size(); ++s) cut(s);
    integrate();
  }

  [[nodiscard]] Pixel shaded() const {
    Pixel pixel;
    std::tie(pixel.r, pixel.g, pixel.b) = std::tuple_cat(integral_.color());
    pixel.a = integral_.opacity();
    pixel.z = integral_.first_visible_depth();
    for (const RaySegment& s : segments_) pixel.length += s.length;
    pixel.segments = segments_.size();
    return pixel;
  }

  [[nodiscard]] std::vector<Pixel> layers() const { return integral_.layers(); }

 private:
  void integrate() {
    std::stable_sort(pieces_.begin(), pieces_.end(), [](const Piece& a, const Piece& b) {
      return std::tuple(a.before, a.at, a.front, a.back) < std::tuple(b.before, b.at, b.front, b.back);
    });
    auto piece = pieces_.begin();
    for (std::size_t p = 0; p <= places_.size(); ++p) {
      for (; piece != pieces_.end() && piece->before == p && !piece->at; ++piece) integrate(*piece);
      if (p == places_.size()) break;
      std::size_t m = places_[p].first;
      for (; m < places_[p].last && marks_[m].kind != Mark::Kind::enters; ++m) add_face(marks_[m]);
      for (; piece != pieces_.end() && piece->before == p; ++piece) integrate(*piece);
      for (; m < places_[p].last; ++m) add_face(marks_[m]);
    }
  }

  /// The change of a plane's depth from one pixel to the next, and its largest rounding error.
  struct Slope {
    double value = 0, error = 0;
  };

  /// The intersection of a ray with a face of a surface.
  struct Mark {
    double depth, reach;
    /// Values are in the order in which a ray meets faces of these kinds in the same plane.
    enum class Kind : std::uint8_t { leaves, goes_through, enters } kind;
    std::size_t paint;
    glm::dvec3 normal;
    double scalar;
    std::array<Slope, 2> slope{};  ///< slopes in x and y
  };

  /// Faces that a ray meets at one depth, which is that of the first face.
  struct Place {
    double depth, reach;
    std::size_t first, last;  ///< range of the marks at this place
  };

  /// The part of a segment between two places, or a complete segment at one place.
  struct Piece {
    std::size_t before;  ///< index of the next place
    bool at;             ///< whether the piece is a complete segment at that place
    double front, back;
    std::size_t segment, first, last;  ///< `first` and `last`: range of the segment's crossings
  };

  /// Returns by how much the depth at which a ray meets a face may change if the ray is shifted by `shift`. The result
  /// depends on the slope of the plane and, for rounding, on the farthest of the corners and the largest of their
  /// depths.
  [[nodiscard]] double reach(const glm::dvec3& normal, double depth, double far, double size) const {
    const View& view = reference_.view_;
    const View::Ray ray = view.ray(x_, y_);
    const auto change = [&](double dx, double dy) {
      const View::Ray other = view.ray(x_ + dx, y_ + dy);
      return std::abs(glm::dot(normal, other.origin - ray.origin) + depth * glm::dot(normal, other.step - ray.step));
    };
    const double slope = (change(1, 0) + change(0, 1)) / std::abs(glm::dot(normal, ray.step));
    const double pixels = shift + last_places * (view.perspective() ? far / std::abs(depth) : far);
    const double reach = slope * pixels + 0x1p-48 * size;
    return reach < most_reach * size ? reach : most_reach * size;
  }

  template <class Corners>
  [[nodiscard]] double reach(const glm::dvec3& normal, double depth, const Corners& corners) const {
    double far = 0, size = 0;
    for (const Corner& corner : corners) {
      far = std::max({far, std::abs(corner.vertex.homogeneous.x), std::abs(corner.vertex.homogeneous.y)});
      size = std::max(size, std::abs(corner.vertex.depth));
    }
    return reach(normal, depth, far, size);
  }

  void add_marks() {
    if (!reference_.boundary_.empty())
      for (const RaySegment& s : segments_) {
        add_boundary(s, true);
        add_boundary(s, false);
      }
    for (const TriangleCrossing& t : reference_.triangles_on(x_, y_)) {
      const double within = reach(t.triangle->normal, t.hit.depth, t.triangle->corners);
      // A face through the eye must not count as in front of the eye because of rounding.
      const double nearest = reference_.view_.nearest() > 0 ? reference_.view_.nearest() : within;
      if (nearest < t.hit.depth && t.hit.depth < reference_.view_.farthest())
        marks_.push_back({t.hit.depth, within, Mark::Kind::goes_through,
                          reference_.boundary_.size() + t.triangle->paint, t.triangle->normal, t.hit.scalar});
    }
  }

  /// Adds the boundary at an end of a segment, if there is one: an open face, or a clipping plane that cuts the mesh. A
  /// ray meets each clipping plane once.
  void add_boundary(const RaySegment& s, bool front) {
    const double depth = front ? s.front : s.back;
    const auto add = [&](const glm::dvec3& normal, double within) {
      for (std::size_t paint = 0; paint < reference_.boundary_.size(); ++paint)
        marks_.push_back({depth, within, front ? Mark::Kind::enters : Mark::Kind::leaves, paint, normal,
                          front ? s.scalar_front : s.scalar_back});
    };
    if (const scene::HalfSpace* plane = front ? kept_.nearest_plane : kept_.farthest_plane) {
      const double at = front ? kept_.nearest : kept_.farthest;
      const double within = reach(plane->normal, at, reference_.corners(s.tet));
      if (front ? s.front <= at + within : s.back >= at - within) {
        // A part of a cell that consists only of a rounding error does not have a boundary.
        const bool thin = front ? !(s.back > at + within) : !(s.front < at - within);
        bool& met = front ? met_nearest_ : met_farthest_;
        if (thin || met) return;
        met = true;
        return add(plane->normal, within);
      }
    }
    const int face = front ? s.face_front : s.face_back;
    if (face < 0 || (reference_.open_[s.tet] >> face & 1) == 0) return;
    const glm::dvec3 normal = reference_.face_normal(s.tet, face);
    add(normal, reach(normal, depth, reference_.corners(s.tet)));
  }

  void put_marks_in_order() {
    std::stable_sort(marks_.begin(), marks_.end(), [](const Mark& a, const Mark& b) { return a.depth < b.depth; });
    for (std::size_t first = 0, last; first < marks_.size(); first = last) {
      Place place{marks_[first].depth, marks_[first].reach, first, 0};
      for (last = first + 1; last < marks_.size(); ++last) {
        if (marks_[last].depth - place.depth > marks_[first].reach + marks_[last].reach) break;
        place.reach = std::max(place.reach, marks_[last].reach);
      }
      place.last = last;
      std::vector<Mark> marks(marks_.begin() + static_cast<std::ptrdiff_t>(first),
                              marks_.begin() + static_cast<std::ptrdiff_t>(last));
      for (Mark& mark : marks) mark.slope = slope(mark.normal, mark.depth);
      std::ranges::copy(in_order(std::move(marks), 0), marks_.begin() + static_cast<std::ptrdiff_t>(first));
      places_.push_back(place);
    }
  }

  [[nodiscard]] std::array<Slope, 2> slope(const glm::dvec3& normal, double depth) const {
    constexpr double rounding = 1e-9;
    const View::Ray ray = reference_.view_.ray(x_, y_);
    std::array<Slope, 2> slopes;
    for (int axis = 0; axis < 2; ++axis) {
      const View::Ray next = reference_.view_.ray(x_ + (axis == 0 ? 1 : 0), y_ + (axis == 1 ? 1 : 0));
      const glm::dvec3 moved = next.origin - ray.origin + depth * (next.step - ray.step);
      const double across = glm::dot(normal, ray.step);
      slopes[static_cast<std::size_t>(axis)] = {-glm::dot(normal, moved) / across,
                                                rounding * glm::length(normal) * glm::length(moved) / std::abs(across)};
    }
    return slopes;
  }

  /// Sorts marks at one depth in the order in which a ray shifted by (e, e^2) pixel meets them, as in intersect():
  /// first the plane that comes nearer by the shift in x; among equal planes, the one that comes nearer by the shift in
  /// y; for marks in the same plane, by kind and paint.
  static std::vector<Mark> in_order(std::vector<Mark> marks, std::size_t axis) {
    if (marks.size() < 2) return marks;
    if (axis == 2) {
      std::ranges::stable_sort(
          marks, [](const Mark& a, const Mark& b) { return std::tie(a.kind, a.paint) < std::tie(b.kind, b.paint); });
      return marks;
    }
    std::ranges::stable_sort(marks, {}, [axis](const Mark& m) { return m.slope[axis].value; });
    std::vector<Mark> ordered, equal;
    const auto take_equal = [&] {
      for (const Mark& mark : in_order(std::exchange(equal, {}), axis + 1)) ordered.push_back(mark);
    };
    for (const Mark& mark : marks) {
      if (!equal.empty()) {
        const Slope &from = equal.front().slope[axis], &to = mark.slope[axis];
        if (to.value - from.value > from.error + to.error) take_equal();
      }
      equal.push_back(mark);
    }
    take_equal();
    return ordered;
  }

  /// Cuts a segment at all places inside it, so that overlapping cells are in the order of depth, too.
  void cut(std::size_t number) {
    const RaySegment& s = segments_[number];
    Progress& progress = progress_[number];
    progress.change = s.change_front;
    if (reference_.matter_light_) progress.light = reference_.matter_light_->in(reference_.mesh_, s.tet, direction_);
    const KeptDepths depths{kept_.nearest, kept_.farthest, kept_.nearest_plane != nullptr,
                            kept_.farthest_plane != nullptr};
    if (!reference_.surfaces_.empty())
      progress.crossings = surface_crossings(reference_.surfaces_, reference_.corners(s.tet), x_, y_, depths);
    std::size_t begin = places_.size(), end = 0;  // the places in [begin, end) are inside the segment
    while (begin > 0 && places_[begin - 1].depth > s.front + places_[begin - 1].reach) --begin;
    while (end < places_.size() && places_[end].depth < s.back - places_[end].reach) ++end;
    if (begin > end) {
      pieces_.push_back({end, true, s.front, s.back, number, 0, progress.crossings.size()});
      return;
    }
    double front = s.front;
    if (begin > 0 && std::abs(front - places_[begin - 1].depth) <= places_[begin - 1].reach)
      front = places_[begin - 1].depth;
    std::size_t crossing = 0;
    for (std::size_t next = begin; next <= end; ++next) {
      const std::size_t first = crossing;
      const auto comes_first = [&](const SurfaceCrossing& c) {
        return s.front + (s.back - s.front) * c.part < places_[next].depth - places_[next].reach;
      };
      while (crossing < progress.crossings.size() && (next == end || comes_first(progress.crossings[crossing])))
        ++crossing;
      const double back = next < end ? places_[next].depth : s.back;
      pieces_.push_back({next, false, front, back, number, first, crossing});
      front = back;
    }
  }

  void integrate(const Piece& piece) {
    const RaySegment& s = segments_[piece.segment];
    const std::vector<SurfaceCrossing>& crossings = progress_[piece.segment].crossings;
    for (std::size_t i = piece.first; i < piece.last; ++i) {
      const SurfaceCrossing& c = crossings[i];
      advance(piece.segment, c.part, c.surface->value - s.corner_scalar);
      integral_.add_surface(lit(*c.surface, reference_.light_, direction_, reference_.mesh_, s.tet), c.surface->opacity,
                            s.front + (s.back - s.front) * c.part);
    }
    if (piece.back == s.back) return advance(piece.segment, 1, s.change_back);
    const double part = std::max(progress_[piece.segment].part, (piece.back - s.front) / (s.back - s.front));
    advance(piece.segment, part, s.change_front + (s.change_back - s.change_front) * part);
  }

  /// Integrates up to the fraction `part` of the segment.
  void advance(std::size_t segment, double part, double change) {
    const RaySegment& s = segments_[segment];
    Progress& at = progress_[segment];
    const auto depth_at = [&](double p) { return p == 1 ? s.back : s.front + (s.back - s.front) * p; };
    integral_.add(s.length * (part - at.part), at.change, change, depth_at(at.part), depth_at(part), s.corner_scalar,
                  at.light);
    at.part = part, at.change = change;
  }

  void add_face(const Mark& mark) {
    const std::size_t boundaries = reference_.boundary_.size();
    const Paint& paint =
        mark.paint < boundaries ? reference_.boundary_[mark.paint] : reference_.paints_[mark.paint - boundaries];
    const glm::dvec3 color = paint.color ? *paint.color : glm::dvec3(reference_.function_.evaluate(mark.scalar).color);
    integral_.add_surface(lit(color, reference_.light_, direction_, mark.normal), paint.opacity, mark.depth);
  }

  const Reference& reference_;
  std::span<const RaySegment> segments_;
  double x_, y_;
  Integral integral_;
  glm::dvec3 direction_;
  DepthInterval kept_;
  bool met_nearest_ = false, met_farthest_ = false;
  std::vector<Mark> marks_;
  std::vector<Place> places_;
  std::vector<Piece> pieces_;
  /// How much of a segment has been integrated.
  struct Progress {
    double part = 0, change = 0;
    Integral::Light light;
    std::vector<SurfaceCrossing> crossings;
  };
  std::vector<Progress> progress_;
};

Pixel Reference::shaded(std::span<const RaySegment> segments, double x, double y) const {
  return Ray(*this, segments, x, y).shaded();
}

std::vector<Pixel> Reference::layers(std::span<const RaySegment> segments, double x, double y, const Peel& peel) const {
  return Ray(*this, segments, x, y, peel).layers();
}

}  // namespace tessera::reference
