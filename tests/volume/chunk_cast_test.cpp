// SPDX-License-Identifier: BSD-3-Clause
// One frame in chunks: a small version of each use of the interface listed in chunk_cast.hpp.
#include "volume/chunk_cast.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>

#include "scene/error.hpp"
#include "scene/frame_watch.hpp"
#include "support/instruction_sets.hpp"
#include "support/some_cases.hpp"
#include "volume/bricks/cell_ranges.hpp"
#include "volume/image_sink.hpp"
#include "volume/small_volume.hpp"

namespace tessera::chunk_cast_test {
namespace {

using namespace tests;  // small volumes and views
using volume::boxes_front_to_back;
using volume::ChunkCast;
using volume::VoxelBox;

/// The pixel of a sort-last process: composites each fragment behind the previous ones.
class Composite final : public volume::FragmentSink {
 public:
  explicit Composite(scene::ImageSize image_size) : image(image_size), back(image.depth.size(), -HUGE_VALF) {}

  void take(std::span<const volume::RayFragment> fragments) override {
    for (const volume::RayFragment& f : fragments) {
      const std::size_t pixel = image.index(f.x, f.y);
      float* const rgba = &image.rgba[4 * pixel];
      const float through = 1 - rgba[3], own[4] = {f.red, f.green, f.blue, f.alpha};
      for (int c = 0; c < 4; ++c) rgba[c] += through * own[c];
      if (rgba[3] > 0 && std::isinf(image.depth[pixel])) image.depth[pixel] = f.z_front;
      // Depths are floats between 3 and 7, so 1e-5 allows for their rounding.
      if (f.z_front < back[pixel] - 1e-5f || f.z_back < back[pixel] - 1e-5f) in_order = false;
      back[pixel] = f.z_back;
      ++count;
    }
  }

