// SPDX-License-Identifier: BSD-3-Clause
#include "compositor/gl/gl_merger.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "compositor/gl/gl_compositor.hpp"
#include "compositor/tuple_record.hpp"
#include "exchange/part_writer.hpp"
#include "support/gl_context.hpp"

namespace tessera::compositor::gl_merger_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A frame of 16 x 8 pixels, one tile, whose parts go to both kinds of merger.
struct GlFrame {
  explicit GlFrame(const scene::Integrator& integrator_, scene::Emission emission_ = scene::Emission::absorption)
      : emission(emission_),
        space(camera(), {16, 8}),
        integrator(function, integrator_, emission),
        lattice{.depth_origin = 3, .depth_unit = 0x1p-28, .scalar_origin = 0.5, .scalar_unit = 0x1p-30},
        lattice_table(function, lattice.scalar_origin, lattice.scalar_unit, lattice.depth_unit, emission),
        units(device_units(function, longest_ray)),
        units_table(function, units.scalar_origin, units.scalar_unit, units.depth_unit, emission) {}

  static scene::Camera camera() {
    scene::Camera camera;
    camera.position = {0, 0, 5};
    camera.parallel_scale = 1;
    return camera;
  }

  MergeContext context(bool on_lattice) const {
    MergeContext made{&space, &integrator, function.max_color(), longest_ray, 0.5f, emission, 1 << 28};
    made.lattice = &lattice;
    made.table = &lattice_table;
    made.on_lattice = on_lattice;
    return made;
  }

  /// Merged on the device, or on the CPU if `device` is null.
  scene::Image merged(GlCompositor* device, const std::vector<exchange::TilePart>& parts) const {
    const bool on_lattice =
        parts.front().kind == exchange::RecordKind::lattice || parts.front().kind == exchange::RecordKind::lattice_runs;
    MergeContext mine = context(on_lattice);
    mine.device = device;
    static std::uint32_t frames = 0;
    mine.frame = ++frames;  // must be unique: devices cache a frame's table
    if (device != nullptr && !on_lattice) {
      mine.lattice = &units;
      mine.table = &units_table;
    }
    const auto merger = make_tile_merger(parts.front().kind, mine, {0, 0, 16, 8});
    for (const exchange::TilePart& part : parts) merger->add(part);
    merger->advance(infinity);
    return merger->finish().image;
  }

  static constexpr double longest_ray = 2;
  scene::TransferFunction function{{{0, {0.1, 0, 0.3}, 0},
                                    {0.3, {0.1, 0.3, 0.9}, 0.4},
                                    {0.5, {0.2, 0.9, 0.3}, 0},
                                    {0.7, {0.9, 0.8, 0.1}, 3},
                                    {0.7, {0.9, 0.2, 0.1}, 1},
                                    {1, {1, 1, 1}, 8}}};
  scene::Emission emission;
  projection::PixelSpace space;
  integrals::SegmentIntegrator integrator;
  scene::Lattice lattice;
  integrals::LaneTable lattice_table;
  scene::Lattice units;
  integrals::LaneTable units_table;
};

/// Ray segments that touch end to end: `counts` of them per pixel (cyclically), in the order produced by `arrange`.
struct Stack {
  std::vector<std::uint32_t> counts;
  std::string arrangement = "shuffled";
  bool one_depth = false;  ///< all segments are at the same depth: only their last key distinguishes them
};

struct StackSegment {
  double front, back, scalar_front, scalar_back;
};

std::vector<StackSegment> segments_of(std::uint32_t count, const Stack& stack, std::mt19937& random) {
  std::vector<StackSegment> segments;
  const auto uniform = [&] { return std::uniform_real_distribution<double>(0, 1)(random); };
  double scalar = uniform();
  for (std::uint32_t i = 0; i < count; ++i) {
    // Values far outside [0, 1] are drawn again. Clamping would make many segments equal, and the order of equal
    // segments does not matter.
    double next = scalar + 8 * (uniform() - 0.5) / std::sqrt(count);
    if (std::abs(next - 0.5) > 0.6) next = uniform();
    const double step = 1.5 / count;
    segments.push_back(stack.one_depth ? StackSegment{2.5, 2.5 + step, scalar, next}
                                       : StackSegment{2.25 + i * step, 2.25 + (i + 1) * step, scalar, next});
    scalar = next;
  }
  return segments;
}

