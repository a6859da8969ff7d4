// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <tuple>
#include <utility>
#include <vector>

#include "integrals/segment_integrator.hpp"
#include "projection/lattice/segment_windows.hpp"
#include "projection/pixel_space.hpp"
#include "scene/lattice.hpp"
#include "scene/pixel_rect.hpp"
#include "scene/transfer_function.hpp"

namespace tessera::compositor::tests {

using projection::LatticeSegment;

/// The rays of a small image as lattice segments that are exact in double too, and their composited result in double
/// precision, one segment after the other.
struct RandomRays {
  static constexpr scene::ImageSize size{16, 11};
  static constexpr scene::PixelRect rect{0, 0, 16, 11};
  static constexpr std::size_t pixels = 16 * 11;

  /// One run of touching segments, composited; or the whole ray, if runs are not separated.
  struct Run {
    std::size_t pixel = 0;
    double front = 0, back = 0;  ///< planar depths where the run becomes visible and where its last segment ends
    double red = 0, green = 0, blue = 0, transmittance = 1;
    int showing = 0;  ///< segments with an optical depth
  };

  /// Up to `most` segments per ray, some of them clear, some of length zero, with some gaps.
  RandomRays(std::uint32_t seed, std::size_t most, double extinction, bool perspective)
      : random(seed),
        function(random_function(extinction)),
        integrator(function, {scene::IntegratorKind::exact, 0, 0}, scene::Emission::absorption),
        space(camera(perspective), size),
        rays(pixels) {
    for (std::size_t p = 0; p < pixels; ++p) {
      const std::size_t count = p % 5 == 0 ? most : random() % (most + 1);
      std::int64_t at = -(1 << 29) + static_cast<std::int64_t>(random() % 1000000);
      float scalar = random_scalar();
      for (std::size_t k = 0; k < count; ++k) {
        // Gaps are many steps long, because segments a few lattice steps apart count as touching.
        const bool gap = random() % 8 == 0;
        if (gap) at += 1000 + static_cast<std::int64_t>(random() % 1000000);
        const auto step = static_cast<std::int64_t>((1 << 30) / (static_cast<std::int64_t>(most) + 2));
        const std::int64_t length = random() % 16 == 0 ? 0 : static_cast<std::int64_t>(random()) % step;
        const float next = random() % 6 == 0 ? scalar : random_scalar();
        rays[p].push_back({static_cast<std::int32_t>(at), static_cast<std::int32_t>(at + length),
                           gap ? random_scalar() : scalar, next});
        at += length;
        scalar = next;
      }
      // The order depends only on the keys, so only segments with equal keys may change places. A segment of length
      // zero may have the same front depth as its neighbour.
      std::sort(rays[p].begin(), rays[p].end(), [](const LatticeSegment& a, const LatticeSegment& b) {
        return std::tie(a.front, a.back, a.scalar_front, a.scalar_back) <
               std::tie(b.front, b.back, b.scalar_front, b.scalar_back);
      });
    }
  }

  /// The visible result of a pixel, for each run or for the whole ray. Segments behind a transmittance below `least`
  /// are omitted.
  [[nodiscard]] std::vector<Run> composited(std::size_t pixel, bool runs, double least = 0) const {
    return composited(pixel, rays[pixel], runs, least);
  }
  [[nodiscard]] std::vector<Run> composited(std::size_t pixel, const std::vector<LatticeSegment>& ray, bool runs,
                                            double least) const {
    integrals::SegmentBatch batch;
    batch.reserve(ray.size());
    const double length =
        space.length_per_depth(static_cast<int>(pixel) % size.width + 0.5, static_cast<int>(pixel) / size.width + 0.5);
    for (const LatticeSegment& s : ray) {
      batch.length[batch.size] = (lattice.depth(s.back) - lattice.depth(s.front)) * length;
      batch.scalar_front[batch.size] = lattice.scalar(s.scalar_front);
      batch.scalar_back[batch.size] = lattice.scalar(s.scalar_back);
      ++batch.size;
    }
    integrator.integrate(batch);
    for (std::size_t k = 0; lit && k < ray.size(); ++k) {
      const projection::SegmentLight light = light_of(ray[k]);
      const double shine = light.white * -std::expm1(-batch.optical_depth[k]);
      for (auto* color : {&batch.red, &batch.green, &batch.blue}) (*color)[k] = double{light.own} * (*color)[k] + shine;
    }
    std::vector<Run> made;
    Run run{pixel};
    double transmittance = 1;
    const auto end = [&] {
      if (run.showing > 0) made.push_back(run);
      run = {pixel};
    };
    for (std::size_t k = 0; k < ray.size() && transmittance >= least; ++k) {
      if (runs && k > 0 && ray[k].front != ray[k - 1].back) end();
      if (batch.optical_depth[k] > 0 && run.showing++ == 0)
        run.front = lattice.depth(ray[k].front) +
                    (lattice.depth(ray[k].back) - lattice.depth(ray[k].front)) *
                        integrator.first_visible(batch.scalar_front[k], batch.scalar_back[k]).value_or(0);
      run.back = lattice.depth(ray[k].back);
      run.red += run.transmittance * batch.red[k];
      run.green += run.transmittance * batch.green[k];
      run.blue += run.transmittance * batch.blue[k];
      run.transmittance *= batch.transmittance[k];
      transmittance *= batch.transmittance[k];
    }
    end();
    return made;
  }

  /// Some light for each segment, the same for equal ones.
  [[nodiscard]] static projection::SegmentLight light_of(const LatticeSegment& segment) {
    const auto bits =
        static_cast<std::uint32_t>(segment.front) * 2654435761u ^ static_cast<std::uint32_t>(segment.back);
    return {static_cast<float>(bits & 0xff) / 256, static_cast<float>(bits >> 8 & 0xff) / 1024};
  }

  [[nodiscard]] std::size_t total() const {
    std::size_t sum = 0;
    for (const auto& ray : rays) sum += ray.size();
    return sum;
  }

  std::mt19937 random;
  scene::Lattice lattice{.depth_origin = 4, .depth_unit = 0x1p-29, .scalar_origin = 0.5, .scalar_unit = 0x1p-31};
  scene::TransferFunction function;
  integrals::SegmentIntegrator integrator;
  projection::PixelSpace space;
  std::vector<std::vector<LatticeSegment>> rays;  ///< by pixel, sorted
  bool lit = false;                               ///< by light_of()

 private:
  static scene::Camera camera(bool perspective) {
    scene::Camera camera;
    camera.position = {0, 0, 5};
    camera.parallel_scale = 1;
    if (perspective) camera.projection = ProjectionKind::perspective;
    return camera;
  }
  float random_scalar() { return static_cast<float>(std::uniform_real_distribution<double>(-0x1p30, 0x1p30)(random)); }
  /// A function that is clear below 0.3 and between two higher knots, with a step at 0.6.
  scene::TransferFunction random_function(double extinction) {
    std::uniform_real_distribution<double> uniform(0, 1);
    const auto color = [&] { return glm::dvec3(uniform(random), uniform(random), uniform(random)); };
    return scene::TransferFunction({{0, color(), 0},
                                    {0.3, color(), 0},
                                    {0.45, color(), extinction * uniform(random)},
                                    {0.6, color(), extinction * uniform(random)},
                                    {0.6, color(), extinction},
                                    {0.7, color(), 0},
                                    {0.75, color(), 0},
                                    {1, color(), extinction * uniform(random)}});
  }
};

}  // namespace tessera::compositor::tests
