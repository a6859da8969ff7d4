// SPDX-License-Identifier: BSD-3-Clause
#include "reference/grid/grid_suspicion.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>

#include "reference/light_error.hpp"
#include "reference/mesh/edge_walk.hpp"
#include "reference/view.hpp"
#include "scene/threads.hpp"

namespace tessera::reference {
namespace {

constexpr std::int64_t side = 8, most_blocks = 8192;
constexpr double nothing = 1e-12;
/// The fraction 1 / `pixels_per_mark` of a voxel's pixels is marked, at most `most_marks` pixels. Boundaries may be
/// small and have more marks.
constexpr double pixels_per_mark = 16, border_pixels_per_mark = 4, most_marks = 16;
/// Distance along a ray, in voxel sizes, behind the first visible sample within which nothing counts as hidden.
constexpr double skin = 4;

/// Range of the samples that are not blank, and whether any sample is blank.
struct Values {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  bool blank = false;

  void add(double s) {
    if (std::isfinite(s))
      low = std::min(low, s), high = std::max(high, s);
    else
      blank = true;
  }
};

class GridSuspects {
 public:
  GridSuspects(const scene::SampleSource& source, const scene::Camera& camera, const scene::TransferFunction& function,
               scene::Emission emission, const scene::Image& image, const SuspicionMap& edge)
      : source_(source),
        grid_(source.grid()),
        geometry_(source.geometry()),
        image_(image),
        edge_(edge),
        view_(camera, image.size),
        voxels_(geometry_.voxels()),
        light_(function, emission, noise(function)) {
    for (SuspicionMap* map : {&found_.step, &found_.border, &found_.tie}) map->assign(image.depth.size(), 0.0f);
    for (std::size_t a = 0; a < 3; ++a) blocks_[a] = (voxels_[a] + side - 1) / side;
  }

  [[nodiscard]] std::int64_t blocks() const { return std::min(all_blocks(), most_blocks); }

  /// Examines the n-th selected block.
  void examine(std::int64_t n) {
    const std::int64_t all = all_blocks();
    const double spread = all > most_blocks ? hashed(static_cast<std::uint64_t>(n), 20) : 0;
    const auto block = static_cast<std::int64_t>((static_cast<double>(n) + spread) * static_cast<double>(all) /
                                                 static_cast<double>(blocks()));
    const scene::GridIndex place{block % blocks_[0], block / blocks_[0] % blocks_[1], block / blocks_[0] / blocks_[1]};
    const scene::GridIndex samples = geometry_.samples();
    const bool cell_data = geometry_.association == scene::Association::cell;
    scene::SampleBox box;
    for (std::size_t a = 0; a < 3; ++a) {
      // The box has one more sample per axis. Cell data also need it, because a boundary is between two voxels.
      box.low[a] = place[a] * side;
      box.high[a] = std::min(samples[a], box.low[a] + side + 1);
    }
    std::array<double, (side + 1) * (side + 1) * (side + 1)> buffer;
    const std::span<double> values(buffer.data(), static_cast<std::size_t>(box.count()));
    source_.read(box, values);
    Values all_values;
    for (double& s : values) all_values.add(s = grid_.value(s));
    if (!(all_values.low <= all_values.high) || !(light_.densest(all_values.low, all_values.high) > 0)) return;
    if (!all_values.blank && light_.most_per_length(all_values.low, all_values.high) * longest() < nothing) return;
    for (std::int64_t k = box.low[2]; k < std::min(voxels_[2], place[2] * side + side); ++k)
      for (std::int64_t j = box.low[1]; j < std::min(voxels_[1], place[1] * side + side); ++j)
        for (std::int64_t i = box.low[0]; i < std::min(voxels_[0], place[0] * side + side); ++i)
          examine_voxel({i, j, k}, box, values, cell_data);
  }

