#include "apps/chart_methods.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <glm/geometric.hpp>
#include <numeric>

#include "exchange/loopback_transport.hpp"
#include "frame/dataset.hpp"
#include "frame/distributed.hpp"
#include "projection/scanline_rasterizer.hpp"
#include "scene/mesh_facts.hpp"

namespace tessera::apps {
namespace {

using Clock = std::chrono::steady_clock;
using scene::IntegratorKind;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// A mesh's or a volume's renderer, in this process alone.
template <class Renderer>
class LocalRenderer final : public ChartRenderer {
 public:
  template <class Data, class Settings>
  LocalRenderer(const ChartScene& scene, const Data& data, const Settings& settings)
      : scene_(scene), renderer_(data, settings) {
    // Makes the tables of the transfer function, which a mesh's renderer keeps.
    if (scene.mesh != nullptr) renderer_.render(scene_.camera, {1, 1}, scene_.function);
  }
  std::pair<scene::Image, double> frame() override {
    const auto start = Clock::now();
    scene::Image image = renderer_.render(scene_.camera, scene_.size, scene_.function);
    return {std::move(image), ms_since(start)};
  }

 private:
  const ChartScene& scene_;
  Renderer renderer_;
};

/// Ranks of one thread each as threads of this process, every other cell to each, the worst partition there is; or one
/// rank with all threads, whose compositor may be a device.
class RanksRenderer final : public ChartRenderer {
 public:
  RanksRenderer(const ChartScene& scene, const frame::RenderSettings& render, frame::Exchange exchange, int ranks,
                const frame::CompositingSettings& compositing_on)
      : scene_(scene),
        facts_(scene::facts_of(*scene.mesh)),
        ranks_(ranks),
        parts_(static_cast<std::size_t>(ranks)),
        ids_(static_cast<std::size_t>(ranks)) {
    settings_.render = render;
    if (ranks > 1) settings_.render.threads = 1;
    settings_.exchange = exchange;
    settings_.compositing_on = compositing_on;
    settings_.roles = frame::assign_roles(ranks, ranks, ranks);
    for (std::size_t rank = 0; rank < parts_.size(); ++rank) {
      std::vector<std::uint32_t> tets;
      for (std::size_t t = rank; t < scene.mesh->tets.size(); t += parts_.size())
        tets.push_back(static_cast<std::uint32_t>(t));
      ids_[rank].assign(tets.begin(), tets.end());
      parts_[rank] = std::make_shared<const scene::TetMesh>(scene::subset(*scene.mesh, tets));
    }
  }
  std::pair<scene::Image, double> frame() override {
    scene::Image image;
    const std::vector<frame::FrameJob> jobs = {{scene_.camera, scene_.size, 0}};
    double ms = 0;
    exchange::run_ranks(ranks_, [&](exchange::Transport& transport) {
      render_distributed(
          transport, settings_, jobs, scene_.function,
          [&](std::size_t) {
            const auto rank = static_cast<std::size_t>(transport.rank());
            const glm::dvec3 extent = facts_.box.high - facts_.box.low;
            return frame::ProjectorMesh{*parts_[rank], parts_[rank],        nullptr, ids_[rank], glm::length(extent),
                                        facts_.box,    facts_.scalar_range, 0};
          },
          [&](frame::FinishedFrame done) {
            image = std::move(done.image);
            ms = done.frame_ms;
          });
    });
    return {std::move(image), ms};
  }

