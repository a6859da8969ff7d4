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

/// The methods that `tessera chart` measures. A new method requires an additional entry in the lists of
/// chart_methods.cpp.
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
  std::string family;  ///< name of the method's curve in the chart: "planes, sampled"
  std::string name;    ///< "planes sampled:4"
  Settings settings;
  int ranks = 1;         ///< more than one: threads of this process that communicate like processes
  double cost = 1;       ///< approximate time relative to that of the first method; determines whether the method is
                         ///< tried
  std::string preset;    ///< preset of `render`, if it specifies the whole method
  std::string left_out;  ///< reason why the method is not available here; empty if it is available

  /// Whether the method may be recommended. False if it needs several ranks or switches optimizations off.
  [[nodiscard]] bool recommended() const {
    return ranks == 1 && settings.use == Mechanisms() && settings.integrator.terminates;
  }
};

/// A method that is ready to be timed: everything that depends only on the data or the transfer function has been
/// prepared.
class ChartRenderer {
 public:
  ChartRenderer(const ChartScene& scene, const ChartMethod& method);
  /// Renders a frame. Returns the image and the time in milliseconds.
  std::pair<Image, double> frame();

 private:
  const ChartScene& scene_;
  const ChartMethod& method_;
  std::optional<Session> session_;  ///< used if there is one rank
};

/// Returns the methods, the most informative ones first, so that a short budget omits only refinements.
std::vector<ChartMethod> chart_methods(const ChartScene& scene);

}  // namespace tessera::analysis
