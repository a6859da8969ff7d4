#include "volume/deep_grid.hpp"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include "compositor/deep_collector.hpp"
#include "compositor/deep_fragments.hpp"
#include "compositor/deep_pieces.hpp"
#include "compositor/deep_sink.hpp"
#include "compositor/segment_batch.hpp"
#include "compositor/segment_integrator.hpp"
#include "scene/error.hpp"

namespace tessera::volume {
namespace {

constexpr std::int64_t deep_block = 16;
constexpr std::size_t deep_blocks = 256;
constexpr double line_tolerance = 2e-9;  ///< linear RGBA, a stretch taken for a line

/// A view ray in the grid's local frame: at planar depth z it is at origin + z * step.
struct DeepRay {
  glm::dvec3 origin, step;
  double length_per_depth, begin, end;
};

/// The samples of a voxel's corners (cell data: of the voxel), block by block.
class BlockReader {
 public:
  explicit BlockReader(const scene::SampleSource& source)
      : source_(source),
        samples_(source.geometry().samples()),
        shared_(source.geometry().association == scene::Association::point ? 1 : 0),
        blocks_(deep_blocks) {}

  /// Corner (a, b, c) at [a + 2 b + 4 c].
  std::array<double, 8> corners(const scene::GridIndex& voxel) {
    const scene::GridIndex place{voxel[0] / deep_block, voxel[1] / deep_block, voxel[2] / deep_block};
    Block& block = blocks_[static_cast<std::size_t>(place[0] + 7 * place[1] + 49 * place[2]) % deep_blocks];
    if (block.place != place || block.values.empty()) fill(block, place);
    const std::int64_t width = block.box.extent(0), slice = width * block.box.extent(1);
    const double* const at = &block.values[static_cast<std::size_t>(
        (voxel[0] - block.box.low[0]) + width * (voxel[1] - block.box.low[1]) + slice * (voxel[2] - block.box.low[2]))];
    const std::int64_t i = shared_, j = shared_ * width, k = shared_ * slice;
    return {at[0], at[i], at[j], at[i + j], at[k], at[k + i], at[k + j], at[k + i + j]};
  }

 private:
  struct Block {
    scene::GridIndex place{-1, -1, -1};
    scene::SampleBox box;
    std::vector<double> values;
  };
  void fill(Block& block, const scene::GridIndex& place) {
    for (std::size_t a = 0; a < 3; ++a) {
      block.box.low[a] = place[a] * deep_block;
      block.box.high[a] = std::min(block.box.low[a] + deep_block + shared_, samples_[a]);
    }
    block.values.resize(static_cast<std::size_t>(block.box.count()));
    block.place = place;
    source_.read(block.box, std::span<double>(block.values));
    for (double& v : block.values) v = std::isfinite(v) ? source_.grid().value(v) : std::nan("");
  }

  const scene::SampleSource& source_;
  scene::GridIndex samples_;
  std::int64_t shared_;
  std::vector<Block> blocks_;
};

/// s over u in [0, 1], degree three.
struct FieldCubic {
  std::array<double, 4> c;

