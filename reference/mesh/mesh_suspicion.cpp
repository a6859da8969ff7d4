// SPDX-License-Identifier: BSD-3-Clause
#include "reference/mesh/mesh_suspicion.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "reference/light_error.hpp"
#include "reference/mesh/edge_walk.hpp"
#include "reference/view.hpp"
#include "scene/threads.hpp"

namespace tessera::reference {
namespace {

constexpr double quantum = 0x1p-30;  // assumed rounding of a renderer, relative to the range
constexpr double nothing = 1e-12;    // lower scores are ignored
/// Largest number of tets that are examined, and of examined tets whose edges are examined, too.
constexpr std::size_t most_tets = 1 << 18, most_tets_with_edges = 1 << 16;

/// In each cell, one of `pixels_per_mark` pixels is marked, but not more than `most_marks` pixels.
constexpr double pixels_per_mark = 32, most_marks = 64;

class MeshSuspects {
 public:
  MeshSuspects(const scene::TetMeshView& mesh, const scene::Camera& camera, const scene::TransferFunction& function,
               scene::Emission emission, const scene::Image& image, const SuspicionMap& edge)
      : mesh_(mesh), image_(image), edge_(edge), view_(camera, image.size), light_(function, emission, noise(mesh)) {
    const std::size_t pixels = image.depth.size();
    for (SuspicionMap* map : {&found_.step, &found_.tie, &found_.depth}) map->assign(pixels, 0.0f);
    const scene::Box box = scene::bounds(mesh);
    double near = std::numeric_limits<double>::infinity(), far = 0;
    for (int corner = 0; corner < 8 && !box.empty(); ++corner) {
      const glm::dvec3 p(corner & 1 ? box.low.x : box.high.x, corner & 2 ? box.low.y : box.high.y,
                         corner & 4 ? box.low.z : box.high.z);
      const double depth = view_.project(p).depth;
      near = std::min(near, depth), far = std::max(far, std::min(depth, view_.farthest()));
    }
    // Perspective renderers round 1/depth. If the eye is within the mesh, the position of the near plane is arbitrary,
    // so a thousandth of the far depth is used.
    near = std::max({near, view_.nearest(), 1e-3 * far});
    if (near < far) depth_quantum_ = quantum * (view_.perspective() ? 1 / near - 1 / far : far - near);
  }

  [[nodiscard]] std::size_t examined() const { return std::min(mesh_.tets.size(), most_tets); }

  /// Examines the n-th selected tet.
  void examine_nth(std::size_t n) {
    const std::size_t all = mesh_.tets.size();
    const bool edges = hashed(n, 21) * static_cast<double>(examined()) < static_cast<double>(most_tets_with_edges);
    if (all <= most_tets) return examine(n, edges);
    const double place = static_cast<double>(n) + hashed(n, 20);
    examine(
        std::min(all - 1, static_cast<std::size_t>(place * static_cast<double>(all) / static_cast<double>(most_tets))),
        edges);
  }

  MeshSuspicion take() { return std::move(found_); }

