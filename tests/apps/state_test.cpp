// SPDX-License-Identifier: BSD-3-Clause
// A state as JSON, as TOML, as values and as options of the program: all give the same image.
#include "tessera/state.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <set>
#include <utility>

#include "apps/program.hpp"
#include "tessera/error.hpp"
#include "tessera/image_file.hpp"
#include "tessera/program/options.hpp"
#include "tessera/session.hpp"

namespace tessera::apps {
namespace {

using Files = std::vector<std::filesystem::path>;

std::string picture_of(const State& state, const Files& files) {
  const Dataset data = state.open(files);
  Session session(data, state.settings(data));
  const LoadedTransferFunction loaded = state.transfer_function(data);
  const View view = state.view(data);
  RenderedFrame frame = session.render(view, loaded.function);
  annotate(frame.image, state.annotation(data), view, data.bounds(), loaded.function);
  const std::vector<std::byte> bytes = png_bytes(frame.image, state.image_file_options());
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Returns `state` for these files after conversion to values and back.
State by_values(const State& state, const Files& files) {
  const Dataset data = state.open(files);
  const DataKind kind = data.is_grid() ? DataKind::grid : DataKind::mesh;
  State result;
  result.set(state.read_options(kind));
  result.set(state.settings(data), kind);
  result.set(state.transfer_function(data).function);
  result.set(state.view(data));
  result.set(state.annotation(data));
  result.set(state.image_file_options());
  return result;
}

struct Case {
  const char* data;  ///< mesh, grid or raw
  const char* state;
};
std::ostream& operator<<(std::ostream& out, const Case& each) { return out << each.data << ' ' << each.state; }

class States : public testing::TestWithParam<Case> {
 protected:
  [[nodiscard]] std::string file() const {
    if (GetParam().data == std::string("mesh")) return folder_.cube();
    if (GetParam().data == std::string("grid")) return folder_.rectilinear();
    std::string samples(std::size_t{6} * 5 * 4 * 2, '\0');
    for (std::size_t i = 0; i < samples.size() / 2; ++i) samples[2 * i] = static_cast<char>(i / 4);
    return folder_.file("a.raw", samples);
  }
  Folder folder_;
};

TEST_P(States, AreOnePictureInEveryForm) {
  const std::string input = file();
  State state = State::from_json(GetParam().state);
  if (!state.words().contains("size")) state.set("size", "40x30");
  EXPECT_EQ(State::from_json(state.json()), state);
  EXPECT_EQ(State::from_toml(state.toml()), state);

  const std::string picture = folder_ / "a.png", config = folder_.file("a.toml", state.toml());
  const Outcome run = tessera({"render", input, "--config", config, "-o", picture, "--quiet"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(picture_of(state, {input}), contents(picture));

  const State values = by_values(state, {input});
  EXPECT_EQ(State::from_json(values.json()), values);
  EXPECT_EQ(picture_of(State::from_toml(values.toml()), {input}), contents(picture)) << values.json();
  // A complete state converts to itself.
  EXPECT_EQ(by_values(values, {input}), values);
}

INSTANTIATE_TEST_SUITE_P(
    All, States,
    testing::Values(
        Case{"mesh", R"({})"}, Case{"mesh", R"({"view":"front","azimuth":20,"elevation":-10.5,"zoom":1.5})"},
        Case{"mesh", R"({"view":"top","up":"1,0,0","projection":"perspective","size":"33x44"})"},
        Case{"mesh", R"({"camera":{"position":[3,2,1],"focal_point":[0.5,0.5,0.5],"view_up":[0,0,1],
                         "view_angle":30},"fit":true})"},
        Case{"mesh", R"({"transfer-function":"plasma:rise","range":"0.1,0.9","opacity":3,"unit-distance":0.2})"},
        Case{"mesh", R"({"transfer-function":{"knots":[[0,0,0,1,0.5],[1,1,0.25,0,3]]},"blend":"display"})"},
        Case{"mesh", R"({"log":true,"range":"0.01,1","opacity-points":"0:0,0.3:0.02,1:0.8"})"},
        Case{"mesh", R"({"clip":["0.5,0.5,0.5,1,2,0","box:0,0,0,1,0.75,1"],"threshold":"0.2,0.9","scale":"1,2,1"})"},
        Case{"mesh", R"({"iso":[0.5,"0.75:red:0.5","0.25::0.25"],"surface":["boundary:steelblue:0.25"]})"},
        Case{"mesh", R"({"shade":true,"light":"world:1,0,0.5"})"}, Case{"mesh", R"({"shade":true,"light":"1,2,3"})"},
        Case{"mesh", R"({"integrator":"sampled:3"})"}, Case{"mesh", R"({"integrator":"preintegrated:64"})"},
        Case{"mesh", R"({"integrator":"partial"})"}, Case{"mesh", R"({"accuracy":1e-5,"emission":"independent"})"},
        Case{"mesh", R"({"rasterizer":"scanline","tile-size":16,"without":"culling,termination"})"},
        Case{"mesh", R"({"background":"steelblue","png-bits":16,"half":true})"},
        Case{"mesh", R"({"color-bar":true,"axes":true,"outline":true,"scale-bar":true,"size":"200x150",
                         "annotate":["{field} {min} {max} {file} {time} {frame}","bottom:it's \"it\""]})"},
        Case{"mesh", R"({"color-bar":"left","color-bar-title":"a: b","color-bar-range":"0.125,0.5","size":"200x150",
                         "color-bar-scale":"log","field-unit":"K","axes":"both","scale-bar":"top","length-unit":"m",
                         "annotation-color":"0.1,0.2,0.3","annotation-size":9})"},
        Case{"grid", R"({})"}, Case{"grid", R"({"shade":true,"brick-size":8,"edge-bricks":"fixed"})"},
        Case{"grid", R"({"integrator":"exact","iso":["0.5:#204060"],"clip":"0.5,0.5,0.5,0,0,1","no-shade":true})"},
        Case{"raw", R"({"dims":"6x5x4","type":"int16","integrator":"sampled","step":0.25,"view":"iso"})"},
        Case{"raw", R"({"dims":"6x5x4","type":"uint16","spacing":"1,0.5,2","origin":"-1,0,1e3","labels":"off"})"},
        Case{"raw", R"({"dims":"5x5x4","type":"uint16","endian":"big","skip":40,"labels":"on"})"}));

/// Tests every option of `render` whose text is stored verbatim in a value, with a text other than the default.
TEST(State, HasTheWordsOfEveryValue) {
  const Folder folder;
  const State of_meshes = State::from_json(R"({
    "field":"cell:a:b","smooth":true,"warp":"u:v:0.5","q":"a.q","max-volume":0.5,"time-step":3,"block":["a","b/c"],
    "drop-duplicates":true,"scale":"1,2,0.25","clip":["0,0,0,1,2,3"],"threshold":"-1,1e-30",
    "higher-order-tolerance":0.001,"higher-order-tets":77,"threads":3,"memory":"1073741825",
    "iso":["0.25:0.5,0.25,0.125:0.75"],"surface":["boundary::0.5"],"shade":true,"light":"world:0.5,0.25,1",
    "integrator":"sampled:5","emission":"independent","without":"culling,skipping,termination,lattice,sharing",
    "rasterizer":"device","tile-size":8,"compositor":"gl-fragment","backend":"osmesa,egl,cpu,auto",
    "framebuffer":"float","egl-device":2,"projectors":2,"compositors":3,"exchange":"segments","partition":"random",
    "frames-in-flight":4,"seed":9})");
  const State of_grids = State::from_json(R"({
    "labels":"on","dims":"2x3x4","type":"float64","spacing":"1,2,3","origin":"0.1,0,-1","endian":"big","skip":17,
    "no-shade":true,"step":0.125,"integrator":"preintegrated","brick-size":16,"edge-bricks":"fixed",
    "cache":"proximity","preload":5,"distribution":"sort-last","direct-send":"synchronous"})");
  const State balanced = State::from_json(
      R"({"no-shade":true,"accuracy":"0.001","balance":"splatting","balance-resolution":0.25,"balance-weights":"1,2.5"})");
  const Dataset mesh = State().open(Files{folder.cube()}), grid = State().open(Files{folder.rectilinear()});
  std::set<std::string, std::less<>> stated = {"transfer-function", "camera"};
  for (const auto& [state, data, kind] :
       {std::tuple(of_meshes, mesh, DataKind::mesh), std::tuple(of_grids, grid, DataKind::grid),
        std::tuple(balanced, grid, DataKind::grid)}) {
    State result;
    result.set(state.read_options(kind));
    result.set(state.settings(data), kind);
    EXPECT_EQ(result.json(), state.json());
    for (const auto& [option, words] : state.words()) stated.insert(option);
  }
  const State drawn = State::from_json(R"({
    "color-bar":"top","color-bar-title":"p","color-bar-range":"0,2","color-bar-scale":"log","axes":"box","outline":true,
    "scale-bar":"bottom","length-unit":"mm","annotate":["top-right:a:b"],"annotation-color":"0.25,1,2",
    "annotation-size":11.5})");
  State result;
  result.set(drawn.annotation(mesh));
  EXPECT_EQ(result.json(), drawn.json());
  for (const auto& [option, words] : drawn.words()) stated.insert(option);
  const State written = State::from_json(R"({"half":true,"png-bits":16,"blend":"display","background":"0.5,0,1"})");
  result = State();
  result.set(written.image_file_options());
  EXPECT_EQ(result.json(), written.json());
  for (const auto& [option, words] : written.words()) stated.insert(option);

  // Options that become a camera, a transfer function or a title, and options that do not belong to any value.
  stated.insert({"view", "up", "azimuth", "elevation", "zoom", "fit", "orbit", "size", "projection"});
  stated.insert({"rescale", "unit-distance", "opacity", "range", "log", "opacity-points", "field-unit"});
  stated.insert({"input",  "more",          "output",   "frame-rate",    "peel",   "resume",      "report",
                 "timing", "progress",      "quiet",    "deep-accuracy", "repeat", "verify",      "preset",
                 "show",   "stall-timeout", "on-stall", "like",          "config", "save-config", "annotation-layer"});
  for (const OptionRow* row : option_rows(Trait::render))
    EXPECT_TRUE(stated.contains(row->key())) << row->key() << " is set by no value";
}