  [[nodiscard]] double at(double u) const { return ((c[3] * u + c[2]) * u + c[1]) * u + c[0]; }
  [[nodiscard]] double mean(double u0, double u1) const {
    const double m = (u0 + u1) / 2, h = (u1 - u0) / 2;
    return at(m) + (c[2] + 3 * c[3] * m) * h * h / 3;
  }
};

/// Of the trilinear field from `front` on over `rise`, both in the voxel's unit cube.
FieldCubic cubic_of(const std::array<double, 8>& corner, const glm::dvec3& front, const glm::dvec3& rise) {
  // Bilinear in each axis in turn, polynomials growing by a degree each.
  std::array<std::array<double, 4>, 8> p{};
  for (std::size_t n = 0; n < 8; ++n) p[n][0] = corner[n];
  for (int axis = 0; axis < 3; ++axis)
    for (std::size_t n = 0; n < (4u >> axis); ++n) {
      const std::array<double, 4> low = p[2 * n], high = p[2 * n + 1];
      for (std::size_t i = 0; i < 4; ++i) {
        p[n][i] = low[i] + (high[i] - low[i]) * front[axis];
        if (i > 0) p[n][i] += (high[i - 1] - low[i - 1]) * rise[axis];
      }
    }
  return {p[0]};
}

/// One thread's way of making deep pixels.
class DeepPixels {
 public:
  DeepPixels(const scene::SampleSource& source, const scene::TransferFunction& function, const DeepSettings& settings)
      : geometry_(source.geometry()),
        reader_(source),
        knots_(function.knots().begin(), function.knots().end()),
        cutter_(function, settings.emission, settings.accuracy),
        integrator_(function, {.kind = scene::IntegratorKind::exact}, settings.emission),
        independent_(settings.emission == scene::Emission::independent),
        accuracy_(settings.accuracy) {
    const scene::Box box = scene::bounds(geometry_);
    left_out_ = compositor::opacity_weight(function.max_color(), glm::length(box.high - box.low), settings.emission);
  }

  /// Appends the pixel's samples.
  void add(const DeepRay& ray, std::vector<scene::DeepImageSample>& to) {
    walk(ray);
    batch_.reserve(pieces_.size());
    batch_.size = pieces_.size();
    for (std::size_t k = 0; k < pieces_.size(); ++k) {
      batch_.length[k] = (pieces_[k].back - pieces_[k].front) * ray.length_per_depth;
      batch_.scalar_front[k] = pieces_[k].scalar_front;
      batch_.scalar_back[k] = pieces_[k].scalar_back;
    }
    integrator_.integrate(batch_);
    compositor::DeepMerger merger(accuracy_);
    samples_.clear();
    for (std::size_t k = 0; k < pieces_.size(); ++k)
      merger.add({pieces_[k].front,
                  pieces_[k].back,
                  {batch_.red[k], batch_.green[k], batch_.blue[k]},
                  pieces_[k].optical_depth},
                 samples_);
    merger.end(samples_);
    compositor::append_tidy(samples_, to);
  }

 private:
  void walk(const DeepRay& ray) {
    pieces_.clear();
    transmittance_ = 1;
    if (!(ray.begin < ray.end)) return;
    cuts_.assign({ray.begin, ray.end});
    for (std::size_t a = 0; a < 3; ++a) {
      const int axis = static_cast<int>(a);
      if (ray.step[axis] == 0) continue;
      const auto voxel = [&](double z) { return voxel_along(a, ray.origin[axis] + z * ray.step[axis]); };
      const std::int64_t one = voxel(ray.begin), other = voxel(ray.end);
      for (std::int64_t i = std::min(one, other); i <= std::max(one, other) + 1; ++i) {
        const double z = (geometry_.lattice(a, i) - ray.origin[axis]) / ray.step[axis];
        if (z > ray.begin && z < ray.end) cuts_.push_back(z);
      }
    }
    std::sort(cuts_.begin(), cuts_.end());
    for (std::size_t n = 0; n + 1 < cuts_.size(); ++n) {
      if (transmittance_ * left_out_ < integrator_.termination_error()) return;
      if (cuts_[n] < cuts_[n + 1]) cross(ray, cuts_[n], cuts_[n + 1]);
    }
  }

