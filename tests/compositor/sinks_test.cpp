// SPDX-License-Identifier: BSD-3-Clause
// What sinks of segments and of runs send for given rays, decoded from their records alone, in both encodings.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <random>
#include <tuple>
#include <utility>
#include <vector>

#include "compositor/random_rays.hpp"
#include "compositor/run_sink.hpp"
#include "compositor/segment_sink.hpp"

namespace tessera::compositor::sinks_test {
namespace {

using projection::LatticeSegment;
using tests::RandomRays;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// A segment or a run as decoded from a record. Raw segments have no light.
struct Sent {
  std::size_t pixel;
  double front, back = 0;
  double red = 0, green = 0, blue = 0, opacity = 0;
  std::size_t part = 0;  ///< of the tile
  [[nodiscard]] auto place() const { return std::tie(pixel, front, back); }
};

struct Scene : RandomRays {
  Scene(std::uint32_t seed, std::size_t most, double extinction)
      : RandomRays(seed, most, extinction, false),
        table(function, lattice.scalar_origin, lattice.scalar_unit, lattice.depth_unit, scene::Emission::absorption) {}
  /// `left_out` is the value of opacity_weight(): the larger it is, the later a pixel closes.
  [[nodiscard]] TileScene tile_scene(double left_out = 1e30) const {
    return {&space, &integrator, left_out, &table, lattice};
  }
  integrals::LaneTable table;

  /// A segment that is sent unchanged, with the light that its compositor computes.
  [[nodiscard]] Sent shown(std::size_t pixel, const LatticeSegment& s) const {
    return shown(composited(pixel, {s}, true, 0).at(0));
  }
  [[nodiscard]] static Sent shown(const Run& run) {
    return {run.pixel, run.front, run.back, run.red, run.green, run.blue, 1 - run.transmittance};
  }
};

/// The parts of a tile that a sink has delivered, decoded.
struct Parts {
  exchange::PartWriter::Deliver deliver() {
    return [this](exchange::TilePart part) { parts.push_back(std::move(part)); };
  }

  [[nodiscard]] std::vector<Sent> sent(const Scene& scene) const {
    std::vector<Sent> all;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const std::size_t before = all.size();
      exchange::RecordReader reader(parts[i].records.bytes());
      while (!reader.empty()) take(scene, parts[i].kind, reader, all);
      EXPECT_EQ(parts[i].fragments, all.size() - before);
      for (std::size_t k = before; k < all.size(); ++k) all[k].part = i;
    }
    std::sort(all.begin(), all.end(), [](const Sent& a, const Sent& b) { return a.place() < b.place(); });
    return all;
  }

  std::vector<exchange::TilePart> parts;

