// SPDX-License-Identifier: BSD-3-Clause
#include "volume/bricks/look_ahead.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/glm.hpp>
#include <random>
#include <thread>

#include "support/await.hpp"
#include "volume/bricks/view_frustum.hpp"
#include "volume/bricks/view_motion.hpp"
#include "volume/small_volume.hpp"

namespace tessera::look_ahead_test {
namespace {

using namespace tests;
using volume::BrickCache;

void expect_near(const scene::Camera& a, const scene::Camera& b) {
  EXPECT_LT(glm::distance(a.position, b.position), 1e-12);
  EXPECT_LT(glm::distance(a.focal_point, b.focal_point), 1e-12);
  EXPECT_LT(glm::distance(scene::view_basis(a).up, scene::view_basis(b).up), 1e-12);
  EXPECT_NEAR(a.parallel_scale, b.parallel_scale, 1e-12);
  EXPECT_NEAR(a.view_angle, b.view_angle, 1e-12);
}

TEST(NextView, GoesOnTurningMovingAndZoomingAsItDid) {
  const scene::Camera start = view("perspective");
  expect_near(volume::next_view(scene::orbit(start, 0.01), scene::orbit(start, 0.03)), scene::orbit(start, 0.05));
  const auto moved = [&](double by) {
    scene::Camera camera = start;
    camera.position += by * glm::dvec3(1, 2, 3), camera.focal_point += by * glm::dvec3(1, 2, 3);
    return camera;
  };
  expect_near(volume::next_view(moved(0.1), moved(0.2)), moved(0.3));
  const auto nearer = [&](double factor) {
    scene::Camera camera = start;
    camera.position = start.focal_point + factor * (start.position - start.focal_point);
    camera.parallel_scale = factor, camera.view_angle = 30 * factor;
    return camera;
  };
  expect_near(volume::next_view(nearer(1), nearer(0.9)), nearer(0.81));
  expect_near(volume::next_view(start, start), start);
}

TEST(NextView, IgnoresJumps) {
  const scene::Camera start = view("perspective"), far = scene::orbit(start, 0.4);
  EXPECT_EQ(volume::next_view(start, far), far);
  EXPECT_EQ(volume::next_view(view("oblique"), start), start);
}

TEST(ViewFrustum, NoPointInTheViewIsOutsideOfIt) {
  const Volume v = make_volume({33, 29, 25}, Field::smooth);
  const volume::BrickLayout layout(v.grid.geometry, 4, EdgeBricks::variable);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  int far = 0;
  for (const char* name : views) {
    const scene::Camera camera = view(name);
    const scene::PixelRect region{10, 20, 60, 70};
    const std::vector<float> outside = volume::frustum_distances(camera, size, region, v.grid.geometry, layout);
    const scene::ViewBasis basis = scene::view_basis(camera);
    const bool perspective = camera.projection == scene::ProjectionKind::perspective;
    int seen = 0;
    for (std::size_t brick = 0; brick < layout.count(); ++brick) {
      const scene::SampleBox box = layout.box(layout.place(brick));
      bool any = false;
      for (int n = 0; n < 200; ++n) {
        glm::dvec3 index;
        for (std::size_t a = 0; a < 3; ++a)
          index[static_cast<int>(a)] =
              static_cast<double>(box.low[a]) + uniform(random) * static_cast<double>(box.extent(a) - 1);
        const glm::dvec3 from_eye = scene::world_of_index(v.grid.geometry, index) - camera.position;
        const double depth = glm::dot(from_eye, basis.forward);
        const double unit = perspective ? depth * std::tan(glm::radians(camera.view_angle / 2)) : camera.parallel_scale;
        const double x = size.width / 2.0 + glm::dot(from_eye, basis.right) / unit * size.height / 2.0;
        const double y = size.height / 2.0 - glm::dot(from_eye, basis.up) / unit * size.height / 2.0;
        any = any || (depth > 0 && x > region.x0 && x < region.x1 && y > region.y0 && y < region.y1);
      }
      EXPECT_TRUE(!any || outside[brick] <= 0) << name << " " << brick;
      seen += any ? 1 : 0, far += outside[brick] > 0 ? 1 : 0;
    }
    EXPECT_GT(seen, 0) << name;
  }
  EXPECT_GT(far, 100) << "of 7 x 448 bricks";
}

TEST(BrickCache, ProximityThrowsOutTheFarthestAndLoadsTheNearestAhead) {
  const Volume v = make_volume({65, 65, 65}, Field::smooth);
  const volume::BrickLayout layout(v.grid.geometry, 16, EdgeBricks::variable);
  BrickCache cache(*v.source, layout, 4 * 17 * 17 * 17 * 4, CachePolicy::proximity);
  std::vector<float> distances(layout.count());
  for (std::size_t n = 0; n < distances.size(); ++n) distances[n] = static_cast<float>(n);
  cache.set_distances(distances);
  for (const std::size_t brick : {0u, 1u, 60u, 2u, 3u}) {
    cache.acquire(brick, nullptr);
    cache.release(brick);
  }
  EXPECT_FALSE(cache.resident(60));
  for (const std::size_t brick : {0u, 1u, 2u, 3u}) EXPECT_TRUE(cache.resident(brick));
  EXPECT_EQ(cache.preload(4, true, nullptr), BrickCache::Ahead::no_room) << "all that are there are nearer";
  EXPECT_EQ(cache.preload(3, true, nullptr), BrickCache::Ahead::was_there);
  EXPECT_EQ(cache.preload(60, false, nullptr), BrickCache::Ahead::no_room);
  std::reverse(distances.begin(), distances.end());
  cache.set_distances(distances, 61.5f);
  EXPECT_EQ(cache.preload(63, true, nullptr), BrickCache::Ahead::loaded) << "0 has distance 63";
  EXPECT_EQ(cache.preload(62, true, nullptr), BrickCache::Ahead::loaded) << "1 has distance 62";
  EXPECT_EQ(cache.preload(61, true, nullptr), BrickCache::Ahead::no_room) << "2 has distance 61: it may be in use";
  for (const std::size_t brick : {63u, 62u, 2u, 3u}) EXPECT_TRUE(cache.resident(brick));
  const BrickCache::Counts counts = cache.counts();
  EXPECT_EQ(counts.loads, 5u);
  EXPECT_EQ(counts.preloads, 2u);
  EXPECT_EQ(counts.evictions, 3u);
  EXPECT_GT(counts.load_ns, 0u);
  EXPECT_GT(counts.evict_ns, 0u);
}

/// Views from the middle of a turn: bricks continually enter the view at one side.
scene::Camera turned(int frame) {
  scene::Camera camera = view("perspective");
  camera.view_angle = 5;
  return scene::orbit(camera, 0.01 * frame);
}

/// The volume's samples, with a delay after each request.
class SlowSource final : public scene::SampleSource {
 public:
  explicit SlowSource(const scene::SampleSource& source) : SampleSource(source.grid(), "slow"), source_(source) {}