template <class T>
void arrange(std::vector<T>& list, const std::string& arrangement, std::mt19937& random) {
  if (arrangement == "reversed") std::reverse(list.begin(), list.end());
  if (arrangement == "shuffled") std::shuffle(list.begin(), list.end(), random);
}

exchange::TilePart part_of(exchange::RecordKind kind, exchange::Bytes records, std::uint64_t fragments) {
  return {.tile = 0,
          .kind = kind,
          .last = true,
          .final_depth = infinity,
          .fragments = fragments,
          .records = std::move(records),
          .projector = 0,
          .start_depth = -infinity};
}

exchange::TilePart lattice_part(const GlFrame& frame, const Stack& stack) {
  std::mt19937 random(1);
  exchange::Bytes bytes;
  std::uint64_t fragments = 0;
  for (std::uint32_t pixel = 0; pixel < 16 * 8; ++pixel) {
    const std::uint32_t count = stack.counts[pixel % stack.counts.size()];
    auto segments = segments_of(count, stack, random);
    arrange(segments, stack.arrangement, random);
    exchange::append(bytes, exchange::LatticeHeader{pixel, count});
    for (const StackSegment& s : segments)
      exchange::append(bytes,
                       projection::LatticeSegment{frame.lattice.depth_step(s.front), frame.lattice.depth_step(s.back),
                                                  static_cast<float>(frame.lattice.scalar_step(s.scalar_front)),
                                                  static_cast<float>(frame.lattice.scalar_step(s.scalar_back))});
    fragments += count;
  }
  return part_of(exchange::RecordKind::lattice, std::move(bytes), fragments);
}

exchange::TilePart chain_part(const Stack& stack) {
  std::mt19937 random(2);
  exchange::Bytes bytes;
  std::uint64_t fragments = 0;
  for (std::uint32_t pixel = 0; pixel < 16 * 8; ++pixel) {
    const std::uint32_t count = stack.counts[pixel % stack.counts.size()];
    const auto segments = segments_of(count, stack, random);
    std::vector<std::uint32_t> order(count);
    for (std::uint32_t i = 0; i < count; ++i) order[i] = i;
    arrange(order, stack.arrangement, random);
    for (const std::uint32_t i : order) {
      exchange::append(bytes, exchange::ChainHeader{pixel, 1, segments[i].front, segments[i].scalar_front});
      exchange::append(bytes, exchange::ChainLink{segments[i].back, segments[i].scalar_back, i});
    }
    fragments += count;
  }
  return part_of(exchange::RecordKind::chains, std::move(bytes), fragments);
}

exchange::TilePart tuple_part(const Stack& stack) {
  std::mt19937 random(3);
  exchange::Bytes bytes;
  std::uint64_t fragments = 0;
  for (std::uint32_t pixel = 0; pixel < 16 * 8; ++pixel) {
    const std::uint32_t count = stack.counts[pixel % stack.counts.size()];
    auto segments = segments_of(count, stack, random);
    arrange(segments, stack.arrangement, random);
    for (const StackSegment& s : segments)
      exchange::append(bytes, TupleRecord{pixel,
                                          {static_cast<float>(s.back), static_cast<float>((s.back - s.front) / 0.5),
                                           static_cast<float>(s.scalar_front), static_cast<float>(s.scalar_back)}});
    fragments += count;
  }
  return part_of(exchange::RecordKind::tuples, std::move(bytes), fragments);
}

double difference(const scene::Image& a, const scene::Image& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) most = std::max(most, std::fabs(double{a.rgba[i]} - b.rgba[i]));
  return most;
}

void expect_same_depth(const scene::Image& a, const scene::Image& b) {
  for (std::size_t i = 0; i < a.depth.size(); ++i) {
    if (a.depth[i] == b.depth[i]) continue;                      // also for infinities
    ASSERT_NEAR(a.depth[i], b.depth[i], 1e-6) << "pixel " << i;  // a float's last places at depth 3
  }
}