  scene::Image image;
  std::vector<float> back;  ///< where the last fragment ended
  std::atomic<bool> in_order = true;
  std::atomic<std::size_t> count = 0;
};

/// Sort-last: each chunk's fragments by a separate cast, independent of the others.
void cast_apart(const Volume& v, const volume::RenderSettings& settings, const scene::Camera& camera,
                const scene::TransferFunction& function, const std::vector<VoxelBox>& chunks, Composite& sink) {
  for (const VoxelBox& chunk : chunks) {
    volume::Renderer renderer(*v.source, settings);
    ChunkCast cast(renderer, camera, size, function);
    cast.advance(chunk);
    cast.emit(sink);
  }
}

/// One cast through all chunks; emits after each, or only at the end.
void cast_on(const Volume& v, const volume::RenderSettings& settings, const scene::Camera& camera,
             const scene::TransferFunction& function, const std::vector<VoxelBox>& chunks, bool emit_each,
             volume::FragmentSink& sink) {
  volume::Renderer renderer(*v.source, settings);
  ChunkCast cast(renderer, camera, size, function);
  for (const VoxelBox& chunk : chunks) {
    cast.advance(chunk);
    if (emit_each) cast.emit(sink);
  }
  if (!emit_each) cast.emit(sink);
}

scene::Image image_of(const Volume& v, const volume::RenderSettings& settings, const scene::Camera& camera,
                      const scene::TransferFunction& function, const std::vector<VoxelBox>& chunks) {
  scene::Image image(size);
  scene::FrameWatch unwatched;
  volume::ImageSink sink(image, nullptr, unwatched);
  cast_on(v, settings, camera, function, chunks, false, sink);
  return image;
}

double difference(const scene::Image& a, const scene::Image& b) {
  double worst = 0;
  for (std::size_t n = 0; n < a.rgba.size(); ++n)
    worst = std::max(worst, std::abs(static_cast<double>(a.rgba[n]) - b.rgba[n]));
  return worst;
}

volume::RenderSettings with(IntegratorKind method, bool shaded = false) {
  volume::RenderSettings s;
  s.integrator.kind = method;
  s.grid.step = 0.7;
  s.threads = 2;
  if (shaded) s.grid.shading = Shading{};
  return s;
}

/// Two chunks, and many, whose planes have no common multiples.
std::vector<scene::GridIndex> chunk_sizes(const scene::GridIndex& voxels) {
  return {{(voxels[0] + 1) / 2, voxels[1], voxels[2]}, {voxels[0], voxels[1], 16}, {16, 16, 16}, {13, 7, 11}};
}

TEST(ChunkCast, FragmentsOfChunksCompositedGiveThePicture) {
  const Volume v = make_volume({37, 30, 36}, Field::smooth);
  test::SomeCases some(5);
  for (const char* name : views)
    for (const auto& function : {smooth_function(), sharp_function()}) {
      if (!some.next()) continue;
      const scene::Camera camera = view(name);
      const scene::Image whole = render(v, camera, function, exact());
      for (const scene::GridIndex& sides : chunk_sizes(v.grid.geometry.voxels())) {
        Composite sink(size);
        cast_apart(v, with(IntegratorKind::exact), camera, function,
                   boxes_front_to_back(v.grid.geometry, sides, camera), sink);
        // Rounding of positions where rays pass from chunk to chunk, and of transmittances: a few last places of 1.
        EXPECT_LT(difference(sink.image, whole), 1e-6) << name << ", chunks of " << sides[0] << ' ' << sides[1];
        EXPECT_TRUE(sink.in_order) << name << ", chunks of " << sides[0] << ' ' << sides[1];
        EXPECT_GT(sink.count, 0u);
      }
    }
}

TEST(ChunkCast, EveryInstructionSetCastsChunks) {
  const Volume v = make_volume({37, 30, 36}, Field::smooth);
  const scene::Camera camera = view("perspective");
  tests::for_each_instruction_set([&](const char* name) {
    const scene::Image whole = render(v, camera, sharp_function(), exact());
    Composite sink(size);
    cast_apart(v, with(IntegratorKind::exact), camera, sharp_function(),
               boxes_front_to_back(v.grid.geometry, {13, 7, 11}, camera), sink);
    EXPECT_LT(difference(sink.image, whole), 1e-6) << name;
  });
}

TEST(ChunkCast, CellDataShadingAndSamplesGoInChunksToo) {
  const Volume points = make_volume({37, 30, 36}, Field::smooth), cells = make_volume({19, 17, 20}, Field::noise, true);
  test::SomeCases some(3);
  for (const char* name : {"oblique", "from -x", "perspective"}) {
    const scene::Camera camera = view(name);
    const auto check = [&](const Volume& v, const volume::RenderSettings& settings, const char* what) {
      const scene::Image whole = render(v, camera, smooth_function(), settings);
      for (const scene::GridIndex& sides : chunk_sizes(v.grid.geometry.voxels())) {
        if (!some.next()) continue;
        Composite sink(size);
        cast_apart(v, settings, camera, smooth_function(), boxes_front_to_back(v.grid.geometry, sides, camera), sink);
        EXPECT_LT(difference(sink.image, whole), 1e-6) << what << ' ' << name << ' ' << sides[0];
      }
    };
    check(cells, with(IntegratorKind::exact), "cell data");
    check(points, with(IntegratorKind::exact, true), "shaded");
    check(points, with(IntegratorKind::sampled), "sampled");
  }
}

TEST(ChunkCast, PreintegrationGoesOnFromTheRaysState) {
  const Volume v = make_volume({37, 30, 36}, Field::smooth);
  const auto check = [&](const char* name, const scene::TransferFunction& function, double most) {
    const scene::Camera camera = view(name);
    const scene::Image whole = render(v, camera, function, with(IntegratorKind::preintegrated));
    for (const scene::GridIndex& sides : chunk_sizes(v.grid.geometry.voxels())) {
      Composite sink(size);
      cast_on(v, with(IntegratorKind::preintegrated), camera, function,
              boxes_front_to_back(v.grid.geometry, sides, camera), true, sink);
      EXPECT_LT(difference(sink.image, whole), most) << name << ' ' << sides[0];
    }
  };
  for (const char* name : {"oblique", "from y", "perspective"}) {
    check(name, smooth_function(), 1e-6);
    // Positions of steps are floats relative to the first step in the chunk, with an error of 1e-6 voxel. Peaks are a
    // fiftieth of the range wide.
    check(name, sharp_function(), 1e-5);
  }
}

TEST(ChunkCast, RectilinearGridsGoInChunksToo) {
  Volume v = make_volume({25, 21, 23}, Field::smooth);
  for (std::size_t a = 0; a < 3; ++a) {
    const scene::GridGeometry& g = v.grid.geometry;
    std::vector<double> planes;
    for (std::int64_t n = 0; n < g.points[a]; ++n)
      planes.push_back(g.spacing[static_cast<int>(a)] *
                       (static_cast<double>(n) + 0.8 * std::sin(static_cast<double>(n))));
    v.grid.geometry.coordinates[a] = planes;
  }
  v.source = scene::MemorySource::of(v.grid, v.values);
  test::SomeCases some(4);
  for (const char* name : {"oblique", "along z", "perspective", "inside", "clipped"}) {
    const scene::Camera camera = view(name);
    const scene::Image whole = render(v, camera, smooth_function(), exact());
    for (const scene::GridIndex& sides : chunk_sizes(v.grid.geometry.voxels())) {
      if (!some.next()) continue;
      const std::vector<VoxelBox> chunks = boxes_front_to_back(v.grid.geometry, sides, camera);
      Composite sink(size);
      cast_apart(v, with(IntegratorKind::exact), camera, smooth_function(), chunks, sink);
      EXPECT_LT(difference(sink.image, whole), 1e-6) << name << ' ' << sides[0];
      EXPECT_TRUE(sink.in_order) << name << ' ' << sides[0];
      EXPECT_LT(difference(image_of(v, with(IntegratorKind::exact), camera, smooth_function(), chunks), whole), 1e-6);
    }
  }
}

TEST(ChunkCast, UncertainRaysAreCastAgainWithinTheirChunk) {
  // Surfaces of a step in every voxel.
  const Volume v = make_volume({21, 18, 17}, Field::noise);
  const scene::TransferFunction steps({{0.5, {0.1, 0.3, 0.9}, 0}, {0.5, {1, 0.5, 0.2}, 400}});
  const scene::Camera camera = view("oblique");
  volume::RenderStatistics statistics;
  const scene::Image whole = render(v, camera, steps, exact(), &statistics);
  ASSERT_GT(statistics.pixels_again, 0u);
  volume::Renderer renderer(*v.source, with(IntegratorKind::exact));
  ChunkCast cast(renderer, camera, size, steps);
  Composite sink(size);
  for (const VoxelBox& chunk : boxes_front_to_back(v.grid.geometry, {11, 18, 17}, camera)) {
    cast.advance(chunk);
    cast.emit(sink);
  }
  EXPECT_GT(cast.counters().pixels_again, 0u);
  // Each of the two images may have the method's error of 1e-5, because their uncertain rays differ.
  EXPECT_LT(difference(sink.image, whole), 2e-5);
}

TEST(ChunkCast, AContinuedRayHasTheBitsOfAnUninterruptedOne) {
  const Volume points = make_volume({65, 65, 65}, Field::smooth), cells = make_volume({64, 64, 64}, Field::noise, true);
  const std::pair<const char*, std::size_t> cases[] = {{"oblique", 2}, {"from -x", 0}, {"from y", 1}, {"along z", 2}};
  test::SomeCases some(2);
  for (const auto& c : cases) {
    if (!some.next()) continue;
    const char* const name = c.first;  // clang 14 does not allow a lambda to capture a structured binding
    const scene::Camera camera = view(name);
    scene::GridIndex sides{64, 64, 64};
    sides[c.second] = 32;
    const auto check = [&](const Volume& v, const volume::RenderSettings& settings, const char* what) {
      const std::vector<VoxelBox> chunks = boxes_front_to_back(v.grid.geometry, sides, camera);
      ASSERT_EQ(chunks.size(), 2u);
      EXPECT_TRUE(same_bits(image_of(v, settings, camera, sharp_function(), chunks),
                            render(v, camera, sharp_function(), settings)))
          << what << ' ' << name;
    };
    check(points, with(IntegratorKind::exact), "exact");
    check(points, with(IntegratorKind::automatic), "automatic");
    check(points, with(IntegratorKind::exact, true), "shaded");
    check(points, with(IntegratorKind::sampled), "sampled");
    check(points, with(IntegratorKind::preintegrated), "preintegrated");
    check(cells, with(IntegratorKind::exact), "cell data");
  }
}

TEST(ChunkCast, AChunkOfAllIsTheDefaultFrame) {
  const Volume v = make_volume({37, 30, 26}, Field::noise);
  for (const char* name : views)
    EXPECT_TRUE(same_bits(image_of(v, with(IntegratorKind::automatic), view(name), smooth_function(),
                                   {VoxelBox::all_of(v.grid.geometry)}),
                          render(v, view(name), smooth_function())))
        << name;
}

TEST(ChunkCast, ClosedRaysDoNoMoreWorkAndKeepWhatTheyHave) {
  // Occlusion: an object hides the left half of the image behind the first chunk.
  const Volume v = make_volume({37, 30, 36}, Field::smooth);
  const scene::Camera camera = view("oblique");
  const std::vector<VoxelBox> chunks = boxes_front_to_back(v.grid.geometry, {36, 29, 16}, camera);
  ASSERT_GT(chunks.size(), 2u);
  const scene::Image first = image_of(v, with(IntegratorKind::exact), camera, smooth_function(), {chunks[0]}),
                     all = image_of(v, with(IntegratorKind::exact), camera, smooth_function(), chunks);
  volume::Renderer renderer(*v.source, with(IntegratorKind::exact));
  ChunkCast cast(renderer, camera, size, smooth_function());
  cast.advance(chunks[0]);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width / 2; ++x) cast.close(x, y);
  EXPECT_FALSE(cast.open(size.width / 2 - 1, size.height / 2));
  EXPECT_TRUE(cast.open(size.width / 2, size.height / 2));
  for (std::size_t n = 1; n < chunks.size(); ++n) cast.advance(chunks[n]);
  scene::Image image(size);
  scene::FrameWatch unwatched;
  volume::ImageSink sink(image, nullptr, unwatched);
  cast.emit(sink);
  bool differs = false;
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      for (std::size_t n = 4 * image.index(x, y), c = 0; c < 4; ++c) {
        if (x < size.width / 2) {
          EXPECT_EQ(image.rgba[n + c], first.rgba[n + c]) << x << ' ' << y;
        } else if (x >= size.width / 2 + 4) {
          // If other lanes have left a packet, the remaining lanes compute the same light in different pieces.
          EXPECT_NEAR(image.rgba[n + c], all.rgba[n + c], 1e-6) << x << ' ' << y;
        }
        differs = differs || first.rgba[n + c] != all.rgba[n + c];
      }
  EXPECT_TRUE(differs) << "the other chunks show nothing";

