// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/chart_sweep.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "tessera/error.hpp"

namespace tessera::analysis {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// Estimates a method's time before it is tried, from the last method of its family or, if there is none, from the last
/// method of the first family.
class CostGuess {
 public:
  [[nodiscard]] double seconds(const ChartMethod& method) const {
    const auto known = families_.find(method.family);
    if (known != families_.end()) return method.cost * known->second;
    return families_.empty() ? 0 : method.cost * families_.at(first_);
  }
  void learn(const ChartMethod& method, double seconds) {
    if (families_.empty()) first_ = method.family;
    families_[method.family] = seconds / method.cost;
  }

 private:
  std::map<std::string, double> families_;  ///< for each family: time of preparation and one frame, divided by `cost`
  std::string first_;
};

}  // namespace

ChartTruth chart_truth(const ChartScene& scene, double seconds, std::optional<std::size_t> asked) {
  const auto start = Clock::now();
  Settings settings;
  settings.emission = scene.emission;
  const Reference reference(scene.data, scene.view, scene.function, settings);
  constexpr std::uint64_t seed = 1;
  const auto total = static_cast<std::size_t>(scene.view.size.width) * static_cast<std::size_t>(scene.view.size.height);
  ChartTruth truth;
  const auto look = [&](std::size_t count) {
    truth.pixels = random_pixels(scene.view.size, count, seed);
    const auto begin = Clock::now();
    truth.values = reference.pixels(truth.pixels, scene.threads);
    return seconds_since(begin);
  };
  if (asked) {
    look(*asked);
  } else {
    // Pilots of increasing size are rendered until one is large enough to measure the cost per pixel. Because of passes
    // over the whole mesh, a few pixels take as long as many.
    std::size_t count = std::min<std::size_t>(total, 256);
    for (;;) {
      const double took = look(count);
      const double left = seconds - seconds_since(start);
      if (count == total || took * 2.5 > left) break;
      const double next = static_cast<double>(count) * std::clamp(0.6 * left / std::max(took, 1e-6), 2.0, 16.0);
      count = std::min(total, static_cast<std::size_t>(next));
    }
  }
  truth.whole_image = truth.pixels.size() == total;
  truth.seconds = seconds_since(start);
  return truth;
}

ChartSweep sweep(const ChartScene& scene, const std::vector<ChartMethod>& methods, const ChartTruth& truth,
                 const ChartBudget& budget, const std::function<void(const ChartPoint&)>& measured) {
  ChartSweep out;
  CostGuess guess;
  auto waiting = static_cast<double>(
      std::count_if(methods.begin(), methods.end(), [](const ChartMethod& m) { return m.left_out.empty(); }));
  for (const ChartMethod& method : methods) {
    ChartPoint point;
    point.family = method.family, point.name = method.name;
    point.left_out = method.left_out;
    const double left = budget.seconds - seconds_since(budget.begin);
    double share = 0;
    if (point.left_out.empty()) {
      share = left / waiting--;
      if (guess.seconds(method) > 0 && guess.seconds(method) > left) {
        point.left_out = no_room;
        out.missing_seconds += guess.seconds(method);
      }
    }
    if (point.left_out.empty()) {
      const auto start = Clock::now();
      try {
        ChartRenderer renderer(scene, method);
        point.prepare_ms = 1000 * seconds_since(start);
        for (int i = 0; i < budget.repeat; ++i) {
          auto [image, ms] = renderer.frame();
          point.frame_ms.push_back(ms);
          if (i == 0) {
            guess.learn(method, seconds_since(start));
            point.error = chart_error(image, truth.pixels, truth.values);
          }
          if (seconds_since(start) + ms / 1000 > share) break;
        }
      } catch (const Error& error) {
        point.left_out = error.what();
        point.frame_ms.clear();
      }
      if (point.measured()) measured(point);
    }
    out.points.push_back(std::move(point));
  }
  return out;
}

}  // namespace tessera::analysis