constexpr scene::Integrator exact{scene::IntegratorKind::exact};
constexpr scene::Integrator sampled{scene::IntegratorKind::sampled, 4};

GlSettings compute() { return {}; }
GlSettings fragment(bool half) {
  GlSettings settings;
  settings.method = GlMethod::fragment;
  settings.half = half;
  return settings;
}

/// Opens a device with these settings, or skips the test.
#define TESSERA_DEVICE_OR_SKIP(device, settings)                                              \
  if (tessera::tests::osmesa_or_none() == nullptr) GTEST_SKIP() << "OSMesa cannot be opened"; \
  GlCompositor device(gl::Platform::osmesa, settings, nullptr)

const Stack shallow{{0, 1, 2, 5, 17, 64}};

TEST(GlCompute, ExactMatchesTheCpuWithinFloatRounding) {
  TESSERA_DEVICE_OR_SKIP(device, compute());
  for (const auto emission : {scene::Emission::absorption, scene::Emission::independent}) {
    const GlFrame frame(exact, emission);
    for (const exchange::TilePart& part : {lattice_part(frame, shallow), chain_part(shallow)}) {
      const auto cpu = frame.merged(nullptr, {part}), gpu = frame.merged(&device, {part});
      // 64 segments of up to 8 optical depths, with colours of up to 8 times their extinction. Each rounding error of a
      // float is below 2^-24 of the light. The bound is a quarter of what `exact` promises.
      EXPECT_LT(difference(cpu, gpu), 5e-6) << int(part.kind);
      expect_same_depth(cpu, gpu);
    }
  }
}

TEST(GlCompute, SampledMatchesTheCpu) {
  TESSERA_DEVICE_OR_SKIP(device, compute());
  for (const auto emission : {scene::Emission::absorption, scene::Emission::independent}) {
    const GlFrame frame(sampled, emission);
    for (const exchange::TilePart& part : {chain_part(shallow), tuple_part(shallow)})
      // A sample whose scalar is rounded across the step at 0.7 would get the colour of the other side of the step.
      // This test has no such sample.
      EXPECT_LT(difference(frame.merged(nullptr, {part}), frame.merged(&device, {part})), 5e-6) << int(part.kind);
  }
}

TEST(GlCompute, RunsAreCompositedAsTheyCome) {
  TESSERA_DEVICE_OR_SKIP(device, compute());
  const GlFrame frame(exact);
  exchange::Bytes bytes, on_lattice;
  for (std::uint32_t pixel = 0; pixel < 128; ++pixel) {
    exchange::append(on_lattice, exchange::RunsHeader{pixel, 2, 1});
    for (int i = 2; i >= 1; --i) {  // the farther first
      const float depth = 0.3f * static_cast<float>(i), color = 0.1f * static_cast<float>(i + pixel % 3);
      exchange::append(bytes, exchange::RunRecord{2.0 + i, 0.5f, color, 0.1f, 0.2f, depth, pixel});
      exchange::append(on_lattice, exchange::LatticeRun{i * 1000000, i * 1000000 + 5000, color, 0.1f, 0.2f, depth});
    }
    exchange::append(on_lattice, projection::LatticeSegment{-5000000, 900000, 0.2e9f, 0.5e9f});
  }
  for (const exchange::TilePart& part : {part_of(exchange::RecordKind::runs, bytes, 256),
                                         part_of(exchange::RecordKind::lattice_runs, on_lattice, 384)}) {
    const auto cpu = frame.merged(nullptr, {part}), gpu = frame.merged(&device, {part});
    EXPECT_LT(difference(cpu, gpu), 1e-6) << int(part.kind);  // three fragments: a few roundings of a float
    expect_same_depth(cpu, gpu);
  }
}

/// A cell in front of all pixels.
exchange::TilePart cell_part(std::size_t cells) {
  const projection::CellRecord cell{{{0.5, 0.5, 2, 0}, {15.5, 0.5, 2.5, 0.4}, {0.5, 7.5, 3, 0.8}, {8.5, 4.5, 3.5, 1}},
                                    7};
  exchange::Bytes bytes;
  for (std::size_t i = 0; i < cells; ++i) exchange::append(bytes, cell);
  return part_of(exchange::RecordKind::cells, std::move(bytes), cells);
}