  ChunkCast closed(renderer, camera, size, smooth_function());
  closed.advance(chunks[0]);
  const GridCounters before = closed.counters();
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) closed.close(x, y);
  EXPECT_FALSE(closed.any_open());
  for (std::size_t n = 1; n < chunks.size(); ++n) closed.advance(chunks[n]);
  EXPECT_GT(before.samples, 0u);
  EXPECT_EQ(closed.counters().samples, before.samples);
  EXPECT_EQ(closed.counters().voxels_visited, before.voxels_visited);
}

TEST(ChunkCast, RaysEndEarlyInWhateverChunks) {
  const Volume v = make_volume({65, 65, 65}, Field::smooth);
  const scene::TransferFunction opaque({{0, {0.2, 0.4, 1}, 60}, {1, {1, 0.5, 0.2}, 90}});
  const scene::Camera camera = view("oblique");
  volume::RenderStatistics in_one;
  render(v, camera, opaque, exact(), &in_one);
  volume::RenderSettings endless = exact();
  endless.use.termination = false;
  volume::RenderStatistics to_the_end;
  render(v, camera, opaque, endless, &to_the_end);
  ASSERT_LT(3 * in_one.samples, to_the_end.samples);  // the ratio is 3.5 with AVX2, above 4 with AVX-512
  for (const bool emit_each : {false, true}) {
    volume::Renderer renderer(*v.source, with(IntegratorKind::exact));
    ChunkCast cast(renderer, camera, size, opaque);
    Composite sink(size);
    std::size_t needed = 0;
    const std::vector<VoxelBox> chunks = boxes_front_to_back(v.grid.geometry, {16, 16, 16}, camera);
    while (needed < chunks.size() && cast.any_open()) {
      cast.advance(chunks[needed++]);
      if (emit_each) {
        cast.emit(sink);
        for (int y = 0; y < size.height; ++y)
          for (int x = 0; x < size.width; ++x)
            if (!cast.open(x, y)) cast.close(x, y);
      }
    }
    // Only central rays are checked: the rays that graze the volume's far edges end last.
    for (int y = size.height / 2 - 9; y < size.height / 2 + 9; ++y)
      for (int x = size.width / 2 - 9; x < size.width / 2 + 9; ++x) EXPECT_FALSE(cast.open(x, y));
    // Pieces also end at the planes of chunks, so there are more of them. A ray that continued to its end would have
    // four times as many.
    EXPECT_LT(static_cast<double>(cast.counters().samples), 1.6 * static_cast<double>(in_one.samples)) << emit_each;
  }
}