  /// The voxel that a ray is in from depth z0 to z1.
  void cross(const DeepRay& ray, double z0, double z1) {
    const glm::dvec3 middle = ray.origin + ray.step * ((z0 + z1) / 2);
    scene::GridIndex voxel{};
    glm::dvec3 front(0), rise(0);
    for (std::size_t a = 0; a < 3; ++a) {
      const int axis = static_cast<int>(a);
      voxel[a] = voxel_along(a, middle[axis]);
      const double low = geometry_.lattice(a, voxel[a]), side = geometry_.lattice(a, voxel[a] + 1) - low;
      front[axis] = (ray.origin[axis] + z0 * ray.step[axis] - low) / side;
      rise[axis] = (z1 - z0) * ray.step[axis] / side;
    }
    const std::array<double, 8> corner = reader_.corners(voxel);
    double low = corner[0], high = corner[0], all = 0;
    for (const double s : corner) low = std::min(low, s), high = std::max(high, s), all += s;
    if (std::isnan(all) || !shows(low, high)) return;
    if (low == high)  // cell data too
      return cutter_.cut({z0, z1, low, low}, ray.length_per_depth, transmittance_, pieces_);
    const FieldCubic field = cubic_of(corner, front, rise);
    const double length = (z1 - z0) * ray.length_per_depth;

    std::array<double, 4> ends{0, 1, 1, 1};
    std::size_t count = 1;
    turning_points(field, ends, count);
    for (std::size_t e = 0; e < count; ++e) {
      double u = ends[e];
      const double stop = ends[e + 1], s_stop = field.at(stop);
      // Monotone from u to stop: knots come in order.
      while (u < stop) {
        const double s = field.at(u);
        const bool up = s_stop >= s;
        const double knot = next_knot(s, u > ends[e] ? last_knot_ : std::nan(""), up);
        const double next = (up ? knot < s_stop : knot > s_stop) ? crossing(field, u, stop, knot) : stop;
        last_knot_ = knot;
        if (next > u) add_smooth(field, u, next, length, z0, z1, ray.length_per_depth, 0);
        if (!(next > u) && next != stop) {  // the crossing is here: past the knot
          u = std::nextafter(u, 2.0);
          continue;
        }
        u = next;
      }
    }
  }

  static void turning_points(const FieldCubic& p, std::array<double, 4>& ends, std::size_t& count) {
    const double a = 3 * p.c[3], b = 2 * p.c[2], c = p.c[1], discriminant = b * b - 4 * a * c;
    if (!(discriminant > 0)) return;
    const double q = -(b + std::copysign(std::sqrt(discriminant), b)) / 2;
    double one = a != 0 ? q / a : -1, other = q != 0 ? c / q : -1;
    if (one > other) std::swap(one, other);
    for (const double u : {one, other})
      if (u > 0 && u < 1) ends[count++] = u;
    ends[count] = 1;
  }

  /// The first knot ahead of s; not the one just crossed. Infinite if there is none.
  [[nodiscard]] double next_knot(double s, double crossed, bool up) const {
    constexpr double none = std::numeric_limits<double>::infinity();
    if (up) {
      const double past = std::isnan(crossed) ? s : std::max(s, crossed);
      const auto k = std::upper_bound(knots_.begin(), knots_.end(), past,
                                      [](double v, const scene::Knot& knot) { return v < knot.value; });
      return k == knots_.end() ? none : k->value;
    }
    const double past = std::isnan(crossed) ? s : std::min(s, crossed);
    const auto k = std::lower_bound(knots_.begin(), knots_.end(), past,
                                    [](const scene::Knot& knot, double v) { return knot.value < v; });
    return k == knots_.begin() ? -none : std::prev(k)->value;
  }

  static double crossing(const FieldCubic& p, double u0, double u1, double value) {
    const bool rising = p.at(u1) > p.at(u0);
    for (int n = 0; n < 60; ++n) {
      const double middle = (u0 + u1) / 2;
      ((p.at(middle) < value) == rising ? u0 : u1) = middle;
    }
    return u1;
  }

