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

/// The methods that `tessera chart` measures. A new one is an additional entry in the lists of chart_methods.cpp.
namespace tessera::analysis {

/// The scene that all methods render.
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
  int ranks = 1;         ///< more than one: threads of this process that communicate like processes
  double cost = 1;       ///< its time relative to the first method's, roughly: decides whether it is tried
  std::string preset;    ///< of `render`, if a preset is the whole method
  std::string left_out;  ///< why it is not available here; empty if it is

  /// Whether to recommend it: not if it needs several ranks, or switches optimizations off.
  [[nodiscard]] bool recommended() const {
    return ranks == 1 && settings.use == Mechanisms() && settings.integrator.terminates;
  }
};

/// A method ready to be timed: everything that depends only on the data or the transfer function is prepared.
class ChartRenderer {
 public:
  ChartRenderer(const ChartScene& scene, const ChartMethod& method);
  /// One frame, and the milliseconds it took.
  std::pair<Image, double> frame();

 private:
  const ChartScene& scene_;
  const ChartMethod& method_;
  std::optional<Session> session_;  ///< for one rank
};

/// The most informative methods first, so that a short budget only omits refinements.
std::vector<ChartMethod> chart_methods(const ChartScene& scene);

}  // namespace tessera::analysis