TEST(GlCompute, CellsBeyondTheMemoryBudgetAreRefusedInOneLine) {
  TESSERA_DEVICE_OR_SKIP(device, compute());
  const GlFrame frame(exact);
  MergeContext context = frame.context(true);
  context.device = &device;
  context.budget_bytes = 100 * sizeof(projection::CellRecord);
  const auto merger = make_tile_merger(exchange::RecordKind::cells, context, {0, 0, 16, 8});
  merger->add(cell_part(100));
  try {
    merger->add(cell_part(1));
    ADD_FAILURE() << "no error";
  } catch (const scene::Error& error) {
    EXPECT_NE(std::string(error.what()).find("holds 101 cells at once, beyond the memory budget; raise `memory`"),
              std::string::npos)
        << error.what();
  }
}

TEST(GlCompute, NothingOfATileWithCellsIsCompositedBeforeAllOfItIsThere) {
  TESSERA_DEVICE_OR_SKIP(device, compute());
  const GlFrame frame(exact);
  const auto merged = [&](bool advanced) {
    MergeContext context = frame.context(true);
    context.device = &device;
    context.frame = advanced ? 1001 : 1000;
    const auto merger = make_tile_merger(exchange::RecordKind::cells, context, {0, 0, 16, 8});
    merger->add(cell_part(1));
    merger->add(lattice_part(frame, shallow));
    if (advanced) merger->advance(3);
    merger->advance(infinity);
    return merger->finish().image;
  };
  const scene::Image at_once = merged(false), in_steps = merged(true);
  EXPECT_EQ(at_once.rgba, in_steps.rgba);
  EXPECT_EQ(at_once.depth, in_steps.depth);
  const scene::Image without = frame.merged(&device, {lattice_part(frame, shallow)});
  EXPECT_NE(at_once.rgba, without.rgba);
}

TEST(TileMerger, CellsAtACompositorWithoutADeviceAreRefused) {
  const GlFrame frame(exact);
  EXPECT_THROW(make_tile_merger(exchange::RecordKind::cells, frame.context(true), {0, 0, 16, 8}), scene::Error);
}

class Arrangements : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(All, Arrangements, testing::Values("sorted", "reversed", "shuffled"));

/// One pixel has 20,000 segments, the others at most 3; with `one_depth`, all keys of a pixel are equal.
Stack deep_stack(const char* arrangement, bool one_depth) {
  Stack stack{std::vector<std::uint32_t>(128, 3), arrangement, one_depth};
  stack.counts[37] = 20000;
  stack.counts[3] = 0;
  return stack;
}

TEST_P(Arrangements, ComputeShadersCompositeOneDeepPixelAmongShallowOnes) {
  TESSERA_DEVICE_OR_SKIP(device, compute());
  const GlFrame frame(exact);
  for (const bool one_depth : {false, true}) {
    const Stack stack = deep_stack(GetParam(), one_depth);
    for (const exchange::TilePart& part : {lattice_part(frame, stack), chain_part(stack)}) {
      const auto cpu = frame.merged(nullptr, {part}), gpu = frame.merged(&device, {part});
      // The CPU and the device both sum in double; each of 20,000 segments is accurate to 2^-23 of its own light.
      EXPECT_LT(difference(cpu, gpu), 5e-6) << int(part.kind) << (one_depth ? ", one depth" : "");
      expect_same_depth(cpu, gpu);
    }
  }
}

TEST_P(Arrangements, FragmentShadersCompositeOneDeepPixelAmongShallowOnes) {
  TESSERA_DEVICE_OR_SKIP(device, fragment(false));
  const GlFrame frame(sampled);
  for (const bool one_depth : {false, true}) {
    const exchange::TilePart part = chain_part(deep_stack(GetParam(), one_depth));
    const auto cpu = frame.merged(nullptr, {part}), gpu = frame.merged(&device, {part});
    EXPECT_LT(difference(cpu, gpu), 1e-4) << (one_depth ? "one depth" : "");  // required agreement
    expect_same_depth(cpu, gpu);
  }
}