  /// A monotone stretch in one interval of the transfer function: halved until a line through its mean is enough.
  void add_smooth(const FieldCubic& p, double u0, double u1, double length, double z0, double z1,
                  double length_per_depth, int halvings) {
    const double s_0 = p.at(u0), s_1 = p.at(u1), middle = p.at((u0 + u1) / 2), e = u1 - u0;
    const auto above =
        static_cast<std::size_t>(std::upper_bound(knots_.begin(), knots_.end(), middle,
                                                  [](double v, const scene::Knot& knot) { return v < knot.value; }) -
                                 knots_.begin());
    double low = -std::numeric_limits<double>::infinity(), high = -low, kappa = 0;
    if (above > 0) low = knots_[above - 1].value, kappa = knots_[above - 1].extinction;
    if (above < knots_.size()) high = knots_[above].value, kappa = std::max(kappa, knots_[above].extinction);
    if (above > 0 && above < knots_.size() && halvings < 12) {
      const scene::Knot &a = knots_[above - 1], &b = knots_[above];
      const double width = b.value - a.value, slope = std::abs(b.extinction - a.extinction) / width;
      const glm::dvec3 change = glm::abs(b.color - a.color) / width;
      const double color_slope = std::max({change.x, change.y, change.z});
      const double color = std::max({a.color.x, a.color.y, a.color.z, b.color.x, b.color.y, b.color.z});
      const double l = e * length, span = std::abs(s_1 - s_0), even = std::abs(middle - (s_0 + s_1) / 2);
      const double odd = std::abs(p.c[3]) * e * e * e, rho = even + odd / 4;
      const double tau = kappa * l, weight = independent_ ? l : tau;
      const double error =
          l * rho * (rho + 0.3 * span) * (0.1 * slope * color_slope + 0.03 * slope * slope * color * l) +
          color_slope * weight * tau * (odd / 120 + tau * even / 90);
      if (error * transmittance_ > line_tolerance) {
        add_smooth(p, u0, (u0 + u1) / 2, length, z0, z1, length_per_depth, halvings + 1);
        add_smooth(p, (u0 + u1) / 2, u1, length, z0, z1, length_per_depth, halvings + 1);
        return;
      }
    }
    // The chord, moved to the mean; kept in the interval, which a step ends.
    const double shift = p.mean(u0, u1) - (s_0 + s_1) / 2, below_high = std::nextafter(high, low);
    const auto kept = [&](double s) { return std::clamp(s + shift, low, below_high); };
    const auto depth = [&](double u) { return u == 0 ? z0 : u == 1 ? z1 : z0 + (z1 - z0) * u; };
    cutter_.cut({depth(u0), depth(u1), kept(s_0), kept(s_1)}, length_per_depth, transmittance_, pieces_);
  }

  /// Whether anything between two values shows.
  [[nodiscard]] bool shows(double low, double high) const {
    const auto lit = [&](const scene::Knot& k) {
      return k.extinction > 0 || (independent_ && std::max({k.color.x, k.color.y, k.color.z}) > 0);
    };
    const auto first = std::upper_bound(knots_.begin(), knots_.end(), low,
                                        [](double v, const scene::Knot& knot) { return v < knot.value; });
    const auto last = std::upper_bound(knots_.begin(), knots_.end(), high,
                                       [](double v, const scene::Knot& knot) { return v < knot.value; });
    return std::any_of(first == knots_.begin() ? first : std::prev(first),
                       last == knots_.end() ? last : std::next(last), lit);
  }

  [[nodiscard]] std::int64_t voxel_along(std::size_t axis, double local) const {
    std::int64_t low = 0, high = geometry_.points[axis] - 1;
    if (!geometry_.rectilinear(axis)) {
      const double place = std::floor(local / geometry_.spacing[static_cast<int>(axis)]);
      return static_cast<std::int64_t>(std::clamp(place, 0.0, static_cast<double>(high - 1)));
    }
    while (high - low > 1) {
      const std::int64_t middle = low + (high - low) / 2;
      (geometry_.lattice(axis, middle) <= local ? low : high) = middle;
    }
    return low;
  }

  const scene::GridGeometry& geometry_;
  BlockReader reader_;
  std::vector<scene::Knot> knots_;
  compositor::PieceCutter cutter_;
  compositor::SegmentIntegrator integrator_;
  bool independent_;
  double accuracy_, left_out_, transmittance_ = 1, last_knot_ = 0;
  std::vector<double> cuts_;
  std::vector<compositor::DeepPiece> pieces_;
  compositor::SegmentBatch batch_;
  std::vector<compositor::DeepSample> samples_;
};

/// Rays of a picture.
class DeepRays {
 public:
  DeepRays(const scene::Camera& camera, scene::ImageSize size, const scene::GridGeometry& geometry)
      : camera_(camera),
        geometry_(geometry),
        basis_(scene::view_basis(camera)),
        to_local_(scene::world_to_local(geometry)),
        perspective_(camera.projection == scene::ProjectionKind::perspective),
        width_(size.width),
        height_(size.height) {
    const double half = perspective_ ? std::tan(camera.view_angle * std::numbers::pi / 360) : camera.parallel_scale;
    pixel_ = 2 * half / size.height;
  }

