// SPDX-License-Identifier: BSD-3-Clause
// The values along one ray: computed by the reference from the few cells near it.
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "api/communicator.hpp"
#include "api/dataset.hpp"
#include "api/queries/ray_tets.hpp"
#include "exchange/collectives.hpp"
#include "reference/grid/grid_reference.hpp"
#include "reference/kept_interval.hpp"
#include "reference/reference.hpp"
#include "reference/view.hpp"
#include "scene/error.hpp"
#include "tessera/field_queries.hpp"

namespace tessera {
inline namespace v0_1 {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();

struct Depths {
  double begin = infinity, end = -infinity;
};

/// A ray through a data set. It provides the light of any interval, and the field along the ray.
class ProbedRay {
 public:
  ProbedRay(const View& view, PixelIndex pixel) : view_(view), pixel_(pixel), eye_(view.camera, view.size) {}
  virtual ~ProbedRay() = default;
  ProbedRay(const ProbedRay&) = delete;
  ProbedRay& operator=(const ProbedRay&) = delete;

  /// The depths where the ray first enters the data and where it last leaves them; begin > end if the ray misses the
  /// data.
  [[nodiscard]] virtual Depths depths() const = 0;
  [[nodiscard]] virtual double value(double depth) const = 0;

  [[nodiscard]] ReferencePixel all() const { return pixel_with(view_.camera); }
  /// Opacity of the ray between two depths.
  [[nodiscard]] double opacity(double near, double far) const {
    near = std::max(near, eye_.nearest()), far = std::min(far, eye_.farthest());
    if (!(near < far)) return 0;
    Camera camera = view_.camera;
    camera.clipping_range = {near, far};
    return pixel_with(camera).a;
  }
  /// Returns the point at `depth`. If the point is outside the cells because of rounding, its value is that of a point
  /// just in front of it or just behind it.
  [[nodiscard]] RayPoint point(double depth) const {
    const reference::View::Ray ray = eye_.ray(x(), y());
    const double nudge = 1e-7 * (1 + std::abs(depths().end - depths().begin));
    RayPoint point{depth, ray.origin + depth * ray.step, value(depth)};
    for (const double other : {depth + nudge, depth - nudge})
      if (std::isnan(point.value)) point.value = value(other);
    return point;
  }

 protected:
  [[nodiscard]] virtual ReferencePixel pixel_with(const Camera& camera) const = 0;
  [[nodiscard]] double x() const { return pixel_.x + 0.5; }
  [[nodiscard]] double y() const { return pixel_.y + 0.5; }

  View view_;
  PixelIndex pixel_;
  reference::View eye_;
};

/// A ray through a mesh. `near` contains the tets that the ray may meet.
class RayInMesh final : public ProbedRay {
 public:
  RayInMesh(scene::TetMesh near, const View& view, PixelIndex pixel, const TransferFunction& function,
            const Settings& settings)
      : ProbedRay(view, pixel),
        mesh_(std::move(near)),
        function_(function),
        emission_(settings.emission),
        surfaces_(settings.surfaces),
        shading_(settings.mesh.shading) {
    for (TriangleSurface& surface : surfaces_.triangles)
      surface.mesh = std::make_shared<const TriangleMesh>(api::triangles_near_ray(*surface.mesh, view, pixel));
    segments_ = reference::Reference(mesh_, view.camera, view.size, function, emission_).segments(x(), y());
  }

  [[nodiscard]] Depths depths() const override {
    Depths found;
    for (const auto& s : segments_) found = {std::min(found.begin, s.front), std::max(found.end, s.back)};
    return found;
  }
  [[nodiscard]] double value(double depth) const override {
    for (const auto& s : segments_) {
      if (s.front > depth) break;
      if (depth > s.back) continue;
      const double share = s.back > s.front ? (depth - s.front) / (s.back - s.front) : 0;
      return std::lerp(s.scalar_front, s.scalar_back, share);
    }
    return nan;
  }

 private:
  [[nodiscard]] ReferencePixel pixel_with(const Camera& camera) const override {
    return reference::Reference(mesh_, camera, view_.size, function_, emission_, surfaces_, {}, shading_)
        .pixel(x(), y());
  }

  scene::TetMesh mesh_;
  const TransferFunction& function_;
  Emission emission_;
  Surfaces surfaces_;
  std::optional<Shading> shading_;
  std::vector<reference::RaySegment> segments_;
};

class RayInGrid final : public ProbedRay {
 public:
  RayInGrid(const Dataset::State& data, const View& view, PixelIndex pixel, const TransferFunction& function,
            const Settings& settings)
      : ProbedRay(view, pixel), data_(data), function_(function), settings_(settings) {}

  [[nodiscard]] Depths depths() const override {
    const GridGeometry& g = data_.samples->geometry();
    const reference::View::Ray ray = eye_.ray(x(), y());
    const auto kept = reference::kept_interval(eye_, x(), y(), data_.clip);
    const glm::dmat3 to_local = world_to_local(g);
    const glm::dvec3 origin = to_local * (ray.origin - g.origin), step = to_local * ray.step;
    Depths found{kept.nearest, kept.farthest};
    for (std::size_t a = 0; a < 3; ++a) {
      const auto axis = static_cast<int>(a);
      const double low = g.lattice(a, 0), high = g.lattice(a, g.points[a] - 1);
      if (std::abs(step[axis]) * (high - low) < 1e-300) {
        if (!(origin[axis] >= low && origin[axis] <= high)) return {};
        continue;
      }
      const auto [enter, leave] = std::minmax({(low - origin[axis]) / step[axis], (high - origin[axis]) / step[axis]});
      found = {std::max(found.begin, enter), std::min(found.end, leave)};
    }
    return found.begin < found.end ? found : Depths{};
  }
  [[nodiscard]] double value(double depth) const override {
    const auto kept = reference::kept_interval(eye_, x(), y(), data_.clip);
    if (!(depth >= kept.nearest && depth <= kept.farthest)) return nan;
    const scene::Grid& grid = data_.samples->grid();
    const GridGeometry& g = grid.geometry;
    const reference::View::Ray ray = eye_.ray(x(), y());
    const glm::dvec3 index = index_of_world(g, ray.origin + depth * ray.step);
    const bool cells = g.association == Association::cell;
    SampleBox box;
    glm::dvec3 part;
    for (std::size_t a = 0; a < 3; ++a) {
      const auto axis = static_cast<int>(a);
      const auto last = static_cast<double>(g.points[a] - 1);
      constexpr double rounding = 1e-6;
      if (!(index[axis] >= -rounding && index[axis] <= last + rounding)) return nan;
      const double at = std::clamp(index[axis], 0.0, last);
      box.low[a] = std::min(static_cast<std::int64_t>(at), g.points[a] - 2);
      box.high[a] = box.low[a] + (cells ? 1 : 2);
      part[axis] = at - static_cast<double>(box.low[a]);
    }
    std::array<double, 8> v{};
    data_.samples->read(box, std::span(v).first(cells ? 1 : 8));
    for (std::size_t i = 0; i < (cells ? 1U : 8U); ++i)
      if (!std::isfinite(v[i])) return nan;
    if (!cells)
      for (int axis = 0; axis < 3; ++axis)
        for (std::size_t i = 0; i < (4U >> axis); ++i) v[i] = std::lerp(v[2 * i], v[2 * i + 1], part[axis]);
    return grid.value(v[0]);
  }

 private:
  [[nodiscard]] ReferencePixel pixel_with(const Camera& camera) const override {
    return reference::GridReference(*data_.samples, camera, view_.size, function_, settings_.emission,
                                    settings_.grid.shading, data_.clip, settings_.surfaces)
        .pixel(x(), y());
  }

  const Dataset::State& data_;
  const TransferFunction& function_;
  const Settings& settings_;
};

/// A tet that a ray meets, with the geometry of the tet.
struct RayTet {
  std::uint64_t number;  ///< number of the tet in the whole mesh
  std::array<glm::dvec3, 4> positions;
  std::array<double, 4> scalars;  ///< values at the corners; for cell data only the first is used
};
static_assert(sizeof(RayTet) == 136);

/// Returns the tets of a mesh through which the ray passes, in the order of the whole mesh.
std::vector<RayTet> tets_on_ray(const Dataset::State& data, const View& view, PixelIndex pixel) {
  const std::vector<std::uint32_t> near = api::tets_near_ray(data.mesh, view, pixel);
  const scene::TetMesh subset = scene::subset(data.mesh, near);
  Camera camera = view.camera;
  camera.clipping_range.reset();  // cells beyond the range are needed to find the boundary faces of the mesh
  const TransferFunction any({Knot{}});
  std::vector<std::size_t> met;
  for (const auto& s : reference::Reference(subset, camera, view.size, any).segments(pixel.x + 0.5, pixel.y + 0.5))
    met.push_back(s.tet);
  std::ranges::sort(met);
  std::vector<RayTet> tets;
  for (const std::size_t t : met) {
    RayTet tet{data.global_tet.empty() ? near[t] : data.global_tet[near[t]], {}, {}};
    for (std::size_t c = 0; c < 4; ++c) {
      const std::uint32_t v = subset.tets[t][c];
      tet.positions[c] = subset.positions[v];
      tet.scalars[c] = subset.association == Association::point ? subset.scalars[v] : subset.scalars[t];
    }
    tets.push_back(tet);
  }
  return tets;
}

std::vector<RayTet> gathered(std::vector<RayTet> mine, const Communicator& communicator) {
  const std::shared_ptr<exchange::Transport> transport = StateAccess::of(communicator).connect();
  exchange::Bytes message = exchange::begin_message(exchange::MessageKind::ray_tets);
  exchange::append_list(message, mine);
  mine.clear();
  int from = 0;
  for (const exchange::Bytes& bytes : exchange::gather_all(*transport, std::move(message))) {
    exchange::MessageReader reader(bytes, from++, exchange::MessageKind::ray_tets);
    const auto count = reader.take<std::uint64_t>();
    reader.take_onto(mine, count);
    reader.finish();
  }
  std::ranges::sort(mine, {}, &RayTet::number);
  return mine;
}

scene::TetMesh mesh_of(std::span<const RayTet> tets, Association association) {
  scene::TetMesh mesh;
  mesh.association = association;
  for (const RayTet& tet : tets) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.tets.push_back({first, first + 1, first + 2, first + 3});
    mesh.positions.insert(mesh.positions.end(), tet.positions.begin(), tet.positions.end());
    const std::size_t count = association == Association::point ? 4 : 1;
    mesh.scalars.insert(mesh.scalars.end(), tet.scalars.begin(), tet.scalars.begin() + static_cast<long>(count));
  }
  return mesh;
}

/// Returns the depth between `begin` and `end` where the opacity accumulated from the eye reaches `wanted`. `before` is
/// the opacity at `begin`.
double depth_of(const ProbedRay& ray, double wanted, double begin, double end, double before) {
  double low = begin, high = end;
  for (int halving = 0; halving < 48; ++halving) {
    const double middle = 0.5 * (low + high);
    if (!(middle > low && middle < high)) break;
    (1 - (1 - before) * (1 - ray.opacity(begin, middle)) >= wanted ? high : low) = middle;
  }
  return high;
}

RayProbe probed(const ProbedRay& ray, std::size_t samples) {
  RayProbe found;
  found.pixel = ray.all();
  if (std::isfinite(found.pixel.z)) found.first = ray.point(found.pixel.z);
  const auto [begin, end] = ray.depths();
  if (!(begin < end)) return found;
  found.depth.resize(samples), found.value.resize(samples), found.opacity.resize(samples);
  for (std::size_t i = 0; i < samples; ++i)
    found.depth[i] = std::lerp(begin, end, static_cast<double>(i) / static_cast<double>(samples - 1));
  tbb::parallel_for(std::size_t{0}, samples, [&](std::size_t i) {
    const bool is_end = i == 0 || i + 1 == samples;
    found.value[i] = is_end ? ray.point(found.depth[i]).value : ray.value(found.depth[i]);
    found.opacity[i] = ray.opacity(i == 0 ? -infinity : found.depth[i - 1], found.depth[i]);
  });
  for (std::size_t i = 1; i < samples; ++i) found.opacity[i] = 1 - (1 - found.opacity[i - 1]) * (1 - found.opacity[i]);
  if (!found.first) return found;
  const auto reach = [&](double wanted) -> std::optional<RayPoint> {
    const auto at = std::ranges::lower_bound(found.opacity, wanted);
    if (at == found.opacity.end()) return std::nullopt;  // `wanted` is reached on a surface behind the data
    const auto i = static_cast<std::size_t>(at - found.opacity.begin());
    if (i == 0) return ray.point(std::max(found.pixel.z, found.depth[0]));
    return ray.point(depth_of(ray, wanted, found.depth[i - 1], found.depth[i], found.opacity[i - 1]));
  };
  found.front = reach(0.01 * found.pixel.a);
  found.half = reach(0.5 * found.pixel.a);
  return found;
}

}  // namespace

