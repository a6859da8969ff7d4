// SPDX-License-Identifier: BSD-3-Clause
#include "compositor/gl/gl_fallback.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace tessera::compositor {

std::vector<GlLight> composite_on_cpu(const GlFragments& fragments, const GlRules& rules,
                                      const integrals::SegmentIntegrator& integrator, const scene::Lattice& units) {
  integrals::SegmentBatch batch;
  batch.size = fragments.values.size();
  batch.reserve(batch.size);
  for (std::size_t i = 0; i < batch.size; ++i) {
    const auto& [length, front, back, mark] = fragments.values[i];
    const bool run = mark >= 0;
    batch.length[i] = run ? 0 : double{length} * units.depth_unit;
    batch.scalar_front[i] = run ? 0 : units.scalar(front);
    batch.scalar_back[i] = run ? 0 : units.scalar(back);
  }
  integrator.integrate(batch);

  std::vector<sorting::GlKey> keys = fragments.keys;
  std::vector<GlLight> lights;
  for (const GlFragments::List& list : fragments.lists) {
    const auto first = keys.begin() + list.begin, last = first + list.count;
    const auto key = [](const sorting::GlKey& k) { return std::tie(k.front, k.back, k.tie, k.element); };
    std::sort(first, last, [&](const auto& a, const auto& b) { return key(a) < key(b); });
    double red = 0, green = 0, blue = 0, optical_depth = 0;
    GlLight light{0, 0, 0, 0, GlLight::no_fragment, 0, 0, 0};
    for (auto k = first; k != last; ++k) {
      const std::size_t i = k->element;
      const auto& value = fragments.values[i];
      const bool run = value[3] >= 0;
      const double transmittance = std::exp(-optical_depth);
      if (transmittance < double{rules.least_transmittance}) break;
      red += transmittance * (run ? double{value[0]} : batch.red[i]);
      green += transmittance * (run ? double{value[1]} : batch.green[i]);
      blue += transmittance * (run ? double{value[2]} : batch.blue[i]);
      const double depth = run ? double{value[3]} : batch.optical_depth[i];
      if (depth > 0 && light.first == GlLight::no_fragment) light.first = k->element;
      optical_depth += depth;
    }
    light.red = static_cast<float>(red);
    light.green = static_cast<float>(green);
    light.blue = static_cast<float>(blue);
    light.optical_depth = static_cast<float>(optical_depth);
    lights.push_back(light);
  }
  return lights;
}

}  // namespace tessera::compositor
