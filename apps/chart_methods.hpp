#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "frame/render.hpp"
#include "io/transfer_function_file.hpp"
#include "scene/camera.hpp"
#include "scene/sample_source.hpp"
#include "scene/tet_mesh.hpp"
#include "volume/render.hpp"

/// The methods that `tessera chart` sweeps. A new one is one more entry of chart_methods.cpp's lists.
namespace tessera::apps {

/// What all methods render.
struct ChartScene {
  const scene::TetMeshView* mesh = nullptr;     ///< this
  const scene::SampleSource* volume = nullptr;  ///< or this
  scene::Camera camera;
  scene::ImageSize size;
  scene::TransferFunction function;
  scene::Emission emission = scene::Emission::absorption;
  int threads = 0;
  std::uint64_t memory_bytes = 4ull << 30;
};

/// One way of rendering, ready to be timed: what depends on the mesh or the transfer function alone is prepared.
class ChartRenderer {
 public:
  virtual ~ChartRenderer() = default;
  /// One frame, and the milliseconds it took.
  virtual std::pair<scene::Image, double> frame() = 0;
};

struct ChartMethod {
  std::string family;   ///< one curve of the chart: "planes, sampled"
  std::string name;     ///< "planes sampled:4"
  std::string options;  ///< that make `tessera render` do it
  std::function<std::unique_ptr<ChartRenderer>(const ChartScene&)> make;
  std::string left_out;  ///< why it cannot be had here; empty: it can
  double cost = 1;       ///< its time over the first method's, roughly: whether to try it is decided by that
};

/// The most telling first, so that a short budget leaves out refinements.
std::vector<ChartMethod> chart_methods(const ChartScene& scene);

}  // namespace tessera::apps