  void find_ties() {
    const auto corner = [&](int n) {
      glm::dvec3 index;
      for (int a = 0; a < 3; ++a)
        index[a] = (n >> a & 1) != 0 ? static_cast<double>(voxels_[static_cast<std::size_t>(a)]) : 0;
      return view_.project(scene::world_of_index(geometry_, index)).homogeneous;
    };
    for (int n = 0; n < 8; ++n)
      for (int a = 0; a < 3; ++a)
        if ((n >> a & 1) == 0) raise_ties(corner(n), corner(n | 1 << a), image_.size, edge_, found_.tie);
    const glm::dmat3 to_local = scene::world_to_local(geometry_);
    const double far = farthest();
    // All orthographic rays have the same direction. Usually it is not along a lattice plane, so that there are no
    // ties.
    const glm::dvec3 direction = to_local * view_.ray(0, 0).step;
    const auto strays = [&](std::size_t a) { return std::abs(direction[static_cast<int>(a)]) * far / voxel(a); };
    if (!view_.perspective() && std::min({strays(0), strays(1), strays(2)}) > tying_distance) return;
    tbb::parallel_for(0, image_.size.height, [&](int y) {
      for (int x = 0; x < image_.size.width; ++x) {
        const View::Ray ray = view_.ray(x + 0.5, y + 0.5);
        const glm::dvec3 origin = to_local * (ray.origin - geometry_.origin), step = to_local * ray.step;
        for (std::size_t a = 0; a < 3; ++a)
          raise_planes(x, y, a, origin[static_cast<int>(a)], step[static_cast<int>(a)], far);
      }
    });
  }

  GridSuspicion take() { return std::move(found_); }

 private:
  [[nodiscard]] double noise(const scene::TransferFunction& function) const {
    double largest = 0;
    for (const scene::Knot& knot : function.knots()) largest = std::max(largest, std::abs(knot.value));
    return 0x1p-23 * largest + std::numeric_limits<double>::min();
  }
  [[nodiscard]] std::int64_t all_blocks() const { return blocks_[0] * blocks_[1] * blocks_[2]; }

  /// Returns the mean side of a voxel along an axis, in world units.
  [[nodiscard]] double voxel(std::size_t a) const {
    return (geometry_.lattice(a, voxels_[a]) - geometry_.lattice(a, 0)) / static_cast<double>(voxels_[a]);
  }
  [[nodiscard]] double longest() const { return std::hypot(voxel(0), voxel(1), voxel(2)); }

  [[nodiscard]] double farthest() const {
    double far = 0;
    for (int n = 0; n < 8; ++n) {
      glm::dvec3 index;
      for (int a = 0; a < 3; ++a)
        index[a] = (n >> a & 1) != 0 ? static_cast<double>(voxels_[static_cast<std::size_t>(a)]) : 0;
      far = std::max(far, std::abs(view_.project(scene::world_of_index(geometry_, index)).depth));
    }
    return far;
  }

  /// Raises the scores of a ray along the planes of an axis, close to one of the planes.
  void raise_planes(int x, int y, std::size_t a, double origin, double step, double far) {
    const double along = std::abs(step) * far / voxel(a);  // distance, in voxels, between the ray and the plane
    if (!(along < tying_distance)) return;
    std::int64_t low = 0, high = voxels_[a];
    while (high - low > 1) {
      const std::int64_t middle = low + (high - low) / 2;
      (geometry_.lattice(a, middle) <= origin ? low : high) = middle;
    }
    const double away =
        std::min(std::abs(origin - geometry_.lattice(a, low)), std::abs(origin - geometry_.lattice(a, high))) /
        voxel(a);
    if (!(away <= tying_distance)) return;
    const std::size_t pixel = image_.index(x, y);
    raise(found_.tie[pixel], nearness(std::max(away, along)) * (edge_[pixel] + 1e-6f));
  }