TEST(State, ReplacesOptions) {
  State state = State::from_json(R"({"view":"top","zoom":2,"log":true,"range":"1,2","size":"8x8","outline":true,
    "smooth":true,"shade":true})");
  state.set(ReadOptions{});
  state.set(Settings{}, DataKind::mesh);
  state.set(View{});
  state.set(TransferFunction({{0, {1, 1, 1}, 1}}));
  state.set(Annotation{});
  std::set<std::string> options;
  for (const auto& [option, words] : state.words()) options.insert(option);
  EXPECT_EQ(options, (std::set<std::string>{"camera", "transfer-function"}));
}

template <class Function>
std::string fault_of(const Function& function) {
  try {
    function();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_input);
    return error.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return "";
}

TEST(State, ReportsErrorsByName) {
  const auto json = [](const char* text) { return fault_of([&] { State::from_json(text, "s.json"); }); };
  EXPECT_EQ(json(R"({"feild":"p"})"), "s.json: 'feild' is not an option of render; did you mean field?");
  EXPECT_EQ(json(R"({"zoom":[1,2]})"), "s.json: 'zoom' is not text or a number; give one");
  EXPECT_EQ(json(R"({"log":1})"), "s.json: 'log' is not true or false; give one");
  EXPECT_EQ(json(R"({"opacity":1,"opacity-scale":1})"),
            "s.json: 'opacity-scale' is given twice, by two names; keep one");
  EXPECT_EQ(json(R"({"config":"a"})"), "s.json: 'config' would read another such file; leave it out");
  EXPECT_EQ(json("[]"), R"(s.json: is not a JSON object; write one, like {"field": "T", "size": "800x600"})");
  EXPECT_EQ(json("{"), json("[]"));
  const auto toml = [](const char* text) { return fault_of([&] { State::from_toml(text, "s.toml"); }); };
  EXPECT_EQ(toml("size = [1, 2]"), "s.toml: 'size' takes one value; give one");
  EXPECT_EQ(toml("log = 1"), "s.toml: 'log' is true or false, not '1'");
  State state;
  EXPECT_EQ(fault_of([&] { state.set("sise", "8x8"); }),
            "state: 'sise' is not an option of render; did you mean size?");
  EXPECT_EQ(fault_of([&] {
              state.set("size", std::vector<std::string>{"8x8", "9x9"});
            }),
            "state: 'size' takes one value; give one");

  const Folder folder;
  const Files files{folder.cube()};
  const auto used = [&](const char* text) {
    const State wrong = State::from_json(text);
    return fault_of([&] { static_cast<void>(wrong.settings(wrong.open(files))); });
  };
  EXPECT_EQ(used(R"({"accuracy":"x"})"), "`accuracy`: 'x' is not a number above 0");
  EXPECT_EQ(used(R"({"light":"1,0,0"})"),
            "`light`: it has no effect without `shade`; add `shade`, or leave `light` out");
  EXPECT_EQ(used(R"({"step":"0.5"})"), "`step`: it is for volumes, but the input is a mesh; leave it out");
  EXPECT_EQ(used(R"({"time-step":"all"})"),
            "`time_step`: 'all' means a film, which only render can make; give one step");
}