TEST(GlFragment, SampledMatchesTheCpuWithAFloatFramebuffer) {
  TESSERA_DEVICE_OR_SKIP(device, fragment(false));
  for (const auto emission : {scene::Emission::absorption, scene::Emission::independent}) {
    const GlFrame frame(sampled, emission);
    for (const exchange::TilePart& part : {lattice_part(frame, shallow), chain_part(shallow), tuple_part(shallow)}) {
      const auto gpu = frame.merged(&device, {part});
      if (part.kind == exchange::RecordKind::lattice) continue;  // not comparable: the CPU samples only in double
      const auto cpu = frame.merged(nullptr, {part});
      EXPECT_LT(difference(cpu, gpu), 1e-5) << int(part.kind);  // 64 blends of 2^-24
      expect_same_depth(cpu, gpu);
    }
  }
}

TEST(GlFragment, ListsLongerThanTheTextureAreSortedInPartsAndMerged) {
  GlSettings settings = fragment(false);
  settings.texture_limit = 16;  // a list of 64 takes 4 of the 16 rows, so 4 such lists fit
  TESSERA_DEVICE_OR_SKIP(device, settings);
  const GlFrame frame(sampled);
  const exchange::TilePart part = chain_part({{64, 3, 33, 0, 16, 17}, "shuffled"});
  EXPECT_LT(difference(frame.merged(nullptr, {part}), frame.merged(&device, {part})), 1e-5);
}

TEST(GlFragment, AHalfFramebufferErrsByItsRoundingAndNoMore) {
  TESSERA_DEVICE_OR_SKIP(device, fragment(true));
  const GlFrame frame(sampled);
  const exchange::TilePart part = chain_part(shallow);
  const double error = difference(frame.merged(nullptr, {part}), frame.merged(&device, {part}));
  EXPECT_GT(error, 1e-5);          // otherwise it would not be an approximation
  EXPECT_LT(error, 64 * 0x1p-11);  // each blend rounds by 2^-12 of a value below 2
}

TEST(GlCompositor, ManyTilesInFlightAreNotMixedUp) {
  TESSERA_DEVICE_OR_SKIP(device, compute());
  const GlFrame frame(exact);
  std::vector<std::future<std::vector<GlLight>>> lights;
  for (int job = 0; job < 60; ++job) {
    GlFragments fragments;
    fragments.width = 4;
    for (std::uint32_t p = 0; p < 4; ++p) {
      fragments.lists.push_back({p, p, 1});
      fragments.keys.push_back({0, 0, 0, p});
      fragments.values.push_back({float(job), float(p), 0, 0.5f});  // each run has another colour
    }
    lights.push_back(device.composite(std::move(fragments), {&frame.lattice_table, 0, 0, 0}));
  }
  for (int job = 0; job < 60; ++job) {
    const auto of_job = lights[static_cast<std::size_t>(job)].get();
    ASSERT_EQ(of_job.size(), 4u);
    for (std::uint32_t p = 0; p < 4; ++p) {
      EXPECT_EQ(of_job[p].red, float(job));
      EXPECT_EQ(of_job[p].green, float(p));
      EXPECT_EQ(of_job[p].optical_depth, 0.5f);
      EXPECT_EQ(of_job[p].first, p);
    }
  }
}

TEST(GlCompositor, AFaultReachesTheJobAndAllLaterOnes) {
  for (const GlFault fault : {GlFault::lost, GlFault::memory}) {
    GlSettings settings;
    settings.fault = fault;
    settings.fault_after = 1;
    TESSERA_DEVICE_OR_SKIP(device, settings);
    const GlFrame frame(exact);
    const exchange::TilePart part = lattice_part(frame, shallow);
    EXPECT_EQ(frame.merged(&device, {part}).rgba.size(), 4u * 128);
    for (int later = 0; later < 2; ++later) try {
        frame.merged(&device, {part});
        ADD_FAILURE() << "no error";
      } catch (const scene::Error& error) {
        EXPECT_EQ(error.code(), scene::ErrorCode::system_failure);
        EXPECT_NE(std::string(error.what()).find(fault == GlFault::lost ? "context was lost" : "out of device memory"),
                  std::string::npos)
            << error.what();
      }
  }
}

}  // namespace
}  // namespace tessera::compositor::gl_merger_test
