// SPDX-License-Identifier: BSD-3-Clause
// Frames of an animation through the brick caches of several units, for bench/cache.py: reproduces the loading results
// printed in 6.2.2 and 6.7.2 of Moloney, "Ray Coherence in Parallel Volume Rendering" (SFU 2008).
//
//   cache_frames [NAME=VALUE ...] [then NAME=VALUE ...]      prints a JSON object per run: bricks, and for each frame
//                                                            its ms and each unit's [waited for, ahead, us waited]
//
// Units are ranks of one process, each with a cache, a share of the image and a thread of its own, and frames follow
// each other at once. The volume is in memory; `read_us` is how long a unit waits for each brick, one after the other:
// it simulates a slower disk, or the thesis's path to texture memory. Values and their defaults are those of `Run`.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "datasets/volumes.hpp"
#include "exchange/loopback_transport.hpp"
#include "frame/grid/sort_first.hpp"
#include "scene/error.hpp"
#include "volume/bricks/cell_ranges.hpp"
#include "volume/render.hpp"

namespace {

using namespace tessera;

/// The parameters of a run: strings first, then numbers.
struct Run {
  std::map<std::string, std::string> words{{"volume", "head"}, {"cache", "lru"}, {"animation", "turn"}};
  std::map<std::string, double> numbers{{"n", 128},     {"brick", 8},   {"units", 4},   {"size", 512},  {"frames", 60},
                                        {"degrees", 2}, {"share", 0.5}, {"preload", 0}, {"read_us", 0}, {"step", 8}};

  explicit Run(const std::vector<std::string>& arguments) {
    for (const std::string& argument : arguments) {
      const std::size_t at = argument.find('=');
      const std::string name = argument.substr(0, at), value = at == std::string::npos ? "" : argument.substr(at + 1);
      if (words.contains(name) && !value.empty())
        words[name] = value;
      else if (numbers.contains(name) && !value.empty())
        numbers[name] = std::stod(value);
      else
        throw scene::bad_input(fmt::format("cache_frames: '{}' is not one of its parameters NAME=VALUE", argument));
    }
  }
  [[nodiscard]] int whole(const char* name) const { return static_cast<int>(numbers.at(name)); }
};

/// Another source's samples; each read takes a while, one at a time.
class ThrottledSource final : public scene::SampleSource {
 public:
  ThrottledSource(const scene::SampleSource& source, double read_us)
      : SampleSource(source.grid(), "throttled"), source_(source), each_(static_cast<std::int64_t>(read_us)) {}