 private:
  void examine(std::size_t tet, bool edges) {
    std::array<ProjectedVertex, 4> v;
    std::array<double, 4> scalars{};
    const bool cell_data = mesh_.association == scene::Association::cell;
    double low_x = 1e300, low_y = 1e300, high_x = -1e300, high_y = -1e300;
    glm::dvec3 centre(0);
    double depth = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      v[i] = view_.project(mesh_.positions[mesh_.tets[tet][i]]);
      scalars[i] = mesh_.scalars[cell_data ? tet : mesh_.tets[tet][i]];
      const glm::dvec3& h = v[i].homogeneous;
      centre += h / 4.0;
      depth += v[i].depth / 4;
      if (!(h.z > 0)) continue;
      low_x = std::min(low_x, h.x / h.z), high_x = std::max(high_x, h.x / h.z);
      low_y = std::min(low_y, h.y / h.z), high_y = std::max(high_y, h.y / h.z);
    }
    if (!(high_x > 0 && high_y > 0 && low_x < image_.size.width && low_y < image_.size.height)) return;
    for (std::size_t i = 0; i < 4 && edges; ++i)
      for (std::size_t j = i + 1; j < 4; ++j)
        raise_ties(v[i].homogeneous, v[j].homogeneous, image_.size, edge_, found_.tie);
    const auto [low, high] = std::minmax_element(scalars.begin(), scalars.end());
    const double dense = light_.densest(*low, *high);
    if (!(dense > 0)) return;
    const auto [near, far] = std::minmax_element(
        v.begin(), v.end(), [](const ProjectedVertex& a, const ProjectedVertex& b) { return a.depth < b.depth; });
    const double by_step = light_.per_length(scalars) * (far->depth - near->depth);
    const double by_depth = dense * depth_quantum_ * (view_.perspective() ? depth * depth : 1);
    if (by_step < nothing && by_depth < nothing) return;
    const double width = std::min<double>(image_.size.width, high_x) - std::max(0.0, low_x);
    const double height = std::min<double>(image_.size.height, high_y) - std::max(0.0, low_y);
    const auto marks = static_cast<int>(std::clamp(width * height / pixels_per_mark, 1.0, most_marks));
    mark(centre, by_step, by_depth);
    for (int n = 1; n < marks; ++n) {
      std::array<double, 4> weight{};
      double sum = 0;
      const auto bits = static_cast<std::uint64_t>(0x1p52 * hashed(tet * 64 + static_cast<std::size_t>(n), 10));
      for (std::size_t i = 0; i < 4; ++i) sum += weight[i] = static_cast<double>((bits >> 13 * i & 0x1fff) + 1);
      glm::dvec3 place(0);
      for (std::size_t i = 0; i < 4; ++i) place += v[i].homogeneous * (weight[i] / sum);
      mark(place, by_step, by_depth);
    }
  }

  static double noise(const scene::TetMeshView& mesh) {
    const std::array<double, 2> range = scene::scalar_range(mesh);
    return std::max(quantum * (range[1] - range[0]), 0x1p-50 * std::max(std::abs(range[0]), std::abs(range[1]))) +
           std::numeric_limits<double>::min();
  }

  void mark(const glm::dvec3& place, double by_step, double by_depth) {
    const double x = place.x / place.z, y = place.y / place.z;
    if (!(place.z > 0 && x >= 0 && y >= 0 && x < image_.size.width && y < image_.size.height)) return;
    const std::size_t pixel = image_.index(static_cast<int>(x), static_cast<int>(y));
    // Scores are weighted by the light that is transmitted through the pixel. A step also counts in an opaque pixel
    // (0.1), because it may be visible in front of the opaque part.
    const double through = 1 - std::clamp<double>(image_.rgba[4 * pixel + 3], 0, 1);
    const double along = view_.length_per_depth(x, y);
    if (by_step >= nothing)
      raise(found_.step[pixel], static_cast<float>(std::min(1.0, by_step * along) * (through + 0.1)));
    raise(found_.depth[pixel], static_cast<float>(std::min(1.0, by_depth * along) * (through + 0.001)));
  }

  scene::TetMeshView mesh_;
  const scene::Image& image_;
  const SuspicionMap& edge_;
  View view_;
  LightError light_;
  double depth_quantum_ = 0;
  MeshSuspicion found_;
};

}  // namespace

MeshSuspicion suspect(const scene::TetMeshView& mesh, const scene::Camera& camera,
                      const scene::TransferFunction& transfer_function, scene::Emission emission,
                      const scene::Image& image, const SuspicionMap& edge, int threads) {
  MeshSuspects suspects(mesh, camera, transfer_function, emission, image, edge);
  tbb::task_arena arena(scene::threads_for(threads));
  arena.execute(
      [&] { tbb::parallel_for(std::size_t{0}, suspects.examined(), [&](std::size_t n) { suspects.examine_nth(n); }); });
  return suspects.take();
}

}  // namespace tessera::reference