 private:
  void read_samples(const scene::SampleBox& box, const scene::SampleLayout& layout, std::byte* to) const override {
    std::this_thread::sleep_for(std::chrono::microseconds(300));
    const std::int64_t bytes =
        (layout.slice_pitch * box.extent(2)) * static_cast<std::int64_t>(scene::size_of(layout.type));
    source_.read(box, layout, {to, static_cast<std::size_t>(bytes)});
  }
  const scene::SampleSource& source_;
};

TEST(LookAhead, GoesOnFromFrameToFrameAndChangesNoBit) {
  const Volume v = make_volume({65, 65, 65}, Field::smooth);
  const SlowSource slow(*v.source);
  volume::RenderSettings s;
  s.threads = 2;
  s.grid.brick_size = 8;
  volume::Renderer by_need(slow, s);
  s.grid.cache = CachePolicy::proximity;
  s.grid.preload_limit = 60;
  volume::Renderer ahead(slow, s);
  std::uint64_t loads = 0, loads_ahead = 0, loads_by_need = 0;
  int frame = 0;
  const auto render_next = [&] {
    const volume::Frame with = ahead.render(turned(frame), size, smooth_function()),
                        without = by_need.render(turned(frame), size, smooth_function());
    EXPECT_TRUE(same_bits(with.image, without.image)) << frame;
    // The limit applies to each frame, but bricks planned for the previous frame may have still been loading.
    EXPECT_LE(with.statistics.bricks_preloaded, 2u * 60 + 1);
    if (++frame <= 2) return false;
    loads += with.statistics.bricks_loaded, loads_ahead += with.statistics.bricks_preloaded;
    loads_by_need += without.statistics.bricks_loaded;
    return frame >= 16 && loads_ahead > 0 && loads < loads_by_need;
  };
  EXPECT_TRUE(test::await(render_next)) << "no brick was there before it was needed: " << loads << " loads of "
                                        << loads_by_need;
}

TEST(LookAhead, LoadsWhileFramesFollowEachOtherAtOnce) {
  const Volume v = make_volume({65, 65, 65}, Field::smooth);
  volume::RenderSettings s;
  s.threads = 1;
  s.grid.brick_size = 8;
  s.grid.cache = CachePolicy::proximity;
  s.grid.preload_limit = 12;
  volume::Renderer renderer(*v.source, s);
  // Some frame of an endless turn finds the loading thread busy.
  int frame = 0;
  EXPECT_TRUE(test::await(
      [&] { return renderer.render(turned(frame++), size, smooth_function()).statistics.bricks_preloaded > 0; },
      std::chrono::milliseconds(0)));
}

TEST(LookAhead, EndsWithItsRenderer) {
  const Volume v = make_volume({65, 65, 65}, Field::smooth);
  const SlowSource slow(*v.source);
  volume::RenderSettings s;
  s.threads = 2;
  s.grid.brick_size = 8;
  s.grid.cache = CachePolicy::proximity;
  s.grid.preload_limit = 1000;
  for (int n = 0; n < 3; ++n) volume::Renderer(slow, s).render(turned(n), size, smooth_function());
}

TEST(VolumeCaster, AVolumeFourTimesTheBudgetStaysWithinItAndPreloadsBetweenFrames) {
  const Volume v = make_volume({65, 65, 65}, Field::smooth);
  const scene::Image whole = render(v, view("perspective"), smooth_function());
  for (const auto cache : {CachePolicy::lru, CachePolicy::proximity}) {
    volume::RenderSettings s;
    s.threads = 2;
    s.grid.brick_size = 16;
    s.memory_bytes = 65 * 65 * 65 * sizeof(float) / 4;
    s.grid.cache = cache;
    s.grid.preload_limit = cache == CachePolicy::proximity ? 6 : 0;
    volume::Renderer renderer(*v.source, s);
    for (int n = 0; n < 3; ++n) {
      const volume::Frame frame = renderer.render(view("perspective"), size, smooth_function());
      EXPECT_TRUE(same_bits(frame.image, whole));
      EXPECT_LE(frame.statistics.peak_bytes, s.memory_bytes);
      EXPECT_GT(frame.statistics.bricks_loaded, 0u);
      EXPECT_GT(frame.statistics.bricks_evicted, 0u);
    }
    // The last frame's preloading may still continue: the renderer ends it.
  }
}

}  // namespace
}  // namespace tessera::look_ahead_test
