// SPDX-License-Identifier: BSD-3-Clause
#include "volume/frame_cast.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>

#include <algorithm>
#include <ctime>
#include <memory>
#include <utility>
#include <vector>

#include "scene/frame_watch.hpp"
#include "volume/split/tile_order.hpp"
#include "volume/tile_caster.hpp"

namespace tessera::volume {
namespace {

/// State of one thread.
struct Worker {
  TileState tile;
  TileMemory memory;
  TileCounts counts;
  std::vector<RayFragment> fragments;   ///< fragments of the current tile
  std::vector<UncertainRay> uncertain;  ///< uncertain rays of all tiles of this thread
  std::vector<scene::PixelRect> late;   ///< pixels of tiles with uncertain rays
  std::vector<TileTime> times;
};

using Workers = tbb::enumerable_thread_specific<std::unique_ptr<Worker>>;
std::unique_ptr<Worker> new_worker() { return std::make_unique<Worker>(); }

/// Returns the processor time of this thread, which excludes the time of other threads on the same core.
double thread_microseconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e6 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_nsec);
}

/// Calls f(tile number, the thread's worker) for all tiles.
template <class F>
void for_tiles(const FrameView& frame, std::size_t tiles, Workers& workers, const std::stop_token& stop, const F& f) {
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, tiles, 1),
      [&](const auto& some) {
        const scene::TraceScope scope(frame.trace, frame.tally == nullptr ? "project" : "partition");
        for (std::size_t n = some.begin(); n != some.end(); ++n) {
          scene::throw_if_stopped(stop);
          f(n, *workers.local());
        }
      },
      tbb::auto_partitioner());
}

}  // namespace

FrameWork cast_frame(const FrameSetup& setup, const VoxelBox& part, std::span<const scene::PixelRect> wanted,
                     FragmentSink& sink, VoxelCaster& in_double, const std::stop_token& stop) {
  const FrameView& frame = setup.view();
  const bool all = part == VoxelBox{{0, 0, 0}, frame.voxels};
  const auto tiles = tiles_of(wanted);
  Workers workers(new_worker);
  for_tiles(frame, tiles.size(), workers, stop, [&](std::size_t n, Worker& worker) {
    const double begin = thread_microseconds();
    const std::uint64_t rays_before = worker.counts.rays;
    worker.tile.begin(frame, tiles[n].x, tiles[n].y, wanted[tiles[n].region], worker.counts);
    cast_tile(frame, part, worker.tile, worker.memory, worker.counts);
    const std::size_t uncertain_before = worker.uncertain.size();
    worker.fragments.clear();
    worker.tile.fragments(frame, worker.fragments, worker.uncertain);
    sink.take(worker.fragments);
    // begin() counts rays that meet the volume; here, only rays that meet the part are counted.
    const std::size_t met = worker.fragments.size() + worker.uncertain.size() - uncertain_before;
    if (!all) worker.counts.rays = rays_before + met;
    worker.times.push_back({worker.tile.pixels(), static_cast<float>(thread_microseconds() - begin)});
    if (worker.uncertain.size() == uncertain_before)
      sink.finished(worker.tile.pixels());
    else
      worker.late.push_back(worker.tile.pixels());
  });
  FrameWork work;
  std::vector<UncertainRay> uncertain;
  for (const auto& worker : workers) {
    uncertain.insert(uncertain.end(), worker->uncertain.begin(), worker->uncertain.end());
    work.counts += worker->counts;
    work.tiles.insert(work.tiles.end(), worker->times.begin(), worker->times.end());
  }
  if (!uncertain.empty()) {
    const scene::TraceScope scope(frame.trace, "project");
    in_double.cast(uncertain, sink, stop);
    work.counts.again = uncertain.size();
  }
  for (const auto& worker : workers)
    for (const scene::PixelRect& pixels : worker->late) sink.finished(pixels);
  return work;
}

void cast_pilot(const FrameSetup& setup, const scene::PixelRect& pixels, const PilotPass& pass,
                const std::stop_token& stop) {
  const FrameView& frame = setup.view();
  auto tiles = tiles_of({&pixels, 1});
  std::size_t n_th = 0;
  std::erase_if(tiles, [&](const auto&) { return n_th++ % pass.turns != pass.number % pass.turns; });
  Workers workers(new_worker);
  for_tiles(frame, tiles.size(), workers, stop, [&](std::size_t n, Worker& worker) {
    worker.tile.begin(frame, tiles[n].x, tiles[n].y, pixels, worker.counts);
    cast_tile(frame, {{0, 0, 0}, frame.voxels}, worker.tile, worker.memory, worker.counts);
  });
}

}  // namespace tessera::volume