  void examine_voxel(const scene::GridIndex& voxel, const scene::SampleBox& box, std::span<const double> values,
                     bool cell_data) {
    std::array<double, 8> corner{};
    std::size_t finite = 0;
    Values around;
    for (int n = 0; n < 8; ++n) {
      std::array<std::int64_t, 3> at{};
      for (std::size_t a = 0; a < 3; ++a) at[a] = std::min(voxel[a] + (n >> a & 1), box.high[a] - 1) - box.low[a];
      const double s = values[static_cast<std::size_t>(at[0] + box.extent(0) * (at[1] + box.extent(1) * at[2]))];
      around.add(s);
      if (std::isfinite(s) && (n == 0 || !cell_data)) corner[finite++] = s;
    }
    if (!(around.low <= around.high)) return;
    const double dense = light_.densest(around.low, around.high);
    if (!(dense > 0)) return;
    const double by_border = around.blank ? dense : 0;
    const double by_step = finite == (cell_data ? 1 : 8) ? light_.per_length(std::span(corner).first(finite)) : 0;
    if (by_border == 0 && by_step * longest() < nothing) return;
    mark(voxel, by_border, by_step);
  }

  void mark(const scene::GridIndex& voxel, double by_border, double by_step) {
    const glm::dvec3 low(static_cast<double>(voxel[0]), static_cast<double>(voxel[1]), static_cast<double>(voxel[2]));
    const double length = longest();
    const std::size_t key = static_cast<std::size_t>(voxel[0] + voxels_[0] * (voxel[1] + voxels_[1] * voxel[2]));
    int marks = 1;
    for (int n = 0; n < marks; ++n) {
      glm::dvec3 within(0.5);
      if (n > 0)
        for (int a = 0; a < 3; ++a)
          within[a] = hashed(key * 16 + static_cast<std::size_t>(n), 30 + static_cast<std::size_t>(a));
      const ProjectedVertex p = view_.project(scene::world_of_index(geometry_, low + within));
      const double x = p.homogeneous.x / p.homogeneous.z, y = p.homogeneous.y / p.homogeneous.z;
      if (!(p.depth > 0 && x >= 0 && y >= 0 && x < image_.size.width && y < image_.size.height)) return;
      const std::size_t pixel = image_.index(static_cast<int>(x), static_cast<int>(y));
      const double through = 1 - std::clamp<double>(image_.rgba[4 * pixel + 3], 0, 1);
      const double seen = p.depth <= image_.depth[pixel] + skin * length ? 1 : through + 1e-4;
      const auto score = [&](double error) { return static_cast<float>(std::min(1.0, error * length) * seen); };
      if (by_border > 0) raise(found_.border[pixel], score(by_border));
      if (by_step > 0) raise(found_.step[pixel], score(by_step));
      if (n > 0) continue;
      const ProjectedVertex q = view_.project(scene::world_of_index(geometry_, low + within + glm::dvec3(0.5)));
      const double across =
          2 * std::hypot(q.homogeneous.x / q.homogeneous.z - x, q.homogeneous.y / q.homogeneous.z - y);
      marks = static_cast<int>(
          std::clamp(across * across / (by_border > 0 ? border_pixels_per_mark : pixels_per_mark), 1.0, most_marks));
    }
  }

  const scene::SampleSource& source_;
  const scene::Grid& grid_;
  const scene::GridGeometry& geometry_;
  const scene::Image& image_;
  const SuspicionMap& edge_;
  View view_;
  scene::GridIndex voxels_;
  LightError light_;
  scene::GridIndex blocks_{};
  GridSuspicion found_;
};

}  // namespace

GridSuspicion suspect(const scene::SampleSource& source, const scene::Camera& camera,
                      const scene::TransferFunction& transfer_function, scene::Emission emission,
                      const scene::Image& image, const SuspicionMap& edge, int threads) {
  GridSuspects suspects(source, camera, transfer_function, emission, image, edge);
  tbb::task_arena arena(scene::threads_for(threads));
  arena.execute([&] {
    tbb::parallel_for(std::int64_t{0}, suspects.blocks(), [&](std::int64_t block) { suspects.examine(block); });
    suspects.find_ties();
  });
  return suspects.take();
}

}  // namespace tessera::reference
