// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tessera/dataset.hpp"
#include "tessera/image.hpp"
#include "tessera/session.hpp"
#include "tessera/settings.hpp"
#include "tessera/transfer_function.hpp"
#include "tessera/view.hpp"

/// The methods that `tessera chart` sweeps. A new one is one more entry of chart_methods.cpp's lists.
namespace tessera::analysis {

/// What all methods render.
struct ChartScene {
  Dataset data;
  View view;
  TransferFunction function;
  Emission emission = Emission::absorption;
  int threads = 0;
  std::uint64_t memory_bytes = 4ull << 30;
};

struct ChartMethod {
  std::string family;  ///< one curve of the chart: "planes, sampled"
  std::string name;    ///< "planes sampled:4"
  Settings settings;
  int ranks = 1;         ///< more than one: threads of this process that speak as processes do
  double cost = 1;       ///< its time over the first method's, roughly: whether to try it is decided by that
  std::string preset;    ///< of `render`, if that is all there is to say
  std::string left_out;  ///< why it cannot be had here; empty: it can
  bool by_slices = false;

  /// Whether it is one to recommend: not what needs several ranks, or leaves out what saves work.
  [[nodiscard]] bool recommended() const {
    return ranks == 1 && settings.use == Mechanisms() && settings.integrator.terminates;
  }
};

/// One way of rendering, ready to be timed: what depends on the data or the transfer function alone is prepared.
class ChartRenderer {
 public:
  ChartRenderer(const ChartScene& scene, const ChartMethod& method);
  /// One frame, and the milliseconds it took.
  std::pair<Image, double> frame();

 private:
  const ChartScene& scene_;
  const ChartMethod& method_;
  std::optional<Session> session_;  ///< of one rank
};

/// The most telling first, so that a short budget leaves out refinements.
std::vector<ChartMethod> chart_methods(const ChartScene& scene);

}  // namespace tessera::analysis
