// SPDX-License-Identifier: BSD-3-Clause
#include "frame/ranks/distributed.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "datasets/boxes.hpp"
#include "datasets/modify.hpp"
#include "datasets/shapes.hpp"
#include "exchange/loopback_transport.hpp"
#include "frame/image_difference.hpp"
#include "frame/leaning_stack.hpp"
#include "frame/plateaus.hpp"
#include "projection/scanline/segment_tuple.hpp"
#include "reference/judge.hpp"
#include "scene/error.hpp"
#include "scene/mesh_facts.hpp"
#include "support/some_cases.hpp"

namespace tessera::frame::distributed_test {
namespace {

using scene::Camera;
using scene::Image;
using scene::ImageSize;
using scene::TransferFunction;

Camera oblique() {
  Camera camera;
  camera.position = {3.1, 2.3, 4.2};
  camera.parallel_scale = 1.8;
  return camera;
}

Camera inside() {
  Camera camera;
  camera.position = {0.1, 0.2, 0.15};
  camera.projection = scene::ProjectionKind::perspective;
  camera.view_angle = 80;
  return camera;
}

TransferFunction six_knots() {
  return TransferFunction({{0, {0, 0, 0.3}, 0},
                           {0.3, {0.1, 0.3, 0.9}, 0.4},
                           {0.5, {0.2, 0.9, 0.3}, 0},
                           {0.7, {0.9, 0.8, 0.1}, 3},
                           {0.8, {1, 0.3, 0}, 0.2},
                           {1, {1, 1, 1}, 8}});
}

Settings exact() {
  Settings settings;
  settings.integrator.kind = scene::IntegratorKind::exact;
  settings.threads = 1;
  settings.memory_bytes = 256ull << 20;
  return settings;
}

using Parts = std::vector<scene::TetMesh>;

/// Contiguous ranges of equal size in file order. Parts store each tet's index in the whole mesh as original_cell, like
/// datasets::parts.
Parts slices(const scene::TetMesh& mesh, std::size_t count) {
  Parts parts(count, mesh);
  for (std::size_t part = 0; part < count; ++part) {
    const std::size_t first = part * mesh.tets.size() / count, last = (part + 1) * mesh.tets.size() / count;
    const auto cut = [&](auto& list) {
      list = {list.begin() + static_cast<std::ptrdiff_t>(first), list.begin() + static_cast<std::ptrdiff_t>(last)};
    };
    cut(parts[part].tets);
    if (mesh.association == scene::Association::cell) cut(parts[part].scalars);
    parts[part].original_cell.resize(last - first);
    std::iota(parts[part].original_cell.begin(), parts[part].original_cell.end(), first);
  }
  return parts;
}

struct Shape {
  int ranks, projectors, compositors;
};

void PrintTo(const Shape& shape, std::ostream* out) {
  *out << shape.projectors << "x" << shape.compositors << " on " << shape.ranks;
}

std::vector<FinishedFrame> render_once(const Parts& parts, const Shape& shape, const DistributedSettings& settings,
                                       const std::vector<FrameJob>& jobs, const TransferFunction& function,
                                       double diagonal, float longest_edge) {
  std::vector<FinishedFrame> frames;
  scene::MeshFacts whole;
  for (const scene::TetMesh& part : parts) whole = scene::joined(whole, scene::facts_of(part));
  exchange::run_ranks(shape.ranks, [&](exchange::Transport& transport) {
    DistributedSettings mine = settings;
    mine.roles = assign_roles(shape.ranks, shape.projectors, shape.compositors);
    render_distributed(
        transport, mine, jobs, function,
        [&](std::size_t) {
          ProjectorMesh mesh;
          const auto rank = static_cast<std::size_t>(transport.rank());
          static const scene::TetMesh none;
          const scene::TetMesh& part = rank < parts.size() ? parts[rank] : none;
          mesh.part = part;
          mesh.global_tet = part.original_cell;
          mesh.diagonal = diagonal;
          mesh.box = whole.box;
          mesh.scalar_range = whole.scalar_range;
          mesh.longest_edge = longest_edge;
          return mesh;
        },
        [&](FinishedFrame frame) { frames.push_back(std::move(frame)); });
  });
  return frames;
}

bool same_bits(const Image& a, const Image& b) { return a.rgba == b.rgba && a.depth == b.depth; }

/// Renders with projectors that share nothing, as on different machines. Compares the images with those of projectors
/// that work together.
std::vector<FinishedFrame> render(const Parts& parts, const Shape& shape, DistributedSettings settings,
                                  const std::vector<FrameJob>& jobs, const TransferFunction& function,
                                  double diagonal = 4, float longest_edge = 0) {
  settings.render.use.sharing = false;
  auto frames = render_once(parts, shape, settings, jobs, function, diagonal, longest_edge);
  if (shape.projectors < 2) return frames;
  settings.render.use.sharing = true;
  const auto shared = render_once(parts, shape, settings, jobs, function, diagonal, longest_edge);
  EXPECT_EQ(shared.size(), frames.size());
  for (std::size_t i = 0; i < std::min(shared.size(), frames.size()); ++i) {
    const Image &one = frames[i].image, &other = shared[i].image;
    EXPECT_EQ(one.rgba.size(), other.rgba.size());
    // Otherwise, the light of each part's runs is rounded.
    if (settings.exchange == Exchange::segments && settings.render.mesh.rasterizer != Rasterizer::scanline)
      EXPECT_TRUE(same_bits(one, other)) << "frame " << i;
    else
      EXPECT_LE(difference(one, other), 2e-6) << "frame " << i;
    const FrameStatistics &a = frames[i].statistics, &b = shared[i].statistics;
    EXPECT_EQ(a.tets_total, b.tets_total);
    EXPECT_EQ(a.tets_projected, b.tets_projected);
    EXPECT_EQ(a.tets_invisible, b.tets_invisible);
    EXPECT_EQ(a.on_lattice, b.on_lattice);
  }
  return frames;
}

constexpr Shape shapes[] = {{2, 1, 1}, {4, 1, 3}, {4, 3, 1}, {6, 4, 2}, {3, 3, 3}, {8, 8, 8}, {5, 5, 2}, {1, 1, 1}};

class AnyShape : public ::testing::TestWithParam<Shape> {};
INSTANTIATE_TEST_SUITE_P(Distributed, AnyShape, ::testing::ValuesIn(shapes));

TEST_P(AnyShape, SegmentsGiveTheBitsOfASingleProcessAndRunsAlmost) {
  const Shape shape = GetParam();
  const auto n = static_cast<std::size_t>(shape.projectors);
  const ImageSize size{97, 61};
  test::SomeCases some(5);
  for (const bool cells : {false, true}) {
    scene::TetMesh mesh = datasets::cube(8, 0.2);
    if (cells) mesh = datasets::with_cell_data(std::move(mesh), 6);
    for (const Camera& camera : {oblique(), inside()}) {
      const Image expected = Renderer(mesh, exact()).render(camera, size, six_knots());
      for (const Parts& parts :
           {slices(mesh, n), datasets::parts(mesh, shape.projectors, datasets::Partition::random_blobs, 3),
            datasets::parts(mesh, shape.projectors, datasets::Partition::interleaved, 5)})
        for (const int threads : {1, 2}) {
          if (!some.next()) continue;
          Parts numbered = parts;
          if (cells) numbered = slices(mesh, n);  // with_cell_data() sets original_cell, and parts() would keep it
          DistributedSettings settings;
          settings.render = exact();
          settings.render.threads = threads;
          settings.render.mesh.tile_size = 16;
          settings.exchange = Exchange::segments;
          const auto segments = render(numbered, shape, settings, {{camera, size}}, six_knots());
          ASSERT_EQ(segments.size(), 1u);
          EXPECT_TRUE(same_bits(segments.front().image, expected)) << threads << " threads";
          settings.exchange = Exchange::runs;
          const auto runs = render(numbered, shape, settings, {{camera, size}}, six_knots());
          // Each run is rounded to float: 6e-8 of its light; at most a few dozen runs of a pixel matter.
          EXPECT_LT(difference(runs.front().image, expected), 2e-6);
          EXPECT_LE(runs.front().statistics.fragments, segments.front().statistics.fragments);
        }
    }
  }
}

TEST(Distributed, SegmentsOfAPlateauAtAStepGiveTheBitsOfASingleProcess) {
  const ImageSize size{61, 43};
  for (const int places : {1, 256})
    for (const bool lattice : {true, false}) {
      // In double precision, only values that differ in the last places of doubles are critical.
      const scene::TetMesh mesh = plateau(1, places, lattice ? LastPlace::of_float : LastPlace::of_double, false, 11);
      Settings alone = exact();
      alone.use.lattice = lattice;
      for (const Camera& camera : {oblique(), inside()}) {
        const Image expected = Renderer(mesh, alone).render(camera, size, step_at(1, true));
        for (const Exchange exchange : {Exchange::segments, Exchange::runs}) {
          DistributedSettings settings;
          settings.render = alone;
          settings.exchange = exchange;
          const auto frames = render(datasets::parts(mesh, 2, datasets::Partition::interleaved, 5), {2, 2, 2}, settings,
                                     {{camera, size}}, step_at(1, true));
          if (exchange == Exchange::segments)
            EXPECT_TRUE(same_bits(frames.front().image, expected)) << places << (lattice ? " on the lattice" : "");
          else
            EXPECT_LT(difference(frames.front().image, expected), 2e-6);
        }
      }
    }
}

TEST(Distributed, TuplesOfTheScanlineRasterizerGiveItsPictureOfASingleProcess) {
  const scene::TetMesh mesh = datasets::cube(8, 0.2);
  DistributedSettings settings;
  settings.render = exact();
  settings.render.mesh.rasterizer = Rasterizer::scanline;
  settings.render.integrator = {.kind = scene::IntegratorKind::sampled, .samples = 8};
  settings.exchange = Exchange::segments;
  const ImageSize size{90, 70};
  const Image expected = Renderer(mesh, settings.render).render(oblique(), size, six_knots());
  const auto frames = render(datasets::parts(mesh, 3, datasets::Partition::interleaved, 4), {5, 3, 2}, settings,
                             {{oblique(), size}}, six_knots(), 4, projection::longest_edge(mesh));
  // No ray of this mesh meets two segments with equal z_back; the paper does not define their order.
  EXPECT_TRUE(same_bits(frames.front().image, expected));
  settings.exchange = Exchange::runs;
  EXPECT_THROW(render(slices(mesh, 2), {2, 2, 2}, settings, {{oblique(), size}}, six_knots()), scene::Error);
}

TEST(Distributed, TabledIntegratorsGiveThePictureOfASingleProcess) {
  const scene::TetMesh mesh = datasets::cube(6, 0.2);
  const ImageSize size{60, 50};
  const Image exact_picture = Renderer(mesh, exact()).render(oblique(), size, six_knots());
  for (const auto kind : {scene::IntegratorKind::preintegrated, scene::IntegratorKind::partial}) {
    DistributedSettings settings;
    settings.render.integrator = {.kind = kind, .table_size = 64};
    Renderer alone(mesh, settings.render);
    const Image expected = alone.render(oblique(), size, six_knots());
    EXPECT_TRUE(same_bits(alone.render(oblique(), size, six_knots()), expected));  // the cached table
    // Entries of the table are 1 / 63 of the range apart, and ramps are a tenth of the range wide. So the error near a
    // kink is an eighth of 1 / 6 of a ramp's rise.
    EXPECT_LT(difference(expected, exact_picture), 2e-2);
    EXPECT_GT(difference(expected, exact_picture), 0);
    for (const Exchange exchange : {Exchange::segments, Exchange::runs}) {
      settings.exchange = exchange;
      const auto frames = render(datasets::parts(mesh, 3, datasets::Partition::random_blobs, 1), {5, 3, 2}, settings,
                                 {{oblique(), size}}, six_knots());
      if (exchange == Exchange::segments)
        EXPECT_TRUE(same_bits(frames.front().image, expected));
      else
        EXPECT_LT(difference(frames.front().image, expected), 2e-6);  // runs are rounded to float
    }
  }
}

TEST(Distributed, IsWithinTheReferencesBound) {
  const scene::TetMesh mesh = datasets::cube(10, 0.2);
  const reference::Reference reference(mesh, oblique(), {80, 60}, six_knots());
  for (const Exchange exchange : {Exchange::segments, Exchange::runs}) {
    DistributedSettings settings;
    settings.render = exact();
    settings.exchange = exchange;
    const auto frames = render(datasets::parts(mesh, 4, datasets::Partition::random_blobs, 1), {6, 4, 2}, settings,
                               {{oblique(), {80, 60}}}, six_knots());
    EXPECT_LT(reference::judge(frames.front().image, reference, 2e-5).max_error, 2e-5);
  }
}

/// Runs of all parts by the reference: intervals of touching segments of one part.
std::uint64_t reference_runs(const Parts& parts, const Camera& camera, ImageSize size,
                             const TransferFunction& function) {
  std::uint64_t runs = 0;
  for (const scene::TetMesh& part : parts) {
    if (part.tets.empty()) continue;
    const reference::Reference reference(part, camera, size, function);
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) {
        double back = -1;
        for (const reference::RaySegment& segment : reference.segments(x + 0.5, y + 0.5)) {
          // Cells are 0.2 long. The depths of a shared face, computed in its two cells, differ only by rounding.
          if (std::fabs(segment.front - back) > 1e-9) ++runs;
          back = segment.back;
        }
      }
  }
  return runs;
}

TEST(Distributed, RunsCostTheirRecordsAndLittleMoreAndNeverMoreThanSegments) {
  const scene::TetMesh mesh = datasets::cube(10, 0.2);
  const TransferFunction visible({{0, {0, 0, 1}, 0.1}, {1, {1, 0, 0}, 0.5}});
  const ImageSize size{64, 64};
  const auto bytes = [&](const Parts& parts, Exchange exchange) {
    DistributedSettings settings;
    settings.render = exact();
    settings.exchange = exchange;
    return render(parts, {6, 4, 2}, settings, {{oblique(), size}}, visible).front().statistics;
  };
  for (const auto partition : {datasets::Partition::random_blobs, datasets::Partition::interleaved}) {
    const Parts parts = datasets::parts(mesh, 4, partition, 1);
    const FrameStatistics runs = bytes(parts, Exchange::runs), segments = bytes(parts, Exchange::segments);
    const std::uint64_t counted = reference_runs(parts, oblique(), size, visible);
    EXPECT_LE(runs.fragments, counted);
    EXPECT_GE(static_cast<double>(runs.fragments), 0.999 * static_cast<double>(counted));  // all runs are visible
    EXPECT_LE(static_cast<double>(runs.exchange_bytes), 1.1 * static_cast<double>(counted * 32));
    EXPECT_LE(runs.exchange_bytes, segments.exchange_bytes);
  }
}

TEST(Distributed, ProjectorsThatShareMemoryMakeEachTileOnce) {
  const scene::TetMesh mesh = datasets::cube(6, 0.2);
  const auto parts = datasets::parts(mesh, 4, datasets::Partition::interleaved, 5);
  DistributedSettings settings;
  settings.render = exact();
  const std::vector<FrameJob> jobs{{oblique(), {96, 80}}};
  std::uint64_t runs[2];
  for (const bool shared : {false, true}) {
    settings.render.use.sharing = shared;
    runs[shared ? 1 : 0] = render_once(parts, {4, 4, 4}, settings, jobs, six_knots(), 4, 0).at(0).statistics.fragments;
  }
  // Projectors that work together send finished pixels. Otherwise, scattered parts give several runs per visible pixel.
  EXPECT_EQ(runs[1], 0u);
  EXPECT_GT(runs[0], 96u * 80u);
}

TEST(Distributed, TakesRanksWithoutCellsARankWithOneAndMoreCompositorsThanTiles) {
  const scene::TetMesh mesh = datasets::cube(4, 0.2);
  const ImageSize size{40, 40};
  const Image expected = Renderer(mesh, exact()).render(oblique(), size, six_knots());
  Parts parts = slices(mesh, 1);
  parts.resize(6);
  // One tet on rank 2, all others on rank 4.
  parts[4] = parts[0];
  parts[4].tets.erase(parts[4].tets.begin() + 7);
  parts[4].original_cell.erase(parts[4].original_cell.begin() + 7);
  parts[2] = parts[0];
  parts[2].tets = {mesh.tets[7]};
  parts[2].original_cell = {7};
  for (const int rank : {0, 1, 3, 5}) parts[static_cast<std::size_t>(rank)] = {};
  DistributedSettings settings;
  settings.render = exact();
  settings.render.mesh.tile_size = 32;  // 4 tiles
  settings.exchange = Exchange::segments;
  for (const Shape& shape : {Shape{6, 6, 6}, Shape{15, 6, 9}}) {
    const auto frames = render(parts, shape, settings, {{oblique(), size}}, six_knots());
    EXPECT_TRUE(same_bits(frames.front().image, expected));
    EXPECT_EQ(frames.front().statistics.tets_total, mesh.tets.size());
  }
}

TEST(Distributed, NothingInViewGivesAnEmptyPicture) {
  Camera away = oblique();
  away.focal_point = {1000, 0, 0};
  DistributedSettings settings;
  settings.render = exact();
  const auto frames = render(slices(datasets::cube(4), 3), {3, 3, 3}, settings, {{away, {33, 20}}}, six_knots());
  EXPECT_TRUE(same_bits(frames.front().image, Image({33, 20})));
}

TEST(Distributed, FramesComeInOrderEachWithItsOwnViewAndSize) {
  const scene::TetMesh mesh = datasets::cube(6, 0.2);
  std::vector<FrameJob> jobs;
  for (int i = 0; i < 7; ++i) {
    Camera camera = oblique();
    camera.position.x = 3 - i;
    jobs.push_back({camera, {50 + 3 * i, 40 - i}});
  }
  for (const int in_flight : {1, 2, 5}) {
    DistributedSettings settings;
    settings.render = exact();
    settings.exchange = Exchange::segments;
    settings.render.ranks.frames_in_flight = in_flight;
    const auto frames = render(slices(mesh, 3), {5, 3, 2}, settings, jobs, six_knots());
    ASSERT_EQ(frames.size(), jobs.size());
    for (std::size_t i = 0; i < jobs.size(); ++i) {
      EXPECT_EQ(frames[i].frame, i);
      EXPECT_TRUE(
          same_bits(frames[i].image, Renderer(mesh, exact()).render(jobs[i].camera, jobs[i].size, six_knots())));
    }
  }
}

/// Deep tiles with little memory: many windows, parts sent before the tile is complete, exhausted credit.
TEST(Distributed, DeepTilesStreamThroughALittleMemoryWithoutDeadlock) {
  const scene::TetMesh mesh = datasets::thin_stack(3000);
  Camera camera;
  camera.position = {0, 0, 5};
  camera.parallel_scale = 0.05;
  const ImageSize size{48, 48};
  const TransferFunction function({{-1, {1, 0, 0}, 0.1}, {1, {0, 1, 0}, 0.3}});
  const Image expected = Renderer(mesh, exact()).render(camera, size, function);
  test::SomeCases some(3);
  for (const Exchange exchange : {Exchange::segments, Exchange::runs})
    for (const Shape& shape : {Shape{4, 3, 1}, Shape{3, 3, 3}}) {
      if (!some.next()) continue;
      DistributedSettings settings;
      settings.render = exact();
      settings.render.memory_bytes = 24ull << 20;
      settings.render.threads = 3;
      settings.render.mesh.tile_size = 16;
      settings.exchange = exchange;
      const auto frames = render(datasets::parts(mesh, 3, datasets::Partition::interleaved, 2), shape, settings,
                                 {{camera, size}, {camera, size}}, function);
      ASSERT_EQ(frames.size(), 2u);
      for (const auto& frame : frames)
        // With interleaved parts, a ray has thousands of runs, each rounded to float by 6e-8 of its contribution.
        EXPECT_LE(difference(frame.image, expected), exchange == Exchange::segments ? 0 : 2e-6);
    }
}

/// More segments overlap in depth than fit into the projectors' memory, after some have already been sent.
TEST(Distributed, CellsThatOverlapBeyondMemoryAreSentOnce) {
  scene::TetMesh mesh = leaning_stack(20000);
  const scene::TetMesh front = datasets::cube(4, 0.2);  // the runs of this mesh have been sent when memory runs out
  const auto base = static_cast<std::uint32_t>(mesh.positions.size());
  for (const glm::dvec3& p : front.positions) mesh.positions.emplace_back(0.2 * p.x, 0.2 * p.y, 6 + p.z);
  mesh.scalars.insert(mesh.scalars.end(), front.scalars.begin(), front.scalars.end());
  for (const scene::Tet& tet : front.tets)
    mesh.tets.push_back({tet[0] + base, tet[1] + base, tet[2] + base, tet[3] + base});
  Camera camera;
  camera.position = {0.0031, 0.0047, 9};
  camera.focal_point = {0.0031, 0.0047, 0};
  camera.parallel_scale = 0.06;
  const ImageSize size{24, 24};
  const TransferFunction function({{0, {0, 0.2, 1}, 0.1}, {1, {1, 0.3, 0}, 1.5}});
  const Image expected = Renderer(mesh, exact()).render(camera, size, function);
  for (const auto partition : {datasets::Partition::interleaved, datasets::Partition::random_blobs}) {
    DistributedSettings settings;
    settings.render = exact();
    settings.render.memory_bytes = 96ull << 20;  // enough for a tile's runs, not for all its windows
    settings.render.threads = 2;
    settings.render.mesh.tile_size = 8;
    const auto frames = render(datasets::parts(mesh, 2, partition, 2), {4, 2, 2}, settings, {{camera, size}}, function);
    ASSERT_EQ(frames.size(), 1u);
    EXPECT_GT(frames[0].statistics.tiles_split, 0u);
    // Each of up to 20,000 runs of a ray is rounded to float.
    EXPECT_LE(difference(frames[0].image, expected), 2e-5);
  }
}

TEST(Distributed, AnErrorOfOneRankIsTheErrorOfAll) {
  const scene::TetMesh mesh = datasets::cube(6, 0.2);
  DistributedSettings settings;
  settings.render = exact();
  for (int broken = 0; broken < 4; ++broken) {
    std::atomic<int> calls = 0;
    try {
      exchange::run_ranks(4, [&](exchange::Transport& transport) {
        DistributedSettings mine = settings;
        mine.roles = assign_roles(4, 4, 4);
        const auto parts = slices(mesh, 4);
        const std::vector<FrameJob> jobs(5, FrameJob{oblique(), {64, 64}});
        try {
          render_distributed(
              transport, mine, jobs, six_knots(),
              [&](std::size_t) -> ProjectorMesh {
                if (transport.rank() == broken) throw scene::bad_input("piece_2.vtu: is cut short; copy it again");
                ProjectorMesh part;
                part.part = parts[static_cast<std::size_t>(transport.rank())];
                part.diagonal = 4;
                return part;
              },
              [&](FinishedFrame) {});
        } catch (const scene::Error& error) {
          EXPECT_STREQ(error.what(), "piece_2.vtu: is cut short; copy it again");
          ++calls;
          throw;
        }
      });
      FAIL() << "no error came out";
    } catch (const scene::Error& error) {
      EXPECT_EQ(error.code(), scene::ErrorCode::bad_input);
    }
    EXPECT_EQ(calls, 4);
  }
}

TEST(Distributed, AFullDiskWhileWritingEndsAllAfterTheFramesBeforeIt) {
  const scene::TetMesh mesh = datasets::cube(6, 0.2);
  const auto parts = slices(mesh, 3);
  std::atomic<int> written = 0;
  EXPECT_THROW(exchange::run_ranks(3,
                                   [&](exchange::Transport& transport) {
                                     DistributedSettings settings;
                                     settings.render = exact();
                                     settings.roles = assign_roles(3, 3, 3);
                                     const std::vector<FrameJob> jobs(9, FrameJob{oblique(), {64, 64}});
                                     render_distributed(
                                         transport, settings, jobs, six_knots(),
                                         [&](std::size_t) {
                                           ProjectorMesh part;
                                           part.part = parts[static_cast<std::size_t>(transport.rank())];
                                           part.diagonal = 4;
                                           return part;
                                         },
                                         [&](const FinishedFrame& frame) {
                                           if (frame.frame == 3)
                                             throw scene::Error(scene::ErrorCode::system_failure, "full");
                                           ++written;
                                         });
                                   }),
               scene::Error);
  EXPECT_EQ(written, 3);
}

TEST(Roles, FillTheJobOrShareItsRanks) {
  EXPECT_EQ(assign_roles(6, 4, 2).compositors, (std::vector<int>{4, 5}));
  EXPECT_EQ(assign_roles(4, 4, 4).compositors, (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(assign_roles(4, 4, 1).assembler(), 0);
  EXPECT_EQ(assign_roles(4, 3, std::nullopt).compositors, (std::vector<int>{3}));
  EXPECT_EQ(assign_roles(4, 4, std::nullopt).compositors.size(), 4u);
  EXPECT_EQ(assign_roles(4, std::nullopt, 1).projectors.size(), 3u);
  EXPECT_EQ(assign_roles(5, std::nullopt, std::nullopt).projectors.size(), 5u);
  EXPECT_THROW(assign_roles(4, 2, 1), scene::Error);
  EXPECT_THROW(assign_roles(4, 5, 1), scene::Error);
  EXPECT_THROW(assign_roles(4, 0, 4), scene::Error);
}

/// Every tet is counted once, in one group; the projectors' counts arrive, whichever rank composites.
TEST_P(AnyShape, CountersAddUp) {
  const Shape shape = GetParam();
  const ImageSize size{97, 61};
  const scene::TetMesh mesh = datasets::cube(20, 0.2);  // cells smaller than pixels, some outside the view
  Camera near_by = oblique();
  near_by.parallel_scale = 0.7;
  const TransferFunction half({{0.5, {1, 0.5, 0}, 0}, {1, {0, 0.5, 1}, 3}});
  for (const Camera& camera : {oblique(), near_by}) {
    FrameStatistics alone;
    Renderer(mesh, exact()).render(camera, size, half, &alone);
    EXPECT_EQ(alone.tets_total, mesh.tets.size());
    EXPECT_EQ(alone.tets_total,
              alone.tets_invisible + alone.tets_outside_view + alone.tets_between_pixels + alone.tets_projected);
    EXPECT_GT(alone.tets_invisible, 0u);
    DistributedSettings settings;
    settings.render = exact();
    settings.exchange = Exchange::segments;
    const std::vector<FinishedFrame> frames =
        render(slices(mesh, static_cast<std::size_t>(shape.projectors)), shape, settings, {{camera, size, 0}}, half);
    const FrameStatistics& together = frames.at(0).statistics;
    for (const auto member : {&scene::FrameCounters::tets_total, &scene::FrameCounters::tets_invisible,
                              &scene::FrameCounters::tets_outside_view, &scene::FrameCounters::tets_between_pixels,
                              &scene::FrameCounters::tets_projected, &scene::FrameCounters::segments})
      EXPECT_EQ(together.*member, alone.*member);
    // Segments are sent individually, including those behind opaque ones.
    EXPECT_EQ(together.fragments, together.segments);
    EXPECT_GT(together.exchange_messages, 0u);
    EXPECT_GT(together.exchange_bytes, 16 * together.fragments);
  }
}

}  // namespace
}  // namespace tessera::frame::distributed_test
