// SPDX-License-Identifier: BSD-3-Clause
// The public headers with the whole library, and nothing else: traces, a caller's own samples, a mesh's arrays, the
// reference, ranks without MPI.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <mutex>
#include <new>
#include <numeric>
#include <set>

#include "cubes.hpp"
#include "tessera/tessera.hpp"

namespace tessera {
namespace {

namespace fs = std::filesystem;

/// A temporary directory of this process.
class Folder {
 public:
  Folder() : path_(fs::temp_directory_path() / ("tessera_callers_" + std::to_string(getpid()))) {
    fs::create_directories(path_);
  }
  ~Folder() { fs::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  [[nodiscard]] fs::path operator/(const char* name) const { return path_ / name; }
  fs::path touch(const char* name) const {
    std::ofstream(path_ / name) << "x";
    return path_ / name;
  }

 private:
  fs::path path_;
};

constexpr std::int64_t side = 21;
constexpr ImageSize size{61, 47};

float wave(std::int64_t i, std::int64_t j, std::int64_t k) {
  return std::sin(0.31f * static_cast<float>(i)) * std::cos(0.23f * static_cast<float>(j)) +
         0.02f * static_cast<float>(k);
}

Grid wave_grid() {
  Grid grid;
  grid.geometry.points = {side, side, side};
  return grid;
}

/// Samples that are computed where they are read.
class Waves final : public SampleSource {
 public:
  Waves() : SampleSource(wave_grid(), "waves") {}