TEST(ChunkCast, TransmittanceAfterAChunkIsTheRemainingLight) {
  // Shadows: the camera is the light, and the box is homogeneous, with extinction 2.
  Volume v = make_volume({17, 17, 33}, Field::smooth);
  std::fill(v.values.begin(), v.values.end(), 0.5f);
  v.source = scene::MemorySource::of(v.grid, v.values);
  const scene::Camera light = view("along z");
  const scene::TransferFunction function({{0, {1, 1, 1}, 2}});
  for (const bool emit_each : {false, true}) {
    volume::Renderer renderer(*v.source, with(IntegratorKind::exact));
    ChunkCast cast(renderer, light, size, function);
    Composite sink(size);
    double depth = 0;
    for (const VoxelBox& chunk : boxes_front_to_back(v.grid.geometry, {16, 16, 5}, light)) {
      cast.advance(chunk);
      if (emit_each) cast.emit(sink);
      depth += 2 * v.grid.geometry.spacing.z * static_cast<double>(chunk.high[2] - chunk.low[2]);
      EXPECT_NEAR(cast.transmittance(48, 40), std::exp(-depth), 1e-6) << chunk.low[2];
      EXPECT_EQ(cast.transmittance(0, 0), 1.0f) << "beside the volume";
    }
    EXPECT_NEAR(depth, 2 * 1.2, 1e-9);
  }
}