 private:
  static void take(const Scene& scene, exchange::RecordKind kind, exchange::RecordReader& reader,
                   std::vector<Sent>& all) {
    const auto depth = [&](std::int32_t step) { return scene.lattice.depth(step); };
    if (kind == exchange::RecordKind::chains) {
      const auto chain = reader.take<exchange::ChainHeader>();
      double front = chain.front;
      for (std::uint32_t k = 0; k < chain.links; ++k) {
        const auto link = reader.take<exchange::ChainLink>();
        all.push_back({chain.pixel, std::exchange(front, link.back), link.back});
      }
    } else if (kind == exchange::RecordKind::lattice) {
      const auto header = reader.take<exchange::LatticeHeader>();
      for (std::uint32_t k = 0; k < header.segments; ++k) {
        const auto s = reader.take<LatticeSegment>();
        all.push_back({header.pixel, depth(s.front), depth(s.back)});
      }
    } else if (kind == exchange::RecordKind::runs) {
      const auto r = reader.take<exchange::RunRecord>();
      all.push_back({r.pixel, r.front, r.front + static_cast<double>(r.thickness), r.red, r.green, r.blue, r.opacity});
    } else {
      ASSERT_EQ(kind, exchange::RecordKind::lattice_runs);
      const auto header = reader.take<exchange::RunsHeader>();
      for (int k = 0; k < header.runs; ++k) {
        const auto r = reader.take<exchange::LatticeRun>();
        all.push_back({header.pixel, depth(r.front), depth(r.back), r.red, r.green, r.blue, r.opacity});
      }
      for (int k = 0; k < header.segments; ++k) all.push_back(scene.shown(header.pixel, reader.take<LatticeSegment>()));
    }
  }
};

void reset(sorting::SegmentLists& lists, const Scene& scene) {
  lists.reset(Scene::pixels);
  lists.segments.reserve(scene.total());
}
void reset(projection::SegmentWindows& windows, const Scene& scene) {
  std::size_t most = 1;
  for (const auto& ray : scene.rays) most = std::max(most, ray.size());
  windows.reset(Scene::pixels, most);
}
void push(sorting::SegmentLists& lists, const Scene& scene, std::size_t pixel, const LatticeSegment& s) {
  projection::RaySegments& to = lists.segments;
  to.pixel_and_tet[to.size] = pixel | (static_cast<std::uint64_t>(to.size) << 32);
  to.front[to.size] = scene.lattice.depth(s.front), to.back[to.size] = scene.lattice.depth(s.back);
  to.scalar_front[to.size] = scene.lattice.scalar(s.scalar_front);
  to.scalar_back[to.size] = scene.lattice.scalar(s.scalar_back);
  ++to.size;
}
void push(projection::SegmentWindows& windows, const Scene&, std::size_t pixel, const LatticeSegment& s) {
  ASSERT_TRUE(windows.push(pixel, s));
}

std::uint64_t waiting_in(const sorting::SegmentLists& lists) { return lists.segments.size; }
std::uint64_t waiting_in(const projection::SegmentWindows& windows) { return windows.total(); }

template <class Encoding>
typename Encoding::Depth depth_of(const Scene& scene, std::int64_t step) {
  if constexpr (std::is_same_v<Encoding, LatticeEncoding>) return step;
  return static_cast<typename Encoding::Depth>(scene.lattice.depth(static_cast<double>(step)));
}

enum class How {
  in_order,   ///< take() of what is final
  unordered,  ///< take_unordered() of what has been produced
};

/// Passes one tile through a sink in rounds, as the renderer does. Each round adds the segments that begin in front of
/// the round's depth, and some of those behind it.
template <class Encoding>
void send_tile(TileSink<Encoding>& sink, const Scene& scene, int rounds, How how) {
  typename Encoding::Store store;
  reset(store, scene);
  scene::StageTimer timer(nullptr);
  sink.begin_tile(3, Scene::rect);
  sink.start(Scene::rect);
  auto left = scene.rays;
  std::mt19937 random(1);
  for (int round = 1; round <= rounds; ++round) {
    const std::int64_t step =
        round == rounds ? std::int64_t{1} << 31 : (round * (std::int64_t{1} << 30)) / rounds - (1 << 29);
    for (std::size_t p = 0; p < left.size(); ++p) {
      const auto later = std::partition(left[p].begin(), left[p].end(),
                                        [&](const LatticeSegment& s) { return s.front < step || random() % 4 == 0; });
      for (auto s = left[p].begin(); s != later; ++s) push(store, scene, p, *s);
      left[p].erase(left[p].begin(), later);
    }
    if (how == How::in_order) {
      sink.take(store, depth_of<Encoding>(scene, step), 1, timer);
      continue;
    }
    ASSERT_TRUE(sink.take_unordered(store, depth_of<Encoding>(scene, step), timer));
    EXPECT_EQ(waiting_in(store), 0u);
  }
  sink.finish();
  sink.end_tile();
}

/// Expects that all parts belong to tile 3, that one part is the last, and that no part begins in front of a depth that
/// an earlier part declared complete.
void expect_promises_kept(const Parts& parts, const std::vector<Sent>& sent) {
  ASSERT_FALSE(parts.parts.empty());
  for (std::size_t i = 0; i < parts.parts.size(); ++i) {
    EXPECT_EQ(parts.parts[i].tile, 3u);
    EXPECT_EQ(parts.parts[i].last, i + 1 == parts.parts.size());
    if (i > 0) {
      EXPECT_GE(parts.parts[i].final_depth, parts.parts[i - 1].final_depth);
    }
  }
  EXPECT_EQ(parts.parts.back().final_depth, infinity);
  for (const Sent& s : sent)
    if (s.part > 0) {
      EXPECT_GE(s.front, parts.parts[s.part - 1].final_depth);
    }
}

template <class Encoding>
class Sinks : public ::testing::Test {
 public:
  static std::unique_ptr<TileSink<Encoding>> segments(const Scene& scene, Parts& parts) {
    if constexpr (std::is_same_v<Encoding, LatticeEncoding>)
      return std::make_unique<SegmentSink<Encoding>>(scene.lattice, parts.deliver());
    else
      return std::make_unique<SegmentSink<Encoding>>(false, std::span<const std::uint64_t>{}, parts.deliver());
  }
  static std::unique_ptr<TileSink<Encoding>> runs(const Scene& scene, Parts& parts, std::uint64_t bytes_between_cuts,
                                                  double left_out = 1e30) {
    return std::make_unique<RunSink<Encoding>>(scene.tile_scene(left_out), bytes_between_cuts, parts.deliver());
  }
};
using Encodings = ::testing::Types<DoubleEncoding, LatticeEncoding>;
TYPED_TEST_SUITE(Sinks, Encodings);

TYPED_TEST(Sinks, EachSegmentIsSentOnceInAnyOrder) {
  for (const std::size_t most : {1, 20, 300})
    for (const How how : {How::in_order, How::unordered}) {
      const Scene scene(static_cast<std::uint32_t>(most), most, 5);
      Parts parts;
      send_tile(*this->segments(scene, parts), scene, 4, how);
      const std::vector<Sent> sent = parts.sent(scene);
      std::vector<Sent> expected;
      for (std::size_t p = 0; p < Scene::pixels; ++p)
        for (const LatticeSegment& s : scene.rays[p])
          expected.push_back({p, scene.lattice.depth(s.front), scene.lattice.depth(s.back)});
      std::sort(expected.begin(), expected.end(), [](const Sent& a, const Sent& b) { return a.place() < b.place(); });
      ASSERT_EQ(sent.size(), expected.size());
      for (std::size_t i = 0; i < sent.size(); ++i) ASSERT_EQ(sent[i].place(), expected[i].place()) << i;
      expect_promises_kept(parts, sent);
    }
}

/// Records store floats, and segments on the lattice are integrated in float lanes: window_kernel_test measures the
/// errors.
constexpr double light_error = 1e-6;
/// A run's thickness is stored as a float; the front of a lattice run is rounded to a step.
constexpr double depth_error = 2e-7;

void expect_same(const Sent& sent, const Sent& expected) {
  ASSERT_EQ(sent.pixel, expected.pixel);
  ASSERT_NEAR(sent.front, expected.front, depth_error);
  EXPECT_NEAR(sent.back, expected.back, depth_error);
  EXPECT_NEAR(sent.red, expected.red, light_error);
  EXPECT_NEAR(sent.green, expected.green, light_error);
  EXPECT_NEAR(sent.blue, expected.blue, light_error);
  EXPECT_NEAR(sent.opacity, expected.opacity, light_error);
}

TYPED_TEST(Sinks, SegmentsThatTouchTravelAsOneRun) {
  for (const std::size_t most : {1, 20, 300})
    for (const int rounds : {1, 5}) {
      const Scene scene(static_cast<std::uint32_t>(most), most, 2);
      Parts parts;
      send_tile(*this->runs(scene, parts, std::uint64_t{1} << 40), scene, rounds, How::in_order);
      const std::vector<Sent> sent = parts.sent(scene);
      std::vector<Sent> expected;
      for (std::size_t p = 0; p < Scene::pixels; ++p)
        for (const auto& run : scene.composited(p, true)) {
          expected.push_back(Scene::shown(run));
          // A run with one visible segment may be sent as that segment, or together with the clear segments behind it.
          if (run.showing == 1) expected.back().back = 0;
        }
      std::sort(expected.begin(), expected.end(), [](const Sent& a, const Sent& b) { return a.place() < b.place(); });
      ASSERT_EQ(sent.size(), expected.size()) << most;
      for (std::size_t i = 0; i < sent.size(); ++i) {
        if (expected[i].back == 0) expected[i].back = sent[i].back;
        expect_same(sent[i], expected[i]);
      }
      expect_promises_kept(parts, sent);
    }
}

/// The light of a ray, composited front to back from the records that were sent.
Sent joined(const std::vector<Sent>& sent, std::size_t pixel) {
  Sent whole{pixel, infinity};
  double transmittance = 1;
  for (const Sent& s : sent)
    if (s.pixel == pixel) {
      whole.front = std::min(whole.front, s.front);
      whole.red += transmittance * s.red, whole.green += transmittance * s.green, whole.blue += transmittance * s.blue;
      transmittance *= 1 - s.opacity;
    }
  whole.opacity = 1 - transmittance;
  return whole;
}

TYPED_TEST(Sinks, RunsCutInDepthKeepTheirTotal) {
  for (const How how : {How::in_order, How::unordered}) {
    const Scene scene(7, 200, 1);
    Parts parts, uncut;
    send_tile(*this->runs(scene, parts, 1), scene, 6, how);  // with a cut at each taking
    send_tile(*this->runs(scene, uncut, std::uint64_t{1} << 40), scene, 6, How::in_order);
    const std::vector<Sent> sent = parts.sent(scene), runs = uncut.sent(scene);
    EXPECT_GT(sent.size(), runs.size());
    for (std::size_t p = 0; p < Scene::pixels; ++p) {
      const auto expected = scene.composited(p, false);
      const Sent whole = joined(sent, p);
      if (expected.empty()) {
        EXPECT_EQ(whole.front, infinity);
        continue;
      }
      // A ray is sent as several runs, each with the error of one run.
      EXPECT_NEAR(whole.front, expected[0].front, depth_error);
      EXPECT_NEAR(whole.red, expected[0].red, 4 * light_error);
      EXPECT_NEAR(whole.opacity, 1 - expected[0].transmittance, 4 * light_error);
    }
    expect_promises_kept(parts, sent);
  }
}

TYPED_TEST(Sinks, CutsFreeTheCompositorBeforeTheTileEnds) {
  const Scene scene(7, 300, 1);
  Parts parts;
  auto sink = this->runs(scene, parts, 1);
  send_tile(*sink, scene, 30, How::in_order);
  ASSERT_GT(parts.parts.size(), 2u);  // 64 KiB each
  EXPECT_GT(parts.parts[0].final_depth, -infinity);
  EXPECT_GT(parts.parts[1].final_depth, parts.parts[0].final_depth);
}

TYPED_TEST(Sinks, SendsNothingBehindOpaqueRunsUnlessThoseMayComeLater) {
  Scene scene(3, 200, 2000);                                          // opaque after a few segments
  const double weight = scene.integrator.termination_error() / 1e-4;  // pixels close at a transmittance of 1e-4
  std::size_t in_all = 0, in_order = 0, unordered = 0;
  for (std::size_t p = 0; p < Scene::pixels; ++p) in_all += scene.composited(p, true).size();
  {
    Parts parts;
    auto sink = this->runs(scene, parts, std::uint64_t{1} << 40, weight);
    send_tile(*sink, scene, 8, How::in_order);
    const std::vector<Sent> sent = parts.sent(scene);
    in_order = sent.size();
    for (std::size_t p = 0; p < Scene::pixels; ++p) {
      const auto expected = scene.composited(p, false);
      if (expected.empty()) continue;
      const Sent whole = joined(sent, p);
      EXPECT_NEAR(whole.red, expected[0].red, 1e-4 + 4 * light_error);
      EXPECT_NEAR(whole.opacity, 1 - expected[0].transmittance, 1e-4 + 4 * light_error);
    }
    // Segments of closed pixels count as taken.
    EXPECT_EQ(sink->segments(), scene.total());
  }
  {
    Parts parts;
    send_tile(*this->runs(scene, parts, std::uint64_t{1} << 40, weight), scene, 1, How::unordered);
    unordered = parts.sent(scene).size();
  }
  EXPECT_LT(2 * in_order, in_all);
  EXPECT_EQ(unordered, in_all);
}

}  // namespace
}  // namespace tessera::compositor::sinks_test