 private:
  void read_samples(const scene::SampleBox& box, const scene::SampleLayout& layout, std::byte* to) const override {
    const std::lock_guard lock(one_at_a_time_);
    const auto end = std::chrono::steady_clock::now() + each_;
    const auto samples = static_cast<std::size_t>((box.extent(2) - 1) * layout.slice_pitch +
                                                  (box.extent(1) - 1) * layout.row_pitch + box.extent(0));
    source_.read(box, layout, {to, samples * scene::size_of(layout.type)});
    std::this_thread::sleep_until(end);
  }
  const scene::SampleSource& source_;
  std::chrono::microseconds each_;
  mutable std::mutex one_at_a_time_;
};

/// A volume with the results of scanning it.
struct Scanned {
  std::unique_ptr<scene::MemorySource> source;
  std::shared_ptr<const volume::CellRanges> ranges;
};

Scanned scanned(const Run& run) {
  const auto made = datasets::generate_volume(run.words.at("volume"), {{"n", run.numbers.at("n")}, {"bits", 8}});
  std::vector<std::uint8_t> samples(static_cast<std::size_t>(made->geometry().all_samples().count()));
  made->read(made->geometry().all_samples(), std::span(samples));
  Scanned scanned{scene::MemorySource::of(made->grid(), std::move(samples)), nullptr};
  scanned.ranges = std::make_shared<const volume::CellRanges>(*scanned.source);
  return scanned;
}

/// The functions named in datasets/volume_fields.hpp, so transparent that few rays end early.
scene::TransferFunction function_of(const std::string& volume) {
  if (volume == "head") return scene::TransferFunction({{64, {0.8, 0.5, 0.4}, 0}, {255, {1, 1, 0.9}, 2}});
  return scene::TransferFunction({{76.5, {0.2, 0.4, 0.9}, 0}, {127.5, {1, 1, 1}, 2}, {178.5, {0.9, 0.4, 0.2}, 0}});
}

/// turn: the camera turns around the x axis by `degrees` per frame, and the volume is as large as the image. zoom: the
/// camera moves from far away to the middle and back, once per 360 / `degrees` frames. explore: the camera turns, zooms
/// and pans, like a user exploring the volume.
scene::Camera camera_at(const Run& run, int frame) {
  const double angle = glm::radians(run.numbers.at("degrees")) * frame;
  scene::Camera camera;
  camera.projection = scene::ProjectionKind::perspective;
  camera.view_angle = 30;
  const std::string& kind = run.words.at("animation");
  glm::dvec3 away{0, std::sin(angle), std::cos(angle)};
  double distance = 5.5;
  camera.view_up = {1, 0, 0};
  if (kind == "zoom") {
    away = glm::normalize(glm::dvec3(0.5, 0.4, 0.8));
    distance = 3.6 + 2.4 * std::cos(angle);
    camera.view_up = {0, 1, 0};
  } else if (kind == "explore") {
    away = {std::cos(angle) * 0.9, 0.5 * std::sin(0.7 * angle), std::sin(angle) * 0.9};
    distance = 4.0 + 1.6 * std::cos(0.6 * angle);
    camera.view_up = {0, 1, 0};
    camera.focal_point = glm::dvec3(0.35 * std::sin(1.3 * angle), 0.3 * std::sin(0.9 * angle), 0);
  }
  camera.position = camera.focal_point + distance * glm::normalize(away);
  return camera;
}

struct Shown {
  std::uint64_t visible = 0, visible_voxels = 0, visible_bytes = 0;
};

Shown shown_of(const scene::SampleSource& source, const volume::RenderSettings& settings,
               const std::shared_ptr<const volume::CellRanges>& ranges, const scene::TransferFunction& function) {
  Shown shown;
  for (const auto& [low, high] : volume::Renderer(source, settings, ranges).visible_bricks(function)) {
    const glm::dvec3 sides = high - low;
    ++shown.visible;
    shown.visible_voxels += static_cast<std::uint64_t>(sides.x * sides.y * sides.z);
    shown.visible_bytes += static_cast<std::uint64_t>((sides.x + 1) * (sides.y + 1) * (sides.z + 1));
  }
  return shown;
}

void report(const Run& run, const Scanned& of) {
  const auto& [source, ranges] = of;
  const scene::TransferFunction function = function_of(run.words.at("volume"));
  volume::RenderSettings settings;
  settings.integrator.kind = IntegratorKind::sampled;
  settings.grid.step = run.numbers.at("step");
  settings.threads = 1;
  settings.grid.brick_size = run.whole("brick");
  settings.grid.cache = run.words.at("cache") == "proximity" ? CachePolicy::proximity : CachePolicy::lru;
  settings.grid.preload_limit = run.whole("preload");
  const Shown shown = shown_of(*source, settings, ranges, function);
  settings.memory_bytes =
      static_cast<std::uint64_t>(run.numbers.at("share") * static_cast<double>(shown.visible_bytes));
  std::string frames;
  const scene::ImageSize size{run.whole("size"), run.whole("size")};
  exchange::run_ranks(run.whole("units"), [&, &source = source, &ranges = ranges](exchange::Transport& transport) {
    const ThrottledSource slow(*source, run.numbers.at("read_us"));
    volume::Renderer renderer(slow, settings, ranges);
    Settings split;
    split.ranks.balance = Balance::backface;
    frame::SortFirst sort_first(transport, split);
    for (int n = 0; n < run.whole("frames"); ++n) {
      const auto frame = sort_first.render(renderer, function, {camera_at(run, n), size}, static_cast<std::size_t>(n));
      if (!frame) continue;
      std::string units;
      for (const GridCounters& unit : frame->ranks)
        units += fmt::format("{}[{}, {}, {}]", units.empty() ? "" : ", ", unit.bricks_loaded, unit.bricks_preloaded,
                             unit.load_us);
      frames += fmt::format("{}{{\"ms\": {:.3f}, \"units\": [{}]}}", n == 0 ? "" : ", ", frame->frame_ms, units);
    }
  });
  fmt::print("{{\"visible\": {}, \"visible_voxels\": {}, \"frames\": [{}]}}\n", shown.visible, shown.visible_voxels,
             frames);
}

void report_all(const std::vector<std::string>& arguments) {
  std::map<std::pair<std::string, double>, Scanned> volumes;
  for (auto first = arguments.begin();; ++first) {
    const auto last = std::find(first, arguments.end(), "then");
    const Run run(std::vector<std::string>(first, last));
    Scanned& of = volumes[{run.words.at("volume"), run.numbers.at("n")}];
    if (!of.source) of = scanned(run);
    report(run, of);
    if (last == arguments.end()) return;
    first = last;
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    report_all({argv + 1, argv + argc});
  } catch (const std::exception& fault) {
    std::fprintf(stderr, "%s\n", fault.what());
    return 2;
  }
  return 0;
}