/// A volume that is only partly in this process.
class PartOfVolume final : public scene::SampleSource {
 public:
  PartOfVolume(const scene::SampleSource& all, const scene::SampleBox& part)
      : SampleSource(all.grid(), "part"), all_(all), part_(part) {}
  mutable std::atomic<int> read_inside = 0, read_outside = 0;

 private:
  void read_samples(const scene::SampleBox& box, const scene::SampleLayout& layout,
                    std::byte* destination) const override {
    bool inside = true;
    for (std::size_t a = 0; a < 3; ++a) inside = inside && box.low[a] >= part_.low[a] && box.high[a] <= part_.high[a];
    ++(inside ? read_inside : read_outside);
    all_.read(box, layout, {destination, static_cast<std::size_t>(1) << 40});
  }

  const scene::SampleSource& all_;
  scene::SampleBox part_;
};

TEST(ChunkCast, AChunkReadsItsOwnBricksAlone) {
  const Volume v = make_volume({49, 49, 49}, Field::noise);
  volume::RenderSettings settings = with(IntegratorKind::exact);
  settings.grid.brick_size = 16;
  const auto ranges = std::make_shared<const volume::CellRanges>(*v.source);
  for (const char* name : {"oblique", "from -x", "inside"})
    for (const VoxelBox& chunk : boxes_front_to_back(v.grid.geometry, {16, 16, 32}, view(name))) {
      // A brick shares its border samples with its neighbours.
      const PartOfVolume part(*v.source, {chunk.low, {chunk.high[0] + 1, chunk.high[1] + 1, chunk.high[2] + 1}});
      volume::Renderer renderer(part, settings, ranges);
      ChunkCast cast(renderer, view(name), size, smooth_function());
      cast.advance(chunk);
      EXPECT_EQ(part.read_outside, 0) << name << ' ' << chunk.low[0] << ' ' << chunk.low[1] << ' ' << chunk.low[2];
      if (cast.counters().samples > 0) {
        EXPECT_GT(part.read_inside, 0);
      }
    }
}

TEST(ChunkCast, StopsOnRequestAndRefusesInvalidChunks) {
  const Volume v = make_volume({21, 18, 17}, Field::noise);
  volume::Renderer renderer(*v.source, with(IntegratorKind::exact));
  ChunkCast cast(renderer, view("oblique"), size, smooth_function());
  EXPECT_THROW(cast.advance({{0, 0, 0}, {21, 17, 16}}), scene::Error) << "21 samples are 20 voxels";
  EXPECT_THROW(cast.advance({{-1, 0, 0}, {20, 17, 16}}), scene::Error);
  EXPECT_THROW(cast.advance({{4, 0, 0}, {4, 17, 16}}), scene::Error) << "empty";
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(cast.advance(VoxelBox::all_of(v.grid.geometry), stop.get_token()), scene::FrameStopped);
  const scene::Image after = renderer.render(view("oblique"), size, smooth_function()).image;
  EXPECT_TRUE(same_bits(after, render(v, view("oblique"), smooth_function(), exact())));
}

}  // namespace
}  // namespace tessera::chunk_cast_test
