// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstring>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "scene/camera.hpp"
#include "scene/image.hpp"
#include "scene/sample_source.hpp"
#include "scene/transfer_function.hpp"
#include "volume/render.hpp"

namespace tessera::tests {

inline constexpr scene::ImageSize size{96, 80};

/// A small volume of samples in [0, 1], with access to its values.
struct Volume {
  scene::Grid grid;
  std::vector<float> values;
  std::unique_ptr<scene::MemorySource> source;

  [[nodiscard]] double at(std::int64_t i, std::int64_t j, std::int64_t k) const {
    const scene::GridIndex n = grid.geometry.samples();
    return values[static_cast<std::size_t>(i + n[0] * (j + n[1] * k))];
  }
};

enum class Field { smooth, noise };

inline Volume make_volume(scene::GridIndex samples, Field field, bool cell_data = false) {
  Volume v;
  scene::GridGeometry& g = v.grid.geometry;
  for (std::size_t a = 0; a < 3; ++a) g.points[a] = samples[a] + (cell_data ? 1 : 0);
  g.association = cell_data ? scene::Association::cell : scene::Association::point;
  g.origin = {-1, -0.8, -0.6};
  for (int a = 0; a < 3; ++a)
    g.spacing[a] = -2 * g.origin[a] / static_cast<double>(g.points[static_cast<std::size_t>(a)] - 1);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (std::int64_t k = 0; k < samples[2]; ++k)
    for (std::int64_t j = 0; j < samples[1]; ++j)
      for (std::int64_t i = 0; i < samples[0]; ++i) {
        const double x = double(i) / double(samples[0]), y = double(j) / double(samples[1]),
                     z = double(k) / double(samples[2]);
        v.values.push_back(
            field == Field::noise
                ? uniform(random)
                : static_cast<float>(0.5 + 0.25 * std::sin(9 * x) * std::cos(7 * y + z) + 0.2 * std::cos(8 * z * x)));
      }
  v.source = scene::MemorySource::of(v.grid, v.values);
  return v;
}

inline scene::TransferFunction smooth_function() {
  return scene::TransferFunction({{0.0, {0, 0, 0.3}, 0},
                                  {0.3, {0.1, 0.3, 0.9}, 0.4},
                                  {0.5, {0.2, 0.9, 0.3}, 0},
                                  {0.7, {0.9, 0.8, 0.1}, 3},
                                  {0.8, {1, 0.3, 0}, 0.2},
                                  {1, {1, 1, 1}, 8}});
}

/// Peaks a fiftieth of the range wide, with nothing between them.
inline scene::TransferFunction sharp_function() {
  return scene::TransferFunction({{0.5, {0.1, 0.3, 0.9}, 0},
                                  {0.51, {0.2, 0.9, 0.3}, 60},
                                  {0.52, {0.9, 0.8, 0.1}, 0},
                                  {0.8, {1, 0.3, 0}, 0},
                                  {1, {1, 1, 1}, 40}});
}

inline scene::TransferFunction many_knots() {
  std::vector<scene::Knot> knots;
  for (int n = 0; n <= 100; ++n)
    knots.push_back(
        {n / 100.0, {0.5 + 0.5 * std::sin(n), 0.5, 0.5 + 0.5 * std::cos(0.3 * n)}, 1.5 + 1.5 * std::cos(0.2 * n)});
  return scene::TransferFunction(knots);
}

inline scene::Camera view(const char* name) {
  scene::Camera c;
  c.position = {3.1, 2.3, 4.2};
  c.parallel_scale = 1.4;
  c.view_up = {0, 1, 0};
  const std::string n = name;
  if (n == "from -x") c.position = {-4, 0.3, 0.2};
  if (n == "from y") c.position = {0.5, 4, 0.1}, c.view_up = {0, 0, 1};
  if (n == "along z") c.position = {0, 0, 5};
  if (n == "perspective") c.projection = scene::ProjectionKind::perspective, c.view_angle = 30;
  if (n == "inside") {
    c.projection = scene::ProjectionKind::perspective;
    c.view_angle = 110;
    c.position = {0.1, 0.05, 0.2}, c.focal_point = {-0.5, 0.3, -0.1};
  }
  if (n == "clipped") c.clipping_range = {5.2, 6.1};
  return c;
}
inline constexpr const char* views[] = {"oblique", "from -x", "from y", "along z", "perspective", "inside", "clipped"};

inline scene::Image render(const Volume& v, const scene::Camera& camera, const scene::TransferFunction& function,
                           volume::RenderSettings settings = {}, volume::RenderStatistics* statistics = nullptr) {
  if (settings.threads == 0) settings.threads = 2;
  volume::Frame frame = volume::Renderer(*v.source, settings).render(camera, size, function);
  if (statistics != nullptr) *statistics = frame.statistics;
  return std::move(frame.image);
}

inline volume::RenderSettings exact() {
  volume::RenderSettings s;
  s.integrator.kind = IntegratorKind::exact;
  return s;
}

inline bool same_bits(const scene::Image& a, const scene::Image& b) {
  return a.rgba.size() == b.rgba.size() && std::memcmp(a.rgba.data(), b.rgba.data(), a.rgba.size() * 4) == 0 &&
         std::memcmp(a.depth.data(), b.depth.data(), a.depth.size() * 4) == 0;
}

}  // namespace tessera::tests