 private:
  const ChartScene& scene_;
  scene::MeshFacts facts_;
  int ranks_;
  frame::DistributedSettings settings_;
  std::vector<std::shared_ptr<const scene::TetMesh>> parts_;
  std::vector<std::vector<std::uint64_t>> ids_;
};

std::vector<ChartMethod> mesh_methods(const ChartScene& scene) {
  std::vector<ChartMethod> methods;
  const bool orthographic = scene.camera.projection == scene::ProjectionKind::orthographic;
  const auto settings = [&](frame::Rasterizer rasterizer, const scene::Integrator& integrator) {
    frame::RenderSettings s;
    s.rasterizer = rasterizer;
    s.integrator = integrator;
    s.emission = scene.emission;
    s.threads = scene.threads;
    s.memory_bytes = scene.memory_bytes;
    return s;
  };
  const auto add = [&](frame::Rasterizer rasterizer, const char* family, const std::string& word,
                       const scene::Integrator& integrator, const std::string& options) {
    const bool planes = rasterizer == frame::Rasterizer::planes;
    const std::string prefix = planes ? "planes" : "scanline";
    ChartMethod method{fmt::format("{}, {}", prefix, family), fmt::format("{} {}", prefix, word),
                       planes ? options : "--rasterizer scanline " + options, nullptr, ""};
    // What does not go by the lattice takes about three times as long (docs/ACCURACY.md), more the more it samples.
    const bool fast =
        planes && (integrator.kind == IntegratorKind::automatic || integrator.kind == IntegratorKind::exact);
    method.cost = fast ? 1 : integrator.kind == IntegratorKind::sampled ? 3 + integrator.samples / 4.0 : 4;
    if (!planes && !orthographic) method.left_out = "scanline takes orthographic views only";
    if (integrator.kind == IntegratorKind::partial && scene.emission == scene::Emission::independent)
      method.left_out = "partial knows emission by absorption only";
    method.make = [s = settings(rasterizer, integrator)](const ChartScene& all) {
      return std::make_unique<LocalRenderer<frame::Renderer>>(all, *all.mesh, s);
    };
    methods.push_back(std::move(method));
  };
  const auto plain = [&](frame::Rasterizer rasterizer, IntegratorKind kind, const char* word) {
    add(rasterizer, word, word, {.kind = kind}, fmt::format("--integrator {}", word));
  };
  const auto sampled = [&](frame::Rasterizer rasterizer, int n) {
    const auto word = fmt::format("sampled:{}", n);
    add(rasterizer, "sampled", word, {.kind = IntegratorKind::sampled, .samples = n}, "--integrator " + word);
  };
  const auto table = [&](frame::Rasterizer rasterizer, int n) {
    const auto word = fmt::format("preintegrated:{}", n);
    add(rasterizer, "preintegrated", word, {.kind = IntegratorKind::preintegrated, .table_size = n},
        "--integrator " + word);
  };
  const auto automatic = [&](double accuracy) {
    add(frame::Rasterizer::planes, "auto", fmt::format("auto {:g}", accuracy),
        {.kind = IntegratorKind::automatic, .accuracy = accuracy}, fmt::format("--accuracy {:g}", accuracy));
  };
  using enum frame::Rasterizer;
  for (const double accuracy : {1e-4, 1e-2, 1e-3, 1e-5}) automatic(accuracy);
  plain(planes, IntegratorKind::exact, "exact");
  for (const int n : {1, 4}) sampled(planes, n);
  table(planes, 128);
  plain(planes, IntegratorKind::partial, "partial");
  sampled(scanline, 4);
  table(scanline, 128);
  const auto without = [&](const char* family, const std::string& word, scene::Mechanisms use) {
    add(planes, family, word, {.kind = IntegratorKind::exact, .terminates = use.termination},
        fmt::format("--integrator exact --without {}", use.lattice ? "termination" : "lattice"));
    if (!use.lattice) methods.back().cost = 3;
    methods.back().make = [s = settings(planes, {.kind = IntegratorKind::exact, .terminates = use.termination}),
                           use](const ChartScene& all) mutable {
      s.use = use;
      return std::make_unique<LocalRenderer<frame::Renderer>>(all, *all.mesh, s);
    };
  };
  without("exact in double", "exact in double", {.lattice = false});
  without("exact, no termination", "exact, no termination", {.termination = false});
  for (const int n : {2, 8}) sampled(planes, n);
  plain(scanline, IntegratorKind::exact, "exact");
  table(planes, 32), table(planes, 64);
  for (const auto& [exchange, word] :
       {std::pair{frame::Exchange::runs, "runs"}, {frame::Exchange::segments, "segments"}})
    methods.push_back({"two ranks, every other cell", fmt::format("exchange {}", word),
                       fmt::format("mpirun -n 2, --exchange {} --partition random", word),
                       [s = settings(planes, {}), exchange = exchange](const ChartScene& all) {
                         return std::make_unique<RanksRenderer>(all, s, exchange, 2, frame::CompositingSettings());
                       },
                       "", 2.5});
  for (const int n : {1, 2, 8}) sampled(scanline, n);
  for (const int n : {16, 32}) sampled(planes, n);
  const auto device = [&](const std::string& options, compositor::GlMethod method, bool half,
                          const scene::Integrator& integrator) {
    frame::CompositingSettings on;
    on.backends = {frame::Backend::osmesa};
    on.gl.method = method;
    on.gl.half = half;
    const bool compute = method == compositor::GlMethod::compute;
    const std::string name = fmt::format("{} {}",
                                         compute ? "gl-compute"
                                         : half  ? "gl-fragment half"
                                                 : "gl-fragment float",
                                         compute ? "exact" : "sampled:4");
    methods.push_back({compute ? "gl-compute" : "gl-fragment", name, "--backend osmesa " + options,
                       [s = settings(planes, integrator), on](const ChartScene& all) {
                         return std::make_unique<RanksRenderer>(all, s, frame::Exchange::segments, 1, on);
                       },
                       "", 30});
  };
  using compositor::GlMethod;
  const scene::Integrator four{.kind = IntegratorKind::sampled, .samples = 4};
  device("--compositor gl-compute --integrator exact", GlMethod::compute, false, {.kind = IntegratorKind::exact});
  device("--compositor gl-fragment --framebuffer float --integrator sampled:4", GlMethod::fragment, false, four);
  device("--compositor gl-fragment --framebuffer half --integrator sampled:4", GlMethod::fragment, true, four);
  return methods;
}

std::vector<ChartMethod> volume_methods(const ChartScene& scene) {
  std::vector<ChartMethod> methods;
  const auto add = [&](const char* family, const std::string& name, const std::string& options, volume::Method method,
                       double number, double cost, bool terminates = true) {
    volume::RenderSettings s;
    s.use.termination = terminates;
    s.method = method;
    (method == volume::Method::automatic ? s.accuracy : s.step) = number;
    s.emission = scene.emission;
    s.threads = scene.threads;
    s.memory_bytes = scene.memory_bytes;
    methods.push_back(
        {family, name, options,
         [s](const ChartScene& all) { return std::make_unique<LocalRenderer<volume::Renderer>>(all, *all.volume, s); },
         "", cost});
  };
  const auto automatic = [&](double accuracy) {
    add("auto", fmt::format("auto {:g}", accuracy), fmt::format("--accuracy {:g}", accuracy), volume::Method::automatic,
        accuracy, 1);
  };
  const auto stepped = [&](double step) {
    if (scene.volume->geometry().rectilinear()) return;
    add("sampled", fmt::format("sampled, step {:g}", step), fmt::format("--integrator sampled --step {:g}", step),
        volume::Method::sampled, step, 1.5 / step);
    add("preintegrated", fmt::format("preintegrated, step {:g}", step),
        fmt::format("--integrator preintegrated --step {:g}", step), volume::Method::preintegrated, step, 3 / step);
  };
  for (const double accuracy : {1e-4, 1e-2, 1e-3, 1e-5}) automatic(accuracy);
  stepped(1);
  add("exact", "exact", "--integrator exact", volume::Method::exact, 1, 1.5);
  add("no termination", "auto 0.0001, no termination", "--accuracy 0.0001 --without termination",
      volume::Method::automatic, 1e-4, 1.5, false);
  for (const double step : {2.0, 0.5, 4.0, 0.25, 0.125}) stepped(step);
  methods.push_back(
      {"slices (GL)", "slices (GL)", "--renderer slice", nullptr, "the slice renderer is not built in", 1});
  return methods;
}

}  // namespace

std::vector<ChartMethod> chart_methods(const ChartScene& scene) {
  return scene.mesh != nullptr ? mesh_methods(scene) : volume_methods(scene);
}

}  // namespace tessera::apps