TEST(State, RefusesValuesWithoutWords) {
  State state;
  Settings settings;
  settings.surfaces.triangles.emplace_back();
  EXPECT_EQ(fault_of([&] { state.set(settings, DataKind::mesh); }),
            "`surface`: triangles in memory, which no option can express; give it to the session");
  settings = {};
  settings.mesh.shading.emplace().ambient = 0.5;
  EXPECT_NE(fault_of([&] { state.set(settings, DataKind::mesh); }).find("`shade`: other coefficients"),
            std::string::npos);
  EXPECT_NO_THROW(state.set(settings, DataKind::grid));
  settings = {};
  settings.ranks.tile_seed = 7;
  EXPECT_NE(fault_of([&] { state.set(settings, DataKind::mesh); }).find("`seed`"), std::string::npos);
  Annotation annotation;
  annotation.axes.emplace().place = Place::top;
  EXPECT_NE(fault_of([&] { state.set(annotation); }).find("`axes`"), std::string::npos);
}

TEST(State, KeepsOtherBytesThanUtf8InTomlOnly) {
  State state;
  state.set("save-config", std::string("x.toml"));
  state.set("output", "caf\xE9.png");
  EXPECT_EQ(fault_of([&] { (void)state.json(); }),
            "state: 'output' is not UTF-8, which JSON requires; write TOML instead");
  EXPECT_EQ(State::from_toml(state.toml()).words().at("output").front(), "caf\xE9.png");
}

TEST(State, OpensDataInMemoryToo) {
  const std::vector<double> points = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, values = {0, 1, 2, 3};
  const std::vector<std::uint32_t> tets = {0, 1, 2, 3};
  MeshArrays arrays;
  arrays.points = points;
  arrays.tets = tets;
  arrays.scalars = values;
  const Dataset data = Dataset::of(arrays);
  const State state = State::from_json(R"({"size":"8x8","iso":1.5,"surface":"boundary::0.5"})");
  EXPECT_EQ(state.settings(data).surfaces.iso.front().value, 1.5);
  EXPECT_EQ(state.view(data).size, (ImageSize{8, 8}));
  const State block = State::from_json(R"({"surface":"walls"})");
  EXPECT_EQ(fault_of([&] { static_cast<void>(block.settings(data)); }),
            "`surface`: 'walls' is a block, and data in memory have no blocks; give a file of triangles");
}

}  // namespace
}  // namespace tessera::apps