 private:
  void read_samples(const SampleBox& box, const SampleLayout& layout, std::byte* destination) const override {
    for (std::int64_t k = box.low[2]; k < box.high[2]; ++k)
      for (std::int64_t j = box.low[1]; j < box.high[1]; ++j)
        for (std::int64_t i = box.low[0]; i < box.high[0]; ++i) {
          const float value = wave(i, j, k);
          const double wide = value;
          const auto at = static_cast<std::size_t>((k - box.low[2]) * layout.slice_pitch +
                                                   (j - box.low[1]) * layout.row_pitch + (i - box.low[0]));
          if (layout.type == SampleType::float64)
            std::memcpy(destination + 8 * at, &wide, 8);
          else
            std::memcpy(destination + 4 * at, &value, 4);
        }
  }
};

Image picture_of(const Dataset& data, const Settings& settings = {}) {
  return Session(data, settings).render(data.default_view(size), data.transfer_function().function).image;
}

Settings on_one_thread() {
  Settings settings;
  settings.threads = 1;
  return settings;
}

TEST(CallersSamples, GiveThePictureOfTheSameSamplesInMemory) {
  std::vector<float> samples;
  for (std::int64_t k = 0; k < side; ++k)
    for (std::int64_t j = 0; j < side; ++j)
      for (std::int64_t i = 0; i < side; ++i) samples.push_back(wave(i, j, k));
  GridArrays arrays;
  arrays.geometry = wave_grid().geometry;
  arrays.samples = samples;
  const Dataset in_memory = Dataset::of(arrays), computed = Dataset::of(std::make_shared<const Waves>());
  EXPECT_EQ(computed.range(), in_memory.range());
  EXPECT_EQ(computed.fields().front().type, "float32");
  const Image picture = picture_of(computed);
  EXPECT_GT(*std::ranges::max_element(picture.rgba), 0.05f);
  EXPECT_EQ(picture.rgba, picture_of(in_memory).rgba);
}

TEST(CallersViews, TheDefaultViewIsTheDefaultCameraWithItsSize) {
  const Cubes cubes(3);
  const Dataset data = Dataset::of(cubes.arrays());
  EXPECT_EQ(data.default_view(size), (View{data.default_camera(size), size}));
  const View deep = data.default_view(size, ProjectionKind::perspective);
  EXPECT_EQ(deep, (View{data.default_camera(size, ProjectionKind::perspective), size}));
  EXPECT_EQ(deep.camera.projection, ProjectionKind::perspective);
  EXPECT_THROW((void)data.default_view({0, 5}), Error);
}

template <class Class>
concept ShowsItsState = requires(const Class& object) {
  object.state();
}
|| std::constructible_from<Class, std::shared_ptr<const typename Class::State>> ||
    std::constructible_from<Class, std::unique_ptr<typename Class::State>>;

TEST(CallersClasses, HideTheLibrarysState) {
  EXPECT_FALSE(ShowsItsState<Dataset>);
  EXPECT_FALSE(ShowsItsState<Session>);
  EXPECT_FALSE(ShowsItsState<Communicator>);
  const Cubes cubes(2);
  const Dataset data = Dataset::of(cubes.arrays());
  EXPECT_TRUE(Session(data).dataset().is_copy_of(data));
  EXPECT_FALSE(Dataset::of(cubes.arrays()).is_copy_of(data));
}

TEST(CallersReference, PicturesKeepThePromiseAgainstIt) {
  const Cubes cubes(3);
  const Dataset data = Dataset::of(cubes.arrays());
  Settings settings;
  settings.integrator.kind = IntegratorKind::exact;
  Session session(data, settings);
  const View view = data.default_view(size);
  const TransferFunction function = data.transfer_function().function;
  const Image picture = session.render(view, function).image;
  const auto pixels = random_pixels(size, 200, 3);
  const auto truth = Reference(data, view, function, settings).pixels(pixels, 1);
  ASSERT_EQ(truth.size(), 200u);
  double worst = 0, largest = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const float* const rgba = &picture.rgba[4 * picture.index(pixels[i].x, pixels[i].y)];
    const double right[] = {truth[i].r, truth[i].g, truth[i].b, truth[i].a};
    for (int c = 0; c < 4; ++c) worst = std::max(worst, std::abs(rgba[c] - right[c]));
    largest = std::max(largest, truth[i].a);
  }
  EXPECT_GT(largest, 0.1);  // something is visible
  EXPECT_LE(worst, session.promised_error().value());
}

TEST(CallersRanks, ThreadsMakeThePictureOfOneProcess) {
  const Cubes cubes(4);
  const Dataset data = Dataset::of(cubes.arrays());
  Settings settings = on_one_thread();
  settings.ranks.exchange = Exchange::segments;
  const Image alone = picture_of(data, settings);
  Image together;
  std::set<int> ranks;
  std::mutex mutex;
  run_ranks(3, [&](const Communicator& communicator) {
    Session session(data, settings, communicator);
    RenderedFrame frame = session.render(data.default_view(size), data.transfer_function().function);
    const std::lock_guard lock(mutex);
    ranks.insert(communicator.rank());
    EXPECT_EQ(communicator.size(), 3);
    if (session.assembles()) together = std::move(frame.image);
  });
  EXPECT_EQ(ranks, (std::set{0, 1, 2}));
  EXPECT_EQ(together.rgba, alone.rgba);
  EXPECT_THROW(run_ranks(2,
                         [](const Communicator& c) {
                           if (c.rank() == 1) throw bad_input("rank: of no use");
                         }),
               Error);
}

TEST(CallersMesh, ArraysComeBackAsTheyAre) {
  const Cubes cubes(2);
  const Dataset data = Dataset::of(cubes.arrays());
  const MeshArrays back = data.mesh_arrays();
  EXPECT_EQ(back.points.data(), cubes.points.data());
  EXPECT_EQ(back.tets.data(), cubes.tets.data());
  EXPECT_EQ(back.tets.size(), cubes.tets.size());
  EXPECT_EQ(back.scalars.as<double>().size(), cubes.scalars.size());
  EXPECT_EQ(back.field_name, "scalar");
  EXPECT_THROW(static_cast<void>(Dataset::of(std::make_shared<const Waves>()).mesh_arrays()), Error);
}

TEST(CallersMesh, ArraysAreWrittenAsTheyAre) {
  const Folder folder;
  Cubes cubes(2);
  // Files round to float; these coordinates and scalars are floats.
  write_mesh(cubes.arrays(), folder / "mesh.tets");
  ReadOptions keep;
  keep.keep_corners = true;
  const Dataset read = Dataset::open(folder / "mesh.tets", keep);
  const auto tets = read.mesh_arrays().tets.as<std::uint32_t>();
  EXPECT_TRUE(std::ranges::equal(tets, cubes.tets));
  EXPECT_TRUE(std::ranges::equal(read.mesh_arrays().scalars.as<double>(), cubes.scalars));

  MeshArrays wrong = cubes.arrays();
  cubes.cube_of.pop_back();
  wrong.original_cells = cubes.cube_of;
  EXPECT_THROW(write_mesh(wrong, folder / "wrong.tets"), Error);
  EXPECT_THROW(write_mesh(cubes.arrays(), folder / "mesh.obj"), Error);
}

#ifdef TESSERA_VTK
TEST(CallersMesh, PiecesAreOneMeshThatNumbersItsOriginalCells) {
  const Folder folder;
  const Cubes cubes(3);
  MeshArrays arrays = cubes.arrays();
  arrays.original_cells = cubes.cube_of;
  write_mesh_pieces(arrays, folder / "mesh.pvtu", 4);
  const Dataset read = Dataset::open(folder / "mesh.pvtu", {.field = "scalar"});
  EXPECT_EQ(read.tet_count(), cubes.tets.size() / 4);
  const auto fields = read.fields();
  const auto cells = std::ranges::find(fields, "OriginalCellId", &FieldInfo::name);
  ASSERT_NE(cells, fields.end());
  EXPECT_EQ(cells->association, Association::cell);
  EXPECT_EQ(cells->high, static_cast<double>(cubes.cubes - 1));
  // An input must not be overwritten.
  const InputFile input(folder / "mesh.pvtu");
  EXPECT_THROW(check_mesh_output(folder / "mesh.pvtu", &input, 2), Error);
  EXPECT_NO_THROW(check_mesh_output(folder / "other.pvtu", &input, 2));
  EXPECT_THROW(check_mesh_output(folder / "other.vtu", &input, 2), Error);
}
#endif

TEST(CallersTrace, HoldsASessionsStagesAndIsReadAgain) {
  const Folder folder;
  const Cubes cubes(3);
  const Dataset data = Dataset::of(cubes.arrays());
  Trace trace;
  Settings settings = on_one_thread();
  settings.trace = &trace;
  trace.set_frame(7);
  picture_of(data, settings);
  const auto spans = trace.spans();
  const auto projects =
      std::ranges::find_if(spans, [](const TraceSpan& s) { return s.stage == std::string("project"); });
  ASSERT_NE(projects, spans.end());
  EXPECT_EQ(projects->frame, 7);
  TraceRun run;
  run.input = "cubes";
  run.width = size.width;
  write_trace(trace, run, folder / "trace.json");
  const TraceFile read = read_trace(folder / "trace.json");
  EXPECT_EQ(read.run, run);
  EXPECT_EQ(read.spans.size(), spans.size());
  EXPECT_TRUE(std::ranges::any_of(read.stages, [](const std::string& stage) { return stage == "project"; }));
}

TEST(CallersTrace, RanksSpansGoIntoOneFileWithTheirRoles) {
  const Folder folder;
  const Cubes cubes(3);
  const Dataset data = Dataset::of(cubes.arrays());
  run_ranks(2, [&](const Communicator& communicator) {
    Trace trace;
    {
      Settings settings = on_one_thread();
      settings.trace = &trace;
      Session session(data, settings, communicator);
      session.render(data.default_view(size), data.transfer_function().function);
    }
    write_trace(trace, "rank " + std::to_string(communicator.rank()), {}, folder / "trace.json", communicator, 1);
  });
  const TraceFile read = read_trace(folder / "trace.json");
  for (const int rank : {0, 1})
    for (const TraceRole role : {TraceRole::projector, TraceRole::compositor})
      EXPECT_TRUE(std::ranges::any_of(read.spans, [&](const FileSpan& s) { return s.rank == rank && s.role == role; }))
          << rank;
}

TEST(CallersBalance, NeedsAFrameThatKeptItsCost) {
  const Dataset data = Dataset::of(std::make_shared<const Waves>());
  Session session(data);
  const View view = data.default_view(size);
  const TransferFunction function = data.transfer_function().function;
  RenderedFrame frame = session.render(view, function);
  EXPECT_THROW(static_cast<void>(session.balance_pictures(frame, view, function)), Error);
  frame = session.render(view, function, {.keep_cost = true});
  const BalancePictures pictures = session.balance_pictures(frame, view, function);
  EXPECT_EQ(pictures.bricks.size, size);
  const std::size_t middle = 4 * pictures.cost.index(size.width / 2, size.height / 2), corner = 0;
  EXPECT_GT(pictures.cost.rgba[middle], 0.0f);  // expensive
  EXPECT_EQ(pictures.cost.rgba[corner], 0.0f);  // nothing is there
  EXPECT_EQ(pictures.cost.rgba[corner + 3], 1.0f);
  EXPECT_NE(pictures.bricks.rgba, frame.image.rgba);
  const Cubes cubes(1);
  const Session of_mesh(Dataset::of(cubes.arrays()));
  EXPECT_THROW(static_cast<void>(of_mesh.balance_pictures(frame, view, function)), Error);
}

TEST(CallersBalance, SortLastDrawsBricksInTheColoursOfTheirParts) {
  const Dataset data = Dataset::of(std::make_shared<const Waves>());
  const View view = data.default_view(size);
  const TransferFunction function = data.transfer_function().function;
  run_ranks(2, [&](const Communicator& communicator) {
    Settings settings;
    settings.threads = 1;
    settings.ranks.distribution = Distribution::sort_last;
    Session session(data, settings, communicator);
    const RenderedFrame frame = session.render(view, function, {.keep_cost = true});
    if (!session.assembles()) return;
    ASSERT_EQ(frame.statistics.parts.size(), 2u);
    const BalancePictures pictures = session.balance_pictures(frame, view, function);
    int red = 0, green = 0, white = 0, costly = 0;
    for (std::size_t n = 0; n < pictures.bricks.depth.size(); ++n) {
      // Lines are drawn over an image that is dimmed to half.
      const float* const p = &pictures.bricks.rgba[4 * n];
      red += p[0] > 0.7f && p[1] < 0.4f ? 1 : 0;
      green += p[1] > 0.4f && p[0] < 0.3f ? 1 : 0;
      white += p[0] > 0.9f && p[1] > 0.9f && p[2] > 0.9f ? 1 : 0;
      ASSERT_EQ(pictures.cost.rgba[4 * n + 3], 1.0f);
      costly += pictures.cost.rgba[4 * n] > 0.9f ? 1 : 0;
    }
    EXPECT_GT(red + white, 0);
    EXPECT_GT(green + white, 0);
    EXPECT_GT(white, 0) << "the outlines of the parts";
    EXPECT_GT(costly, 0) << "the part that took most is white";
  });
}

TEST(CallersDevice, PromisesAnErrorWhereNoDeviceIsRequested) {
  const Cubes cubes(1);
  const Dataset data = Dataset::of(cubes.arrays());
  EXPECT_TRUE(Session(data).promised_error().has_value());
  Settings settings;
  settings.mesh.device.method = GlMethod::fragment;
  EXPECT_TRUE(Session(data, settings).promised_error().has_value());  // no device is requested
}

TEST(CallersJob, OneProcessIsAJobToo) {
  int reports = 0;
  Job job({"test", "start again", [&](const Error&) { ++reports; }});
  EXPECT_EQ(job.rank(), 0);
  EXPECT_EQ(job.size(), 1);
  EXPECT_EQ(job.communicator().size(), 1);
  EXPECT_EQ(job.broadcast(0, {std::byte{5}}), std::vector{std::byte{5}});
  job.fail(bad_input("thing: is wrong; correct it"));
  job.fail(bad_input("thing: is wrong again"));
  const auto error = job.finish();
  ASSERT_TRUE(error);
  EXPECT_STREQ(error->what(), "thing: is wrong; correct it");
  EXPECT_EQ(reports, 1);
}

TEST(CallersErrors, AnyExceptionHasAnError) {
  const auto of = [](const auto& thrown) { return error_of(std::make_exception_ptr(thrown)); };
  EXPECT_STREQ(of(bad_input("a: b; c")).what(), "a: b; c");
  EXPECT_EQ(of(bad_input("a: b; c")).code(), ErrorCode::bad_input);
  EXPECT_EQ(of(std::bad_alloc()).subject(), "memory");
  EXPECT_EQ(of(std::bad_alloc()).code(), ErrorCode::system_failure);
  EXPECT_STREQ(of(std::runtime_error("odd")).what(), "unexpected: odd; please report");
  EXPECT_EQ(of(5).code(), ErrorCode::system_failure);
}

#ifdef TESSERA_VTK
/// Writes a block as a VTK structured or regular grid. Along each axis, the block has `n` cells of size 1 / `parts`,
/// from cell `first` on. It has a linear point field p, and a cell field c with the value `cell_at` of the cells'
/// centres.
void write_block(const fs::path& file, bool structured, int parts, int first, int n,
                 const std::function<double(std::array<double, 3>)>& cell_at) {
  std::ofstream out(file);
  out.precision(17);
  const char* const kind = structured ? "StructuredGrid" : "ImageData";
  const double spacing = 1.0 / parts, low = spacing * first;
  const std::string extent = "0 " + std::to_string(n);
  const std::string extents = extent + " " + extent + " " + extent;
  const auto each = [&](int count, double offset, const auto& write) {
    for (int k = 0; k < count; ++k)
      for (int j = 0; j < count; ++j)
        for (int i = 0; i < count; ++i)
          write(std::array{low + spacing * (i + offset), low + spacing * (j + offset), low + spacing * (k + offset)});
  };
  out << "<VTKFile type=\"" << kind << "\" version=\"0.1\" byte_order=\"LittleEndian\"><" << kind << " WholeExtent=\""
      << extents << "\" Origin=\"" << low << ' ' << low << ' ' << low << "\" Spacing=\"" << spacing << ' ' << spacing
      << ' ' << spacing << "\"><Piece Extent=\"" << extents
      << "\"><PointData><DataArray type=\"Float64\" Name=\"p\" format=\"ascii\">";
  each(n + 1, 0, [&](const auto& at) { out << 1 + 2 * at[0] - 3 * at[1] + 0.5 * at[2] << ' '; });
  out << "</DataArray></PointData><CellData><DataArray type=\"Float64\" Name=\"c\" format=\"ascii\">";
  each(n, 0.5, [&](const auto& at) { out << cell_at(at) << ' '; });
  out << "</DataArray></CellData>";
  if (structured) {
    out << "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">";
    each(n + 1, 0, [&](const auto& at) { out << at[0] << ' ' << at[1] << ' ' << at[2] << ' '; });
    out << "</DataArray></Points>";
  }
  out << "</Piece></" << kind << "></VTKFile>";
}

TEST(CallersLevels, MakeThePictureOfTheFinestGridEverywhere) {
  const Folder folder;
  // Each block has 4 cells per side, of size one, a half or a quarter. At one corner, the level changes by two.
  struct Block {
    int level, parts, first, n;
  };
  const Block blocks[] = {{0, 1, 0, 4}, {1, 2, 2, 4}, {2, 4, 6, 4}, {2, 4, 12, 4}};
  const auto value_at = [&](std::array<double, 3> at) {
    const Block* deepest = blocks;
    for (const Block& block : blocks)
      if (std::ranges::all_of(
              at, [&](double x) { return x * block.parts > block.first && x * block.parts < block.first + block.n; }))
        deepest = &block;
    double value = 0;
    for (int a = 0; a < 3; ++a)
      value +=
          (a + 1) * std::sin(3 * (std::floor(at[static_cast<std::size_t>(a)] * deepest->parts) + 0.5) / deepest->parts);
    return value;
  };
  std::string list;
  for (const Block& block : blocks) {
    const std::string name = "level" + std::to_string(&block - blocks) + ".vti";
    write_block(folder / name.c_str(), false, block.parts, block.first, block.n, value_at);
    list += "<Block level=\"" + std::to_string(block.level) + "\"><DataSet index=\"0\" file=\"" + name + "\"/></Block>";
  }
  std::ofstream(folder / "levels.vthb")
      << "<VTKFile type=\"vtkNonOverlappingAMR\" version=\"1.1\"><vtkNonOverlappingAMR>" << list
      << "</vtkNonOverlappingAMR></VTKFile>";
  write_block(folder / "finest.vts", true, 4, 0, 16, value_at);

  for (const char* const name : {"p", "c"}) {
    ReadOptions options;
    options.field = name;
    const Dataset levels = Dataset::open(folder / "levels.vthb", options);
    const Dataset finest = Dataset::open(folder / "finest.vts", options);
    Settings settings;
    settings.integrator.kind = IntegratorKind::exact;
    Session first(levels, settings), second(finest, settings);
    const View view = finest.default_view(size);
    const TransferFunction function = finest.transfer_function().function;
    const Image picture = first.render(view, function).image, expected = second.render(view, function).image;
    double worst = 0;
    for (std::size_t i = 0; i < picture.rgba.size(); ++i)
      worst = std::max(worst, std::abs(double{picture.rgba[i]} - double{expected.rgba[i]}));
    EXPECT_GT(*std::ranges::max_element(expected.rgba), 0.1f) << name;
    EXPECT_LE(worst, first.promised_error().value() + second.promised_error().value()) << name;
  }
}
#endif

TEST(CallersFiles, JsonHasItsDocumentedMeaning) {
  EXPECT_NO_THROW(check_json(R"({"a": 1, "b": [2]})", "a.json"));
  EXPECT_THROW(check_json(R"({"a": 1, "a": 2})", "twice"), Error);
  EXPECT_THROW(check_json("{", "short"), Error);
  EXPECT_THROW(static_cast<void>(read_text("none.json")), Error);
}

}  // namespace
}  // namespace tessera
