// SPDX-License-Identifier: BSD-3-Clause
#include "tessera/session.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>
#include <random>
#include <thread>

#include "api/communicator.hpp"
#include "api/dataset.hpp"
#include "datasets/boxes.hpp"
#include "datasets/modify.hpp"
#include "exchange/loopback_transport.hpp"
#include "scene/error.hpp"
#include "tessera/communicator.hpp"

namespace tessera::session_test {
namespace {

constexpr ImageSize size{101, 67};

/// Arrays of a cube's mesh, as a caller owns them.
struct Cube {
  explicit Cube(int n) {
    const scene::TetMesh mesh = datasets::cube(n);
    points = mesh.positions;
    for (const scene::Tet& tet : mesh.tets) tets.insert(tets.end(), tet.begin(), tet.end());
    scalars = mesh.scalars;
  }
  [[nodiscard]] MeshArrays arrays() const {
    MeshArrays arrays;
    arrays.points = points;
    arrays.tets = tets;
    arrays.scalars = scalars;
    return arrays;
  }
  std::vector<glm::dvec3> points;
  std::vector<std::uint32_t> tets;
  std::vector<double> scalars;
};

GridArrays grid_arrays(const std::vector<float>& samples, std::int64_t n) {
  GridArrays arrays;
  arrays.geometry.points = {n, n, n};
  arrays.geometry.spacing = glm::dvec3(1.0 / static_cast<double>(n - 1));
  arrays.samples = samples;
  return arrays;
}

std::vector<float> waves(std::int64_t n) {
  std::vector<float> samples;
  for (std::int64_t k = 0; k < n; ++k)
    for (std::int64_t j = 0; j < n; ++j)
      for (std::int64_t i = 0; i < n; ++i)
        samples.push_back(std::sin(0.31f * static_cast<float>(i)) * std::cos(0.23f * static_cast<float>(j)) +
                          0.02f * static_cast<float>(k));
  return samples;
}

View view_of(const Dataset& data) { return data.default_view(size); }

bool same_bits(const Image& a, const Image& b) { return a.size == b.size && a.rgba == b.rgba && a.depth == b.depth; }

/// Counts how often each pixel arrived, and stores its last value.
class Pixels : public Sink {
 public:
  Pixels() : seen(size), times(static_cast<std::size_t>(size.width) * size.height, 0) {}
  void tile(const Tile& tile) override {
    EXPECT_FALSE(busy_.exchange(true)) << "two calls at once";
    ++tiles;
    for (int y = tile.rect.y0; y < tile.rect.y1; ++y)
      for (int x = tile.rect.x0; x < tile.rect.x1; ++x) {
        const std::size_t i = seen.index(x, y);
        ++times[i];
        seen.depth[i] = tile.image.depth[i];
        for (std::size_t c = 0; c < 4; ++c) seen.rgba[4 * i + c] = tile.image.rgba[4 * i + c];
      }
    after_tile();
    busy_ = false;
  }
  virtual void after_tile() {}

  Image seen;
  std::vector<int> times;
  int tiles = 0;

 private:
  std::atomic<bool> busy_ = false;
};

/// Requests a stop at its tile number `at`.
class StopAt final : public Pixels {
 public:
  explicit StopAt(int at) : at_(at) {}
  void after_tile() override {
    if (tiles == at_) source.request_stop();
  }
  std::stop_source source;

