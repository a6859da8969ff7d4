// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/chart_methods.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tessera::analysis {
namespace {

/// Collects the methods of one scene.
class MethodList {
 public:
  explicit MethodList(const ChartScene& scene) : scene_(scene) {}

  /// Adds a method, to be completed by the caller.
  ChartMethod& add(std::string family, std::string name, double cost, const Integrator& integrator) {
    ChartMethod& method = methods_.emplace_back();
    method.family = std::move(family), method.name = std::move(name), method.cost = cost;
    method.settings.integrator = integrator;
    method.settings.use.termination = integrator.terminates;
    method.settings.emission = scene_.emission;
    method.settings.threads = scene_.threads;
    method.settings.memory_bytes = scene_.memory_bytes;
    return method;
  }
  std::vector<ChartMethod> take() { return std::move(methods_); }

 protected:
  const ChartScene& scene_;

 private:
  std::vector<ChartMethod> methods_;
};

class MeshMethods final : public MethodList {
 public:
  using MethodList::MethodList;

  ChartMethod& rasterized(Rasterizer rasterizer, const char* family, const std::string& word,
                          const Integrator& integrator) {
    const bool planes = rasterizer == Rasterizer::planes;
    const char* const prefix = planes ? "planes" : "scanline";
    // Methods that cannot use the lattice take about three times as long (docs/ACCURACY.md), and even longer with more
    // samples.
    const bool fast =
        planes && (integrator.kind == IntegratorKind::automatic || integrator.kind == IntegratorKind::exact);
    const double cost = fast ? 1 : integrator.kind == IntegratorKind::sampled ? 3 + integrator.samples / 4.0 : 4;
    ChartMethod& method =
        add(fmt::format("{}, {}", prefix, family), fmt::format("{} {}", prefix, word), cost, integrator);
    method.settings.mesh.rasterizer = rasterizer;
    if (!planes && scene_.view.camera.projection != ProjectionKind::orthographic)
      method.left_out = "scanline takes orthographic views only";
    if (integrator.kind == IntegratorKind::partial && scene_.emission == Emission::independent)
      method.left_out = "partial supports only emission proportional to extinction";
    return method;
  }
  ChartMethod& plain(Rasterizer rasterizer, IntegratorKind kind, const char* word) {
    return rasterized(rasterizer, word, word, {.kind = kind});
  }
  void sampled(Rasterizer rasterizer, int n) {
    rasterized(rasterizer, "sampled", fmt::format("sampled:{}", n), {.kind = IntegratorKind::sampled, .samples = n});
  }
  void table(Rasterizer rasterizer, int n) {
    rasterized(rasterizer, "preintegrated", fmt::format("preintegrated:{}", n),
               {.kind = IntegratorKind::preintegrated, .table_size = n});
  }
  void automatic(double accuracy) {
    rasterized(Rasterizer::planes, "auto", fmt::format("auto {:g}", accuracy),
               {.kind = IntegratorKind::automatic, .accuracy = accuracy});
  }
  void on_ranks(Exchange exchange, const char* word) {
    ChartMethod& method = add("two ranks, random cells", fmt::format("exchange {}", word), 2.5, {});
    method.ranks = 2;
    method.settings.threads = 1;
    method.settings.ranks.exchange = exchange;
    method.settings.ranks.partition.kind = PartitionKind::random;  // the worst case for exchanging runs
  }
  void device(GlMethod gl, bool half, const Integrator& integrator) {
    const bool compute = gl == GlMethod::compute;
    const char* const family = compute ? "gl-compute" : "gl-fragment";
    const char* const name = compute ? "gl-compute exact"
                             : half  ? "gl-fragment half sampled:4"
                                     : "gl-fragment float sampled:4";
    ChartMethod& method = add(family, name, 30, integrator);
    method.settings.mesh.device.backends = {Backend::osmesa};
    method.settings.mesh.device.method = gl;
    method.settings.mesh.device.half = half;
  }
  /// Adds the method of `render --preset juliachs-2007`, in one process.
  void juliachs_2007() {
    ChartMethod& method = rasterized(Rasterizer::scanline, "juliachs-2007", "juliachs-2007",
                                     {.kind = IntegratorKind::sampled, .samples = 4});
    method.family = method.name = method.preset = "juliachs-2007";
    method.cost = 30;
    method.settings.mesh.device.backends = {Backend::osmesa};
    method.settings.mesh.device.method = GlMethod::fragment;
    method.settings.mesh.device.half = true;
    const ImageSize size = scene_.view.size;
    method.settings.mesh.tile_size = std::min((std::max(size.width, size.height) + 15) / 16, 1024);
  }
};

std::vector<ChartMethod> mesh_methods(const ChartScene& scene) {
  MeshMethods list(scene);
  using enum Rasterizer;
  for (const double accuracy : {1e-4, 1e-2, 1e-3, 1e-5}) list.automatic(accuracy);
  list.plain(planes, IntegratorKind::exact, "exact");
  list.juliachs_2007();
  for (const int n : {1, 4}) list.sampled(planes, n);
  list.table(planes, 128);
  list.plain(planes, IntegratorKind::partial, "partial");
  list.sampled(scanline, 4);
  list.table(scanline, 128);
  ChartMethod& in_double =
      list.rasterized(planes, "exact in double", "exact in double", {.kind = IntegratorKind::exact});
  in_double.settings.use.lattice = false;
  in_double.cost = 3;
  list.rasterized(planes, "exact, no termination", "exact, no termination",
                  {.kind = IntegratorKind::exact, .terminates = false});
  for (const int n : {2, 8}) list.sampled(planes, n);
  list.plain(scanline, IntegratorKind::exact, "exact");
  list.table(planes, 32), list.table(planes, 64);
  list.on_ranks(Exchange::runs, "runs"), list.on_ranks(Exchange::segments, "segments");
  for (const int n : {1, 2, 8}) list.sampled(scanline, n);
  for (const int n : {16, 32}) list.sampled(planes, n);
  const Integrator four{.kind = IntegratorKind::sampled, .samples = 4};
  list.device(GlMethod::compute, true, {.kind = IntegratorKind::exact});
  list.device(GlMethod::fragment, false, four);
  list.device(GlMethod::fragment, true, four);
  return list.take();
}

std::vector<ChartMethod> grid_methods(const ChartScene& scene) {
  MethodList list(scene);
  const auto automatic = [&](double accuracy) {
    list.add("auto", fmt::format("auto {:g}", accuracy), 1, {.kind = IntegratorKind::automatic, .accuracy = accuracy});
  };
  const auto stepped = [&](double step) {
    if (scene.data.grid_geometry().rectilinear()) return;
    list.add("sampled", fmt::format("sampled, step {:g}", step), 1.5 / step, {.kind = IntegratorKind::sampled})
        .settings.grid.step = step;
    list.add("preintegrated", fmt::format("preintegrated, step {:g}", step), 3 / step,
             {.kind = IntegratorKind::preintegrated})
        .settings.grid.step = step;
  };
  for (const double accuracy : {1e-4, 1e-2, 1e-3, 1e-5}) automatic(accuracy);
  stepped(1);
  list.add("exact", "exact", 1.5, {.kind = IntegratorKind::exact});
  list.add("no termination", "auto 0.0001, no termination", 1.5,
           {.kind = IntegratorKind::automatic, .accuracy = 1e-4, .terminates = false});
  for (const double step : {2.0, 0.5, 4.0, 0.25, 0.125}) stepped(step);
  return list.take();
}

}  // namespace

ChartRenderer::ChartRenderer(const ChartScene& scene, const ChartMethod& method) : scene_(scene), method_(method) {
  if (method.ranks > 1) return;
  session_.emplace(scene.data, method.settings);
  // The session of a mesh builds the tables of the transfer function in its first frame and keeps them.
  if (scene.data.is_mesh() && method.settings.mesh.device.backends.empty())
    session_->render({scene.view.camera, {1, 1}}, scene.function);
}

std::pair<Image, double> ChartRenderer::frame() {
  RenderedFrame frame;
  if (session_) {
    frame = session_->render(scene_.view, scene_.function);
  } else {
    run_ranks(method_.ranks, [&](const Communicator& communicator) {
      Session session(scene_.data, method_.settings, communicator);
      RenderedFrame of_rank = session.render(scene_.view, scene_.function);
      if (session.assembles()) frame = std::move(of_rank);
    });
  }
  return {std::move(frame.image), frame.statistics.milliseconds};
}

std::vector<ChartMethod> chart_methods(const ChartScene& scene) {
  return scene.data.is_mesh() ? mesh_methods(scene) : grid_methods(scene);
}

}  // namespace tessera::analysis