RayProbe probe(const Dataset& dataset, const View& view, const TransferFunction& transfer_function, PixelIndex pixel,
               std::size_t samples, const Settings& settings, const Communicator& communicator) {
  validate(view.camera);
  validate(view.size);
  const auto [x, y] = pixel;
  if (x < 0 || y < 0 || x >= view.size.width || y >= view.size.height)
    throw scene::bad_input(fmt::format("probe: pixel ({}, {}) is not in an image of {}x{}; count from 0", x, y,
                                       view.size.width, view.size.height));
  constexpr std::size_t most_samples = 65536;
  if (samples < 2 || samples > most_samples)
    throw scene::bad_input(
        fmt::format("probe: {} samples along the ray are not supported; choose 2 to {}", samples, most_samples));
  if (transfer_function.knots().empty())
    throw scene::bad_input("transfer function: it has no knots; give at least one");
  const Dataset::State& data = StateAccess::of(dataset);
  if (dataset.is_grid()) return probed(RayInGrid(data, view, pixel, transfer_function, settings), samples);
  if (data.ranks > 1 && data.ranks != communicator.size())
    throw scene::bad_input(fmt::format(
        "{}: this rank has a part of the mesh; give the communicator that it was opened with", data.source));
  std::vector<RayTet> tets = tets_on_ray(data, view, pixel);
  if (data.ranks > 1) tets = gathered(std::move(tets), communicator);
  return probed(RayInMesh(mesh_of(tets, data.facts.association), view, pixel, transfer_function, settings), samples);
}

}  // namespace v0_1
}  // namespace tessera
