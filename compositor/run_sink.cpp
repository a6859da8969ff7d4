// SPDX-License-Identifier: BSD-3-Clause
#include "compositor/run_sink.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <type_traits>

namespace tessera::compositor {
namespace {

template <class Encoding>
constexpr exchange::RecordKind kind =
    std::is_same_v<Encoding, LatticeEncoding> ? exchange::RecordKind::lattice_runs : exchange::RecordKind::runs;

double planar_depth(const TileScene&, double depth) { return depth; }
double planar_depth(const TileScene& scene, std::int64_t step) {
  return scene.lattice.depth(static_cast<double>(step));
}

/// Writes a run's record to `to` and returns its end. The record is written field by field: if it were assembled in
/// memory first, the processor could not copy it before the stores of its fields are complete.
std::byte* write_run(const TileScene& scene, const WindowState::Run& run, std::byte* to) {
  const auto put = [&](const auto& value) {
    std::memcpy(to, &value, sizeof value);
    to += sizeof value;
  };
  if (!run.several) {
    put(run.first);
    return to;
  }
  const double front = first_visible_depth(scene.lattice, run.first, *scene.integrator);
  put(scene.lattice.depth_step(front));
  put(run.back);
  for (const double value : {run.red, run.green, run.blue, run.opacity}) put(static_cast<float>(value));
  return to;
}

constexpr std::size_t most_bytes_a_run = sizeof(exchange::LatticeRun);
static_assert(sizeof(projection::LatticeSegment) <= most_bytes_a_run);

void append_run(const TileScene& scene, const WindowState::Run& run, exchange::Bytes& out) {
  std::array<std::byte, most_bytes_a_run> record;
  const std::byte* const end = write_run(scene, run, record.data());
  out.insert(out.end(), static_cast<const std::byte*>(record.data()), end);
}

void write_runs(const TileScene&, std::vector<TilePixels<DoubleEncoding>::Run>& runs, exchange::PartWriter& writer) {
  for (const auto& run : runs)
    exchange::append(
        writer.records(),
        exchange::RunRecord{run.front, static_cast<float>(run.back - run.front), static_cast<float>(run.red),
                            static_cast<float>(run.green), static_cast<float>(run.blue),
                            static_cast<float>(-std::expm1(-run.optical_depth)), writer.tile_pixel(run.pixel)});
  writer.count(runs.size());
}

/// The runs of one pixel share a header.
void write_runs(const TileScene& scene, std::vector<WindowState::Run>& runs, exchange::PartWriter& writer) {
  const auto by_pixel = [](const WindowState::Run& a, const WindowState::Run& b) { return a.pixel < b.pixel; };
  if (!std::is_sorted(runs.begin(), runs.end(), by_pixel)) std::stable_sort(runs.begin(), runs.end(), by_pixel);
  exchange::Bytes& out = writer.records();
  constexpr std::size_t most = std::numeric_limits<std::uint16_t>::max();
  for (auto first = runs.begin(); first != runs.end();) {
    auto last = first;
    while (last != runs.end() && last->pixel == first->pixel && static_cast<std::size_t>(last - first) < most) ++last;
    const auto segments = std::partition(first, last, [](const WindowState::Run& run) { return run.several; });
    if (first == runs.begin() || std::prev(first)->pixel == first->pixel) writer.begin_ascending();
    if (segments != last) writer.note_segments();
    exchange::append(out,
                     exchange::RunsHeader{writer.tile_pixel(first->pixel), static_cast<std::uint16_t>(segments - first),
                                          static_cast<std::uint16_t>(last - segments)});
    for (auto run = first; run != last; ++run) append_run(scene, *run, out);
    writer.count(static_cast<std::uint64_t>(last - first));
    first = last;
  }
}

/// Writes the runs directly from the state. This is possible in most rectangles: no ray in them has more than one run.
void write_only_runs(const TileScene& scene, const WindowState& state, exchange::PartWriter& writer) {
  const scene::PixelRect& rect = writer.rect();
  exchange::Bytes& out = writer.records();
  constexpr std::size_t most_bytes = sizeof(exchange::RunsHeader) + most_bytes_a_run;
  out.reserve(out.size() + static_cast<std::size_t>(rect.area()) * most_bytes);
  std::array<std::byte, projection::SegmentWindows::side * most_bytes> of_row;
  std::uint64_t runs = 0;
  bool segments = false;
  std::size_t p = 0;
  for (int y = rect.y0; y < rect.y1; ++y) {
    const std::uint32_t row = writer.tile_pixel(p);
    std::byte* to = of_row.data();
    for (std::uint32_t x = 0; x < static_cast<std::uint32_t>(rect.width()); ++x, ++p) {
      if (state.first_back[p] == WindowState::not_yet) continue;
      const WindowState::Run run = state.run(p);
      const exchange::RunsHeader header{row + x, static_cast<std::uint16_t>(run.several),
                                        static_cast<std::uint16_t>(!run.several)};
      segments |= !run.several;
      std::memcpy(to, &header, sizeof header);
      to = write_run(scene, run, to + sizeof header);
      ++runs;
    }
    out.insert(out.end(), static_cast<const std::byte*>(of_row.data()), static_cast<const std::byte*>(to));
  }
  writer.count(runs);
  writer.begin_ascending();
  if (segments) writer.note_segments();
}

auto& ended_of(TilePixels<DoubleEncoding>& pixels) { return pixels.ended; }
auto& ended_of(TilePixels<LatticeEncoding>& pixels) { return pixels.state().ended; }

}  // namespace

template <class Encoding>
RunSink<Encoding>::RunSink(const TileScene& scene, std::uint64_t bytes_between_cuts, Deliver deliver)
    : FragmentSink<Encoding>(kind<Encoding>, std::move(deliver)),
      scene_(scene),
      pixels_(scene, true),
      bytes_between_cuts_(bytes_between_cuts) {}

template <class Encoding>
void RunSink<Encoding>::begin_tile(std::size_t tile, const scene::PixelRect& rect) {
  FragmentSink<Encoding>::begin_tile(tile, rect);
  bytes_since_cut_ = 0;
}

template <class Encoding>
void RunSink<Encoding>::start(const scene::PixelRect& rect) {
  FragmentSink<Encoding>::start(rect);
  pixels_.start(rect);
}

template <class Encoding>
void RunSink<Encoding>::take(Store& store, Depth final_depth, std::size_t at_least, scene::StageTimer& timer) {
  segments_ += pixels_.take(store, final_depth, at_least, timer);
  write_ended();
  if (bytes_since_cut_ >= bytes_between_cuts_) {
    segments_ += pixels_.take(store, final_depth, 1, timer);
    cut(final_depth);
  }
  timer.record("composite");
  writer_.send_if_full();
}

template <class Encoding>
bool RunSink<Encoding>::take_unordered(Store& store, Depth final_depth, scene::StageTimer& timer) {
  pixels_.keep_open();
  segments_ += pixels_.take(store, Encoding::end, 1, timer);
  cut(final_depth);
  timer.record("composite");
  writer_.send_if_full();
  return true;
}

template <class Encoding>
void RunSink<Encoding>::cut(Depth final_depth) {
  pixels_.end_runs();
  write_ended();
  writer_.complete_to(planar_depth(scene_, final_depth));
  bytes_since_cut_ = 0;
}

template <class Encoding>
void RunSink<Encoding>::finish() {
  if constexpr (std::is_same_v<Encoding, LatticeEncoding>)
    if (ended_of(pixels_).empty()) {
      write_only_runs(scene_, pixels_.state(), writer_);
      return;
    }
  pixels_.end_runs();
  write_ended();
}

template <class Encoding>
void RunSink<Encoding>::write_ended() {
  auto& ended = ended_of(pixels_);
  if (ended.empty()) return;
  const std::size_t before = writer_.records().size();
  write_runs(scene_, ended, writer_);
  bytes_since_cut_ += writer_.records().size() - before;
  ended.clear();
}

template class RunSink<DoubleEncoding>;
template class RunSink<LatticeEncoding>;

}  // namespace tessera::compositor
