// SPDX-License-Identifier: BSD-3-Clause
#include "frame/grid/sort_last.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>
#include <optional>
#include <random>
#include <sstream>
#include <utility>
#include <vector>

#include "api/random_cases.hpp"
#include "exchange/loopback_transport.hpp"
#include "frame/small_grid.hpp"
#include "reference/grid/grid_reference.hpp"
#include "reference/judge.hpp"
#include "scene/error.hpp"
#include "scene/sample_source.hpp"
#include "volume/bricks/cell_ranges.hpp"
#include "volume/split/object_split.hpp"

namespace tessera::frame::sort_last_test {
namespace {

/// A volume, a view and a way to render it.
struct Case {
  std::unique_ptr<scene::MemorySource> source;
  scene::Camera camera;
  std::vector<scene::Knot> knots;
  volume::RenderSettings render;
  int ranks = 1;
  std::string words;
  [[nodiscard]] scene::TransferFunction function() const { return scene::TransferFunction(knots); }
};

std::unique_ptr<scene::MemorySource> random_volume(Random& random, bool cell_data, bool rectilinear) {
  scene::Grid grid;
  scene::GridGeometry& g = grid.geometry;
  g.association = cell_data ? scene::Association::cell : scene::Association::point;
  for (std::size_t a = 0; a < 3; ++a) {
    g.points[a] = 3 + random.below(random.chance(0.2) ? 60 : 24);
    g.spacing[static_cast<int>(a)] = random.uniform(0.5, 2) / static_cast<double>(g.points[a] - 1);
  }
  if (rectilinear)
    for (auto& axis : g.coordinates) {
      const auto a = static_cast<std::size_t>(&axis - g.coordinates.data());
      double at = 0;
      for (std::int64_t n = 0; n < g.points[a]; ++n, at += random.uniform(0.01, 0.12)) axis.push_back(at);
    }
  if (random.chance(0.3)) {
    const glm::dmat4 turned = glm::rotate(glm::dmat4(1), random.uniform(0, 3), random.direction());
    g.direction = glm::dmat3(turned);
  }
  const scene::GridIndex n = g.samples();
  const bool noise = random.chance(0.3);
  const glm::dvec3 wave(random.uniform(2, 9), random.uniform(2, 9), random.uniform(2, 9));
  std::vector<float> values;
  for (std::int64_t k = 0; k < n[2]; ++k)
    for (std::int64_t j = 0; j < n[1]; ++j)
      for (std::int64_t i = 0; i < n[0]; ++i) {
        const glm::dvec3 p(double(i) / double(n[0]), double(j) / double(n[1]), double(k) / double(n[2]));
        values.push_back(static_cast<float>(noise ? random.uniform(0, 1)
                                                  : 0.5 + 0.25 * std::sin(wave.x * p.x) * std::cos(wave.y * p.y) +
                                                        0.2 * std::sin(wave.z * p.z * p.x)));
      }
  const scene::Box box = scene::bounds(g);
  g.origin = g.origin - (box.low + box.high) * 0.5;
  return scene::MemorySource::of(grid, std::move(values));
}

scene::Camera random_view(Random& random, const scene::Box& box) {
  const double radius = 0.5 * glm::length(box.high - box.low);
  scene::Camera camera;
  camera.focal_point = random.direction() * (0.3 * radius);
  camera.position = random.direction() * (2.5 * radius);
  camera.view_up = random.direction();
  camera.parallel_scale = radius * random.uniform(0.3, 1.1);
  if (random.chance(0.6)) {
    camera.projection = scene::ProjectionKind::perspective;
    camera.view_angle = random.uniform(20, 100);
    if (random.chance(0.4)) camera.position = random.direction() * (0.4 * radius);  // usually inside
  }
  if (random.chance(0.1)) camera.clipping_range = {1.8 * radius, 3.1 * radius};
  return camera;
}

Case random_case(Random& random) {
  Case c;
  const bool cell_data = random.chance(0.25), rectilinear = random.chance(0.15);
  c.source = random_volume(random, cell_data, rectilinear);
  const scene::Box box = scene::bounds(c.source->geometry());
  c.camera = random_view(random, box);
  const double thickness = random.power(-0.5, 2.5) / glm::length(box.high - box.low);
  const int knots = 2 + random.below(8);
  for (int k = 0; k < knots; ++k)
    c.knots.push_back({static_cast<double>(k) / (knots - 1),
                       {random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)},
                       random.chance(0.3) ? 0 : thickness * random.uniform(0, 1)});
  volume::RenderSettings& render = c.render;
  render.threads = 1;
  const int sizes[] = {5, 8, 16, 32};
  render.grid.brick_size = random.of(sizes);
  const int method = random.below(3);
  if (method == 0) render.integrator.kind = IntegratorKind::exact;
  render.integrator.accuracy = method == 1 ? 1e-5 : 1e-4;
  if (random.chance(0.15)) render.emission = Emission::independent;
  if (!cell_data && render.emission == Emission::absorption && random.chance(0.2)) render.grid.shading.emplace();
  if (!cell_data && random.chance(0.2))
    render.surfaces.iso.push_back({random.uniform(0.2, 0.8), std::nullopt, random.chance(0.5) ? 1.0 : 0.4});
  c.ranks = 1 + random.below(12);
  if (random.chance(0.3)) c.render.ranks.direct_send = DirectSend::synchronous;
  std::ostringstream words;
  words << c.ranks << " ranks, bricks of " << render.grid.brick_size << (cell_data ? ", cell data" : "")
        << (rectilinear ? ", rectilinear" : "") << (render.grid.shading ? ", shaded" : "")
        << (render.surfaces.empty() ? "" : ", a surface") << ", " << knots << " knots, method " << method;
  c.words = words.str();
  return c;
}

std::optional<FinishedVolumeFrame> render(const Case& c, scene::ImageSize size) {
  std::optional<FinishedVolumeFrame> finished;
  const auto ranges = std::make_shared<const volume::CellRanges>(*c.source);
  exchange::run_ranks(c.ranks, [&](exchange::Transport& transport) {
    volume::RenderSettings render = c.render;
    render.parts = c.ranks;
    volume::Renderer renderer(*c.source, render, ranges);
    SortLast run(transport, c.render);
    if (auto frame = run.render(renderer, c.function(), {c.camera, size}, 0)) finished = std::move(frame);
  });
  return finished;
}

// Splits, numbers of processes, views inside and outside, opaque and thin: the same promise as `accuracy` for one
// process.
TEST(SortLast, PicturesAreWithinAccuracyInRandomCases) {
  constexpr scene::ImageSize size{24, 20};
  const int first = wanted("TESSERA_RANDOM_FIRST", 0), cases = wanted("TESSERA_RANDOM_CASES", 300);
  std::size_t pixels = 0, excused = 0, with_parts = 0;
  double worst = 0;
  for (int number = first; number < first + cases; ++number) {
    Random random(7000003 + static_cast<std::uint64_t>(number));
    const Case c = random_case(random);
    const auto frame = render(c, size);
    ASSERT_TRUE(frame);
    const reference::GridReference truth(*c.source, c.camera, size, c.function(), c.render.emission,
                                         c.render.grid.shading, {}, c.render.surfaces);
    const double bound = c.render.integrator.kind == IntegratorKind::exact ? 1e-5 : c.render.integrator.accuracy;
    const auto judgement = reference::judge(frame->image, truth, bound, {}, 2);
    EXPECT_LE(judgement.max_error_not_excused, bound)
        << "case " << number << ", " << c.words << ": " << judgement.over_bound << " over at (" << judgement.worst_x
        << ", " << judgement.worst_y << ')';
    pixels += judgement.pixels_checked, excused += judgement.excused;
    worst = std::max(worst, judgement.max_error_not_excused / bound);
    with_parts += static_cast<std::size_t>(
        std::ranges::count_if(frame->ranks, [](const GridCounters& rank) { return rank.samples > 0; }));
  }
  const double share = 1e-4 * static_cast<double>(pixels);
  EXPECT_LE(static_cast<double>(excused), share + 3 * std::sqrt(share)) << "of " << pixels;
  EXPECT_GT(with_parts, static_cast<std::size_t>(2 * cases)) << "processes that had something to cast";
  std::printf("cases %d to %d: largest error %.3g of what was promised, %zu of %zu pixels excused\n", first,
              first + cases - 1, worst, excused, pixels);
}

Case ball(int ranks) {
  Case c;
  c.source = small_grid(65, [](const glm::dvec3& p) { return std::exp(-2 * glm::dot(p, p)); });
  c.camera.position = {2.5, 1.8, 3.3};
  c.camera.parallel_scale = 1.6;
  c.knots = {{0, {0.2, 0.4, 1}, 0.1}, {1, {1, 0.5, 0.2}, 5}};
  c.render.threads = 1;
  c.render.grid.brick_size = 16;
  c.ranks = ranks;
  return c;
}

/// Counts the reads of a volume inside and outside a part.
class PartOfVolume final : public scene::SampleSource {
 public:
  PartOfVolume(const scene::SampleSource& all, const volume::VoxelBox& part)
      : SampleSource(all.grid(), "part"), all_(all), part_(part) {}
  mutable std::atomic<int> inside = 0, outside = 0;