 private:
  int at_;
};

class Throwing final : public Pixels {
 public:
  void after_tile() override {
    if (tiles == 2) {
      throw std::runtime_error("the client has gone");
    }
  }
};

enum class Kind { mesh, grid };

Dataset dataset(Kind kind) {
  if (kind == Kind::mesh) {
    auto cube = std::make_shared<Cube>(9);
    MeshArrays arrays = cube->arrays();
    arrays.owner = cube;
    return Dataset::of(arrays);
  }
  auto samples = std::make_shared<std::vector<float>>(waves(40));
  GridArrays arrays = grid_arrays(*samples, 40);
  arrays.owner = samples;
  return Dataset::of(arrays);
}

class AnyKind : public ::testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(Session, AnyKind, ::testing::Values(Kind::mesh, Kind::grid),
                         [](const auto& info) { return info.param == Kind::mesh ? "Mesh" : "Grid"; });

TEST_P(AnyKind, TilesAreThePictureOnce) {
  const Dataset data = dataset(GetParam());
  Session session(data);
  const TransferFunction function = data.transfer_function("viridis").function;
  Pixels pixels;
  const RenderedFrame frame = session.render(view_of(data), function, {}, &pixels);
  EXPECT_FALSE(frame.stopped);
  EXPECT_TRUE(same_bits(frame.image, pixels.seen));
  EXPECT_TRUE(std::all_of(pixels.times.begin(), pixels.times.end(), [](int n) { return n == 1; }));
  EXPECT_GT(*std::max_element(frame.image.rgba.begin(), frame.image.rgba.end()), 0.1f);
  const RenderedFrame alone = session.render(view_of(data), function);
  EXPECT_TRUE(same_bits(frame.image, alone.image));
}

TEST_P(AnyKind, PicturesKeepTheirPromise) {
  const Dataset data = dataset(GetParam());
  Session session(data);
  const TransferFunction function = data.transfer_function().function;
  FrameSettings settings;
  settings.keep_uncertainty = true;
  const RenderedFrame frame = session.render(view_of(data), function, settings);
  ASSERT_TRUE(session.promised_error());
  const Verification found = session.verify(frame, view_of(data), function, 500);
  EXPECT_EQ(found.pixels_checked, 500u);
  EXPECT_TRUE(found.met);
  EXPECT_LE(found.max_error_not_excused, *session.promised_error());
  RenderedFrame wrong = frame;
  for (float& value : wrong.image.rgba) value *= 0.99f;
  EXPECT_FALSE(session.verify(wrong, view_of(data), function, 500).met);
}

TEST_P(AnyKind, AStopEndsTheFrameAndTheNextHasTheSameBits) {
  const Dataset data = dataset(GetParam());
  Settings settings;
  settings.threads = 2;
  Session session(data, settings);
  const TransferFunction function = data.transfer_function("plasma").function;
  const RenderedFrame whole = session.render(view_of(data), function);
  for (int at = 1; at <= 5; ++at) {
    StopAt sink(at);
    const RenderedFrame frame = session.render(view_of(data), function, {}, &sink, sink.source.get_token());
    EXPECT_TRUE(frame.stopped);
    EXPECT_EQ(frame.image.rgba.size(), 0u);
    EXPECT_LT(sink.tiles, at + 4) << "goes on after the stop";
    for (std::size_t i = 0; i < sink.times.size(); ++i)
      if (sink.times[i] > 0) {
        EXPECT_EQ(sink.seen.rgba[4 * i], whole.image.rgba[4 * i]);
      }
    EXPECT_TRUE(same_bits(session.render(view_of(data), function).image, whole.image));
  }
  std::stop_source before;
  before.request_stop();
  EXPECT_TRUE(session.render(view_of(data), function, {}, nullptr, before.get_token()).stopped);
}

/// The deep image of a grid is made in a separate pass after the flat image. A stop during this pass also ends the
/// frame, on any rank.
TEST(Session, AStopAfterTheLastTileEndsTheDeepPictureOfAGrid) {
  const Dataset data = dataset(Kind::grid);
  const TransferFunction function = data.transfer_function("plasma").function;
  for (const int ranks : {1, 3})
    run_ranks(ranks, [&](const Communicator& communicator) {
      Session session(data, {}, communicator);
      FrameSettings deep;
      deep.deep = true;
      Pixels all;
      const RenderedFrame whole = session.render(view_of(data), function, deep, &all);
      EXPECT_FALSE(whole.stopped);
      StopAt sink(all.tiles);
      EXPECT_TRUE(session.render(view_of(data), function, deep, &sink, sink.source.get_token()).stopped);
      const RenderedFrame next = session.render(view_of(data), function, deep);
      EXPECT_EQ(next.deep.begin, whole.deep.begin);
      EXPECT_TRUE(same_bits(next.image, whole.image));
    });
}

TEST_P(AnyKind, StopsAtAnyTimeLeaveTheSessionUsable) {
  const Dataset data = dataset(GetParam());
  Session session(data);
  const TransferFunction function = data.transfer_function().function;
  const RenderedFrame whole = session.render(view_of(data), function);
  std::mt19937 random(3);
  const auto usual = static_cast<unsigned>(1000 * session.render(view_of(data), function).statistics.milliseconds) + 1;
  for (int i = 0; i < 60; ++i) {
    std::stop_source source;
    // The stop may be requested before the frame, during the frame or after it.
    const auto delay = std::chrono::microseconds(random() % usual);
    std::jthread stopper([&] {
      std::this_thread::sleep_for(delay);
      source.request_stop();
    });
    const RenderedFrame frame = session.render(view_of(data), function, {}, nullptr, source.get_token());
    if (!frame.stopped) {
      EXPECT_TRUE(same_bits(frame.image, whole.image));
    }
  }
  EXPECT_TRUE(same_bits(session.render(view_of(data), function).image, whole.image));
}

TEST_P(AnyKind, ASinksExceptionReachesTheCaller) {
  const Dataset data = dataset(GetParam());
  Session session(data);
  const TransferFunction function = data.transfer_function().function;
  Throwing sink;
  EXPECT_THROW(session.render(view_of(data), function, {}, &sink), std::runtime_error);
  EXPECT_EQ(sink.tiles, 2);
  EXPECT_FALSE(session.render(view_of(data), function).stopped);
}

TEST_P(AnyKind, SessionsShareADataSetOnThreadsOfTheirOwn) {
  const Dataset data = dataset(GetParam());
  const TransferFunction function = data.transfer_function().function;
  const RenderedFrame whole = Session(data).render(view_of(data), function);
  std::vector<std::jthread> callers;
  std::atomic<int> same = 0;
  for (int caller = 0; caller < 4; ++caller)
    callers.emplace_back([&] {
      Settings settings;
      settings.threads = 2;
      Session session(data, settings);
      for (int i = 0; i < 3; ++i) same += same_bits(session.render(view_of(data), function).image, whole.image) ? 1 : 0;
    });
  callers.clear();
  EXPECT_EQ(same, 12);
}

class Film final : public Sink {
 public:
  [[nodiscard]] bool wants_tiles() const override { return false; }
  void frame(RenderedFrame&& frame) override { frames.push_back(std::move(frame)); }
  std::vector<RenderedFrame> frames;
};

TEST_P(AnyKind, RanksMakeTheSamePicturesAndStopTogether) {
  const Dataset data = dataset(GetParam());
  const TransferFunction function = data.transfer_function("viridis").function;
  const RenderedFrame whole = Session(data).render(view_of(data), function);
  for (const int ranks : {2, 3}) {
    std::atomic<int> assembled = 0;
    exchange::run_ranks(ranks, [&](exchange::Transport& transport) {
      Settings settings;
      settings.threads = 1;
      settings.ranks.exchange = Exchange::segments;
      Session session(data, settings, api::communicator_over(transport));
      Pixels pixels;
      const RenderedFrame frame = session.render(view_of(data), function, {}, &pixels);
      EXPECT_FALSE(frame.stopped);
      if (session.assembles()) {
        ++assembled;
        EXPECT_TRUE(same_bits(frame.image, whole.image));
        EXPECT_TRUE(same_bits(pixels.seen, whole.image));
        EXPECT_TRUE(std::all_of(pixels.times.begin(), pixels.times.end(), [](int n) { return n == 1; }));
      } else {
        EXPECT_EQ(pixels.tiles, 0);
        EXPECT_TRUE(frame.image.rgba.empty());
      }
      // A stop that the last rank requests before the film begins ends the film on all ranks.
      for (int again = 0; again < 3; ++again) {
        std::stop_source source;
        if (transport.rank() == ranks - 1) source.request_stop();
        Film film;
        const std::vector<View> views(4, view_of(data));
        const std::size_t complete = session.render(views, function, {}, film, source.get_token());
        EXPECT_LT(complete, views.size());
        ASSERT_FALSE(film.frames.empty());
        EXPECT_TRUE(film.frames.back().stopped);
        Film next;
        EXPECT_EQ(session.render(std::span(views).first(2), function, {}, next), 2u);
        if (session.assembles()) {
          ASSERT_EQ(next.frames.size(), 2u);
          EXPECT_TRUE(same_bits(next.frames[1].image, whole.image));
        }
      }
    });
    EXPECT_EQ(assembled, 1);
  }
}

TEST_P(AnyKind, RanksStoppedAtRandomTimesGoOn) {
  const Dataset data = dataset(GetParam());
  const TransferFunction function = data.transfer_function().function;
  const RenderedFrame whole = Session(data).render(view_of(data), function);
  constexpr int ranks = 3;
  exchange::run_ranks(ranks, [&](exchange::Transport& transport) {
    Settings settings;
    settings.threads = 1;
    settings.ranks.exchange = Exchange::segments;
    Session session(data, settings, api::communicator_over(transport));
    std::mt19937 random(11);
    const std::vector<View> views(3, view_of(data));
    for (int i = 0; i < 30; ++i) {
      const int stopping_rank = static_cast<int>(random() % ranks);
      const auto delay = std::chrono::microseconds(random() % 30000);
      std::stop_source source;
      std::jthread stopper([&, stopping_rank] {
        if (transport.rank() != stopping_rank) return;
        std::this_thread::sleep_for(delay);
        source.request_stop();
      });
      Film film;
      const std::size_t complete = session.render(views, function, {}, film, source.get_token());
      if (!session.assembles()) continue;
      for (std::size_t f = 0; f < complete; ++f) EXPECT_TRUE(same_bits(film.frames[f].image, whole.image));
    }
    const RenderedFrame last = session.render(views.front(), function);
    EXPECT_FALSE(last.stopped);
    if (session.assembles()) {
      EXPECT_TRUE(same_bits(last.image, whole.image));
    }
  });
}

TEST_P(AnyKind, OnRanksASinksExceptionStopsAllAndReachesTheCaller) {
  const Dataset data = dataset(GetParam());
  const TransferFunction function = data.transfer_function().function;
  exchange::run_ranks(2, [&](exchange::Transport& transport) {
    Settings settings;
    settings.threads = 1;
    Session session(data, settings, api::communicator_over(transport));
    Throwing sink;
    if (session.assembles())
      EXPECT_THROW(session.render(view_of(data), function, {}, &sink), std::runtime_error);
    else
      EXPECT_TRUE(session.render(view_of(data), function, {}, &sink).stopped);
    EXPECT_FALSE(session.render(view_of(data), function).stopped);
  });
}

/// Throws an Error, as a writer would, at its second frame.
class FullDisk final : public Sink {
 public:
  [[nodiscard]] bool wants_tiles() const override { return false; }
  void frame(RenderedFrame&& frame) override {
    if (frame.number == 1 && !frame.stopped) throw Error(ErrorCode::system_failure, "frame_1.png: the disk is full");
  }
};

/// Throws an Error at each tile.
class FullPipe final : public Sink {
 public:
  void tile(const Tile& /*tile*/) override { throw Error(ErrorCode::system_failure, "client: it has gone"); }
};

TEST_P(AnyKind, ASinksErrorOfATileDoesNotFailTheRun) {
  const Dataset data = dataset(GetParam());
  const TransferFunction function = data.transfer_function().function;
  for (const int ranks : {1, 3})
    exchange::run_ranks(ranks, [&](exchange::Transport& transport) {
      Settings settings;
      settings.threads = 1;
      Session session(data, settings, api::communicator_over(transport));
      FullPipe sink;
      if (session.assembles())
        EXPECT_THROW(session.render(view_of(data), function, {}, &sink), Error);
      else
        EXPECT_TRUE(session.render(view_of(data), function, {}, &sink).stopped);
      EXPECT_FALSE(session.render(view_of(data), function).stopped);
    });
}

TEST_P(AnyKind, ASinksErrorDoesNotFailTheRun) {
  const Dataset data = dataset(GetParam());
  const TransferFunction function = data.transfer_function().function;
  const std::vector<View> views(4, view_of(data));
  for (const int ranks : {1, 3})
    exchange::run_ranks(ranks, [&](exchange::Transport& transport) {
      Settings settings;
      settings.threads = 1;
      Session session(data, settings, api::communicator_over(transport));
      for (int again = 0; again < 2; ++again) {
        FullDisk sink;
        if (session.assembles())
          EXPECT_THROW(session.render(views, function, {}, sink), Error);
        else
          EXPECT_LT(session.render(views, function, {}, sink), views.size());
      }
      EXPECT_FALSE(session.render(views.front(), function).stopped);
    });
}

TEST(MeshArrays, AreBorrowedWhereTheLayoutAllows) {
  const Cube cube(4);
  const Dataset data = Dataset::of(cube.arrays());
  EXPECT_EQ(StateAccess::of(data).mesh.positions.data(), cube.points.data());
  EXPECT_EQ(StateAccess::of(data).mesh.scalars.data(), cube.scalars.data());
  EXPECT_EQ(static_cast<const void*>(StateAccess::of(data).mesh.tets.data()), cube.tets.data());
  EXPECT_EQ(data.tet_count(), cube.tets.size() / 4);
  EXPECT_EQ(data.format(), "arrays");

  // The same numbers in other layouts give the same image.
  std::vector<std::int64_t> connectivity(cube.tets.begin(), cube.tets.end()), offsets;
  for (std::size_t i = 0; i <= connectivity.size(); i += 4) offsets.push_back(static_cast<std::int64_t>(i));
  const std::vector<CellType> types(cube.tets.size() / 4, CellType::tetra);
  MeshArrays others;
  others.points = cube.points;
  others.types = types, others.offsets = offsets, others.connectivity = connectivity;
  others.scalars = cube.scalars;
  const TransferFunction function = data.transfer_function().function;
  const RenderedFrame a = Session(data).render(view_of(data), function);
  const RenderedFrame b = Session(Dataset::of(others)).render(view_of(data), function);
  EXPECT_TRUE(same_bits(a.image, b.image));
}

TEST(MeshArrays, KeepTheirOwner) {
  auto cube = std::make_shared<Cube>(3);
  const std::weak_ptr<Cube> watched = cube;
  MeshArrays arrays = cube->arrays();
  arrays.owner = cube;
  {
    const Dataset data = Dataset::of(arrays);
    arrays = {}, cube.reset();
    EXPECT_FALSE(watched.expired());
    Session session(data);
    EXPECT_FALSE(session.render(view_of(data), data.transfer_function().function).stopped);
  }
  EXPECT_TRUE(watched.expired());
}

TEST(MeshArrays, HexahedraAndBlanksAreCutAndLeftOutAsFromFiles) {
  const std::vector<float> points{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1,
                                  1, 1, 1, 0, 1, 1, 2, 0, 0, 2, 1, 0, 2, 0, 1, 2, 1, 1};
  const std::vector<int> connectivity{0, 1, 2, 3, 4, 5, 6, 7, 1, 8, 9, 2, 5, 10, 11, 6};
  const std::vector<int> offsets{0, 8, 16};
  const std::vector<std::uint8_t> types{12, 12};
  std::vector<float> scalars{1, 2};
  MeshArrays arrays;
  arrays.points = points, arrays.connectivity = connectivity, arrays.offsets = offsets, arrays.types = types;
  arrays.scalars = scalars;
  arrays.association = Association::cell;
  const Dataset both = Dataset::of(arrays);
  EXPECT_EQ(both.bounds().high.x, 2);
  EXPECT_EQ(both.range()[1], 2);
  scalars[1] = std::nanf("");
  const Dataset one = Dataset::of(arrays);
  EXPECT_EQ(one.bounds().high.x, 1);
  EXPECT_EQ(one.mesh_counts().cells_nan, 1u);
}

/// The message of the Error that `call` throws.
template <class Call>
std::string error_of(const Call& call) {
  try {
    call();
  } catch (const scene::Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(MeshArrays, FaultsNameArrayAndPlace) {
  Cube cube(2);
  const auto error = [&] { return error_of([&] { Dataset::of(cube.arrays()); }); };
  cube.tets[7] = 99999;
  EXPECT_NE(error().find("tet corner 7 is 99999"), std::string::npos) << error();
  cube = Cube(2);
  cube.scalars.pop_back();
  EXPECT_NE(error().find("scalars for"), std::string::npos) << error();
  cube = Cube(2);
  cube.tets.pop_back();
  EXPECT_NE(error().find("not four per tet"), std::string::npos) << error();
  cube = Cube(2);
  cube.tets.clear();
  EXPECT_NE(error(), "no error");
  cube = Cube(2);
  std::fill(cube.scalars.begin(), cube.scalars.end(), NAN);
  EXPECT_NE(error(), "no error");
}

TEST(GridArrays, AreNeverCopiedAndChecked) {
  const std::vector<float> samples = waves(10);
  const Dataset data = Dataset::of(grid_arrays(samples, 10));
  EXPECT_TRUE(data.is_grid());
  EXPECT_EQ(data.grid_geometry().points[0], 10);
  EXPECT_EQ(data.sample_type(), SampleType::float32);
  EXPECT_NE(error_of([&] { Dataset::of(grid_arrays(samples, 11)); }), "no error");
  const std::vector<float> blank(1000, NAN);
  EXPECT_NE(error_of([&] { Dataset::of(grid_arrays(blank, 10)); }).find("finite"), std::string::npos);
  EXPECT_NE(error_of([&] { static_cast<void>(data.check()); }).find("grid"), std::string::npos);
}

TEST(SessionOnRanks, SendsSegmentsByItselfWhereRunsCannotDo) {
  const Cube cube(4);
  const Dataset data = Dataset::of(cube.arrays());
  const TransferFunction function = data.transfer_function().function;
  FrameSettings deep;
  deep.deep = true;
  const RenderedFrame alone = Session(data).render(view_of(data), function, deep);
  exchange::run_ranks(2, [&](exchange::Transport& transport) {
    Settings settings;
    settings.threads = 1;
    Session session(data, settings, api::communicator_over(transport));
    const RenderedFrame frame = session.render(view_of(data), function, deep);
    if (session.assembles()) {
      ASSERT_EQ(frame.deep.begin, alone.deep.begin);
      EXPECT_EQ(std::memcmp(frame.deep.samples.data(), alone.deep.samples.data(),
                            alone.deep.samples.size() * sizeof(DeepImageSample)),
                0);
    }
    settings.ranks.exchange = Exchange::runs;
    Session runs(data, settings, api::communicator_over(transport));
    EXPECT_THROW(static_cast<void>(runs.render(view_of(data), function, deep)), Error);
  });
}

TEST(DatasetParts, AreOneMeshOverRanks) {
  const scene::TetMesh mesh = datasets::cube(6);
  const auto parts = datasets::parts(mesh, 3, datasets::Partition::interleaved, 1);
  Settings settings;
  settings.threads = 1;
  settings.ranks.exchange = Exchange::segments;
  const Cube cube(6);
  const Dataset whole = Dataset::of(cube.arrays());
  const TransferFunction function = whole.transfer_function().function;
  const RenderedFrame expected = Session(whole, settings).render(view_of(whole), function);
  exchange::run_ranks(3, [&](exchange::Transport& transport) {
    const scene::TetMesh& mine = parts[static_cast<std::size_t>(transport.rank())];
    MeshArrays arrays;
    arrays.points = mine.positions;
    const std::span corners(mine.tets.front().data(), 4 * mine.tets.size());
    arrays.tets = corners;
    arrays.scalars = mine.scalars;
    const Communicator ranks = api::communicator_over(transport);
    const Dataset data = Dataset::of_parts(arrays, ranks);
    EXPECT_EQ(data.tet_count(), mesh.tets.size());
    EXPECT_EQ(data.bounds(), whole.bounds());
    Session session(data, settings, ranks);
    const RenderedFrame frame = session.render(view_of(data), function);
    if (session.assembles()) {
      EXPECT_TRUE(same_bits(frame.image, expected.image));
    }
  });
}

TEST(SessionSettings, FaultsNameTheSetting) {
  const Dataset mesh = dataset(Kind::mesh), grid = dataset(Kind::grid);
  Settings settings;
  settings.threads = -1;
  EXPECT_NE(error_of([&] { Session(mesh, settings); }).find("threads"), std::string::npos);
  EXPECT_NE(error_of([&] { Session(grid, settings); }).find("threads"), std::string::npos);
  Session session(mesh);
  View view = view_of(mesh);
  view.camera.position.x = NAN;
  EXPECT_EQ(error_of([&] { session.render(view, mesh.transfer_function().function); }).substr(0, 6), "view: ");
  view = view_of(mesh);
  view.size.width = 0;
  EXPECT_NE(error_of([&] { session.render(view, mesh.transfer_function().function); }), "no error");
  EXPECT_NE(error_of([&] { session.render(view_of(mesh), TransferFunction()); }).find("knots"), std::string::npos);
}

}  // namespace
}  // namespace tessera::session_test
