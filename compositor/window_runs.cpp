#include "compositor/window_runs.hpp"

#include <algorithm>
#include <limits>

namespace tessera::compositor {

void WindowRuns::begin_tile(std::size_t tile, const scene::PixelRect& rect) {
  writer_.begin_tile(tile, rect);
  bytes_since_cut_ = 0;
}

void WindowRuns::start(const scene::PixelRect& rect) {
  writer_.start(rect);
  rules_.least_transmittance = scene_.least_transmittance();
  state_.start(rect, *scene_.space);
  open_count_ = state_.open_pixels(rect, open_);
}

void WindowRuns::take(projection::SegmentWindows& windows, std::int64_t final_step, std::size_t at_least,
                      scene::TraceLaps& laps) {
  segments_ += composite_windows(rules_, windows, final_step, at_least, state_, laps);
  write_ended();
  if (bytes_since_cut_ >= bytes_between_cuts_) {
    segments_ += composite_windows(rules_, windows, final_step, 1, state_, laps);
    cut(final_step);
  }
  open_count_ = state_.open_pixels(writer_.rect(), open_);
  laps.lap("composite");
  writer_.send_if_full();
}

bool WindowRuns::take_unordered(projection::SegmentWindows& windows, std::int64_t final_step, scene::TraceLaps& laps) {
  rules_.least_transmittance = 0;
  segments_ += composite_windows(rules_, windows, std::numeric_limits<std::int64_t>::max(), 1, state_, laps);
  cut(final_step);
  laps.lap("composite");
  writer_.send_if_full();
  return true;
}

void WindowRuns::cut(std::int64_t final_step) {
  end_runs();
  writer_.complete_to(scene_.lattice.depth(static_cast<double>(final_step)));
  bytes_since_cut_ = 0;
}

void WindowRuns::end_runs() {
  for (std::size_t p = 0; p < static_cast<std::size_t>(writer_.rect().area()); ++p) state_.end_run(p);
  write_ended();
}

void WindowRuns::finish() {
  if (!state_.ended.empty()) {
    end_runs();
    return;
  }
  // Mostly each ray ends its first run here: straight from the state then.
  const scene::PixelRect& rect = writer_.rect();
  exchange::Bytes& out = writer_.records();
  out.reserve(out.size() +
              static_cast<std::size_t>(rect.area()) * (sizeof(exchange::RunsHeader) + sizeof(exchange::LatticeRun)));
  std::uint64_t runs = 0;
  std::size_t p = 0;
  for (int y = rect.y0; y < rect.y1; ++y) {
    const std::uint32_t row = writer_.tile_pixel(p);
    for (std::uint32_t x = 0; x < static_cast<std::uint32_t>(rect.width()); ++x, ++p) {
      if (state_.first_back[p] == WindowState::not_yet) continue;
      const WindowState::Run run = state_.run(p);
      exchange::append(out, exchange::RunsHeader{row + x, static_cast<std::uint16_t>(run.several),
                                                 static_cast<std::uint16_t>(!run.several)});
      append_run(out, run);
      ++runs;
    }
  }
  writer_.count(runs);
}

void WindowRuns::append_run(exchange::Bytes& out, const WindowState::Run& run) const {
  if (!run.several) {
    exchange::append(out, run.first);
    return;
  }
  const double front = first_visible_depth(scene_.lattice, run.first, *scene_.integrator);
  exchange::append(out, exchange::LatticeRun{scene_.lattice.depth_step(front), run.back, static_cast<float>(run.red),
                                             static_cast<float>(run.green), static_cast<float>(run.blue),
                                             static_cast<float>(run.opacity)});
}

void WindowRuns::write_ended() {
  std::vector<WindowState::Run>& ended = state_.ended;
  if (ended.empty()) return;
  const auto by_pixel = [](const WindowState::Run& a, const WindowState::Run& b) { return a.pixel < b.pixel; };
  if (!std::is_sorted(ended.begin(), ended.end(), by_pixel)) std::stable_sort(ended.begin(), ended.end(), by_pixel);
  exchange::Bytes& out = writer_.records();
  const std::size_t before = out.size();
  constexpr std::size_t most = std::numeric_limits<std::uint16_t>::max();
  for (auto first = ended.begin(); first != ended.end();) {
    auto last = first;
    while (last != ended.end() && last->pixel == first->pixel && static_cast<std::size_t>(last - first) < most) ++last;
    const auto segments = std::partition(first, last, [](const WindowState::Run& run) { return run.several; });
    exchange::append(
        out, exchange::RunsHeader{writer_.tile_pixel(first->pixel), static_cast<std::uint16_t>(segments - first),
                                  static_cast<std::uint16_t>(last - segments)});
    for (auto run = first; run != last; ++run) append_run(out, *run);
    writer_.count(static_cast<std::uint64_t>(last - first));
    first = last;
  }
  bytes_since_cut_ += out.size() - before;
  ended.clear();
}

}  // namespace tessera::compositor