 private:
  void read_samples(const scene::SampleBox& box, const scene::SampleLayout& layout,
                    std::byte* destination) const override {
    bool within = true;
    // A brick includes the first samples of the next one.
    for (std::size_t a = 0; a < 3; ++a)
      within = within && box.low[a] >= part_.low[a] && box.high[a] <= part_.high[a] + 1;
    ++(within ? inside : outside);
    all_.read(box, layout, {destination, static_cast<std::size_t>(1) << 40});
  }

  const scene::SampleSource& all_;
  const volume::VoxelBox part_;
};

TEST(SortLast, EachProcessReadsItsOwnBricksAlone) {
  const Case c = ball(4);
  const auto ranges = std::make_shared<const volume::CellRanges>(*c.source);
  const volume::ObjectSplit split = volume::Renderer(*c.source, c.render, ranges).object_split(c.function(), c.ranks);
  exchange::run_ranks(c.ranks, [&](exchange::Transport& transport) {
    const PartOfVolume part(*c.source, split.boxes()[static_cast<std::size_t>(transport.rank())]);
    volume::RenderSettings render = c.render;
    // The memory holds only a quarter of the bricks.
    render.memory_bytes = 17 * 17 * 17 * 4 * (64 / 4 + 4);
    // Nor are others preloaded.
    if (transport.rank() % 2 == 0) render.grid.cache = CachePolicy::proximity, render.grid.preload_limit = 8;
    volume::Renderer renderer(part, render, ranges);
    SortLast run(transport, c.render);
    std::uint64_t loaded = 0, evicted = 0;
    for (std::size_t number = 0; number < 6; ++number) {
      const auto frame =
          run.render(renderer, c.function(), {scene::orbit(c.camera, double(number) / 6), {60, 50}}, number);
      if (!frame) continue;
      evicted += frame->statistics.bricks_evicted;
      if (number > 0) loaded += frame->statistics.bricks_loaded;
    }
    EXPECT_EQ(part.outside, 0);
    EXPECT_GT(part.inside, 0);
    EXPECT_EQ(evicted, 0u) << "the volume is larger than any process's memory";
    EXPECT_EQ(loaded, 0u) << "whatever the view, a process needs its own bricks";
  });
}

TEST(SortLast, CountersPartsAndTilesAreThoseOfTheWholePicture) {
  Case c = ball(5);
  // At steps, float lanes are not certain everywhere.
  c.knots = {{0, {0.2, 0.4, 1}, 0}, {0.5, {0.2, 0.4, 1}, 0}, {0.5, {1, 0.5, 0.2}, 5}, {1, {1, 0.5, 0.2}, 5}};
  constexpr scene::ImageSize size{60, 50};
  std::vector<int> reported(60 * 50, 0);
  std::vector<float> alpha(60 * 50, -1);
  const auto ranges = std::make_shared<const volume::CellRanges>(*c.source);
  std::optional<FinishedVolumeFrame> finished;
  exchange::run_ranks(c.ranks, [&](exchange::Transport& transport) {
    volume::Renderer renderer(*c.source, c.render, ranges);
    SortLast run(transport, c.render, {.keep_uncertainty = true});
    scene::FrameWatch watch({}, [&](const scene::PixelRect& rect, const scene::Image& image) {
      for (int y = rect.y0; y < rect.y1; ++y)
        for (int x = rect.x0; x < rect.x1; ++x) {
          ++reported[image.index(x, y)];
          alpha[image.index(x, y)] = image.rgba[4 * image.index(x, y) + 3];
        }
    });
    auto frame = run.render(renderer, c.function(), {c.camera, size}, 3, &watch);
    if (frame) finished = std::move(frame);
  });
  ASSERT_TRUE(finished);
  EXPECT_EQ(finished->frame, 3u);
  GridCounters together;
  for (const GridCounters& rank : finished->ranks) together += rank;
  for (const GridCounter& counter : grid_counters)
    EXPECT_EQ(finished->statistics.*counter.member, together.*counter.member) << counter.name;
  EXPECT_GT(finished->statistics.exchange_messages, 4u * 5u - 1);
  ASSERT_EQ(finished->parts.size(), 5u);
  EXPECT_EQ(finished->error_bounds.size(), reported.size());
  EXPECT_GT(*std::ranges::max_element(finished->error_bounds), 0.0f);
  std::vector<int> covered(reported.size(), 0);
  for (const scene::PixelRect& r : finished->regions)
    for (int y = r.y0; y < r.y1; ++y)
      for (int x = r.x0; x < r.x1; ++x) ++covered[finished->image.index(x, y)];
  for (std::size_t pixel = 0; pixel < reported.size(); ++pixel) {
    ASSERT_EQ(reported[pixel], 1) << pixel;
    ASSERT_EQ(covered[pixel], 1) << pixel;
    ASSERT_EQ(alpha[pixel], finished->image.rgba[4 * pixel + 3]) << "reported before it was final";
  }
}

TEST(SortLast, TheSameJobGivesTheSameBitsWithEitherExchange) {
  Case c = ball(6);
  const auto first = render(c, {60, 50});
  c.render.threads = 3;
  const auto again = render(c, {60, 50});
  c.render.ranks.direct_send = DirectSend::synchronous;
  const auto synchronous = render(c, {60, 50});
  ASSERT_TRUE(first && again && synchronous);
  for (const auto* other : {&again, &synchronous}) {
    EXPECT_EQ(first->image.rgba, (*other)->image.rgba);
    EXPECT_EQ(first->image.depth, (*other)->image.depth);
  }
}

TEST(SortLast, AStopOnAnyRankEndsThePictureOnAllAndTheNextIsWhole) {
  const Case c = ball(3);
  constexpr scene::ImageSize size{300, 240};
  const auto ranges = std::make_shared<const volume::CellRanges>(*c.source);
  std::optional<FinishedVolumeFrame> stopped, whole;
  exchange::run_ranks(c.ranks, [&](exchange::Transport& transport) {
    volume::Renderer renderer(*c.source, c.render, ranges);
    SortLast run(transport, c.render);
    std::stop_source stop;
    if (transport.rank() == 1) stop.request_stop();
    scene::FrameWatch watch(stop.get_token());
    auto first = run.render(renderer, c.function(), {c.camera, size}, 0, &watch);
    auto second = run.render(renderer, c.function(), {c.camera, size}, 1);
    if (first) stopped = std::move(first), whole = std::move(second);
  });
  ASSERT_TRUE(stopped && whole);
  EXPECT_TRUE(stopped->stopped);
  EXPECT_FALSE(whole->stopped);
  const auto alone = render(c, size);
  EXPECT_EQ(whole->image.rgba, alone->image.rgba);
}

TEST(SortLast, AVolumeOutOfViewIsAnEmptyPicture) {
  Case c = ball(4);
  c.camera.focal_point = {30, 0, 0}, c.camera.position = {30, 0, 5};
  const auto frame = render(c, {40, 30});
  ASSERT_TRUE(frame);
  EXPECT_EQ(*std::ranges::max_element(frame->image.rgba), 0.0f);
  EXPECT_FALSE(frame->stopped);
}

}  // namespace
}  // namespace tessera::frame::sort_last_test