  [[nodiscard]] DeepRay ray(double x, double y) const {
    const glm::dvec3 off = basis_.right * ((x - 0.5 * width_) * pixel_) + basis_.up * ((0.5 * height_ - y) * pixel_);
    const glm::dvec3 from = perspective_ ? camera_.position : camera_.position + off;
    const glm::dvec3 step = perspective_ ? basis_.forward + off : basis_.forward;
    DeepRay ray{to_local_ * (from - geometry_.origin), to_local_ * step, glm::length(step), 0,
                std::numeric_limits<double>::infinity()};
    if (camera_.clipping_range) {
      ray.begin = std::max(0.0, camera_.clipping_range->near_distance);
      ray.end = camera_.clipping_range->far_distance;
    }
    for (std::size_t a = 0; a < 3; ++a) {
      const int axis = static_cast<int>(a);
      const double low = geometry_.lattice(a, 0), high = geometry_.lattice(a, geometry_.points[a] - 1);
      if (ray.step[axis] == 0) {
        if (ray.origin[axis] < low || ray.origin[axis] >= high) ray.end = ray.begin;
        continue;
      }
      const double one = (low - ray.origin[axis]) / ray.step[axis], other = (high - ray.origin[axis]) / ray.step[axis];
      ray.begin = std::max(ray.begin, std::min(one, other));
      ray.end = std::min(ray.end, std::max(one, other));
    }
    return ray;
  }

 private:
  const scene::Camera& camera_;
  const scene::GridGeometry& geometry_;
  scene::ViewBasis basis_;
  glm::dmat3 to_local_;
  bool perspective_;
  double width_, height_, pixel_;
};

}  // namespace

scene::DeepImage deep_image(const scene::SampleSource& source, const scene::Camera& camera, scene::ImageSize size,
                            const scene::TransferFunction& function, const DeepSettings& settings, int y0, int y1) {
  scene::validate(camera);
  scene::validate(size);
  if (!(settings.accuracy >= 1e-6 && settings.accuracy <= 1))
    throw scene::bad_input(fmt::format("--deep-accuracy {}: it must be 1e-6 to 1", settings.accuracy));
  const DeepRays rays(camera, size, source.geometry());
  compositor::DeepCollector collector(size, settings.memory_bytes / 2);
  tbb::task_arena arena(settings.threads > 0 ? settings.threads : tbb::task_arena::automatic);
  arena.execute([&] {
    tbb::enumerable_thread_specific<std::unique_ptr<DeepPixels>> pixels(
        [&] { return std::make_unique<DeepPixels>(source, function, settings); });
    constexpr int side = 32;
    const int across = (size.width + side - 1) / side, down = (std::max(0, y1 - y0) + side - 1) / side;
    tbb::parallel_for(0, across * down, [&](int tile) {
      projection::PixelRect rect{tile % across * side, y0 + tile / across * side, 0, 0};
      rect.x1 = std::min(rect.x0 + side, size.width), rect.y1 = std::min(rect.y0 + side, y1);
      std::vector<std::uint32_t> counts;
      std::vector<scene::DeepImageSample> samples;
      for (int y = rect.y0; y < rect.y1; ++y)
        for (int x = rect.x0; x < rect.x1; ++x) {
          const std::size_t before = samples.size();
          pixels.local()->add(rays.ray(x + 0.5, y + 0.5), samples);
          counts.push_back(static_cast<std::uint32_t>(samples.size() - before));
        }
      collector.add(rect, std::move(counts), std::move(samples));
    });
  });
  return collector.image();
}

}  // namespace tessera::volume
