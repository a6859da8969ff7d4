// SPDX-License-Identifier: BSD-3-Clause
#include "tessera/settings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "datasets/arrays.hpp"
#include "datasets/boxes.hpp"
#include "tessera/error.hpp"
#include "tessera/session.hpp"

namespace tessera::settings_test {
namespace {

/// A fault, the setting that the error names, and its message.
struct Fault {
  std::function<void(Settings&)> make;
  std::string setting, words;
};

Error error_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_input) << error.what();
    return error;
  }
  return bad_input("no error");
}

void expect_refused(const std::vector<Fault>& faults, DataKind data) {
  EXPECT_NO_THROW(validate(Settings(), data));
  for (const Fault& fault : faults) {
    Settings settings;
    fault.make(settings);
    const Error error = error_of([&] { validate(settings, data); });
    EXPECT_EQ(error.setting(), fault.setting) << error.what();
    EXPECT_NE(std::string(error.what()).find(fault.words), std::string::npos) << error.what();
  }
}

const std::vector<Fault> faults_of_all{
    {[](Settings& s) { s.threads = -1; }, "threads", "0 (all cores) to 1024"},
    {[](Settings& s) { s.threads = 1025; }, "threads", "0 (all cores) to 1024"},
    {[](Settings& s) { s.integrator.accuracy = 0; }, "accuracy", "must be positive"},
    {[](Settings& s) { s.integrator.accuracy = NAN; }, "accuracy", "must be positive"},
    {[](Settings& s) { s.integrator.accuracy = 1e-7; }, "accuracy", "1e-06 at best"},
    {[](Settings& s) { s.ranks.frames_in_flight = 0; }, "frames_in_flight", "at least 1"},
    {[](Settings& s) {
       s.surfaces.iso = {{0.5, {}, 0}};
     },
     "iso", "opacity 0"},
    {[](Settings& s) {
       s.surfaces.iso = {{NAN, {}, 1}};
     },
     "iso", "not finite"},
};

void shade(Settings& settings, const Shading& shading) { settings.mesh.shading = settings.grid.shading = shading; }
const std::vector<Fault> faults_of_shading{
    {[](Settings& s) { shade(s, {}), s.emission = Emission::independent; }, "shade",
     "shading does not support `emission` independent"},
    {[](Settings& s) {
       shade(s, {.to_light = {0, 0, 0}});
     },
     "light", "has no length"},
    {[](Settings& s) { shade(s, {.ambient = -1}); }, "shade", "0 or more"},
};

const std::vector<Fault> faults_of_meshes{
    {[](Settings& s) { s.mesh.tile_size = 0; }, "tile_size", "1 to 1024 pixels"},
    {[](Settings& s) { s.integrator.kind = IntegratorKind::sampled; }, "integrator", "at least 1"},
    {[](Settings& s) { s.integrator = {.kind = IntegratorKind::preintegrated, .table_size = 7}; }, "integrator",
     "8 to 512"},
    {[](Settings& s) { s.integrator.kind = IntegratorKind::partial, s.emission = Emission::independent; }, "integrator",
     "supports only `emission` absorption"},
    {[](Settings& s) {
       s.mesh.rasterizer = Rasterizer::scanline, s.surfaces.iso = {{0.5, {}, 1}};
     },
     "iso", "use `rasterizer` planes"},
    {[](Settings& s) { s.mesh.rasterizer = Rasterizer::scanline, s.surfaces.boundary = {{}}; }, "surface",
     "use `rasterizer` planes"},
    {[](Settings& s) {
       s.surfaces.boundary = {{{}, 1.5}};
     },
     "surface", "opacity 1.5"},
    {[](Settings& s) { s.mesh.rasterizer = Rasterizer::scanline, shade(s, {}); }, "shade", "use `rasterizer` planes"},
    {[](Settings& s) { s.mesh.rasterizer = Rasterizer::device; }, "rasterizer", "is for `compositor` gl-compute"},
    {[](Settings& s) { s.mesh.rasterizer = Rasterizer::device, s.mesh.device.backends = {Backend::cpu}; }, "rasterizer",
     "is for `compositor` gl-compute"},
    {[](Settings& s) {
       s.mesh.rasterizer = Rasterizer::device, s.mesh.device.backends = {Backend::osmesa, Backend::cpu};
     },
     "rasterizer", "name a device for each"},
    {[](Settings& s) {
       s.mesh.rasterizer = Rasterizer::device;
       s.mesh.device = {.backends = {Backend::osmesa}, .method = GlMethod::fragment};
     },
     "rasterizer", "use gl-compute"},
};

const std::vector<Fault> faults_of_grids{
    {[](Settings& s) { s.integrator.kind = IntegratorKind::partial; }, "integrator", "is for meshes"},
    {[](Settings& s) { s.surfaces.boundary = {{}}; }, "surface", "is for meshes"},
    {[](Settings& s) { s.mesh.rasterizer = Rasterizer::scanline; }, "rasterizer", "is for meshes"},
    {[](Settings& s) { s.grid.brick_size = 1; }, "brick_size", "2 to 65536 voxels"},
    {[](Settings& s) { s.grid.step = 0; }, "step", "must be positive"},
    {[](Settings& s) { s.grid.preload_limit = -1; }, "preload", "0 or more"},
    {[](Settings& s) { s.integrator.kind = IntegratorKind::sampled, shade(s, {}); }, "shade", "exact or auto"},
    {[](Settings& s) {
       s.integrator.kind = IntegratorKind::sampled, s.surfaces.iso = {{0.5, {}, 1}};
     },
     "iso", "exact or auto"},
    {[](Settings& s) { s.integrator.kind = IntegratorKind::preintegrated, s.emission = Emission::independent; },
     "integrator", "sampled or exact"},
    {[](Settings& s) {
       s.integrator.kind = IntegratorKind::preintegrated, s.ranks.distribution = Distribution::sort_last;
     },
     "distribution", "would be missed"},
};

TEST(ValidSettings, FaultsNameTheSetting) {
  for (const DataKind data : {DataKind::mesh, DataKind::grid}) {
    expect_refused(faults_of_all, data);
    expect_refused(faults_of_shading, data);
  }
  expect_refused(faults_of_meshes, DataKind::mesh);
  expect_refused(faults_of_grids, DataKind::grid);
}

TEST(ValidSettings, RefusesInvalidTriangles) {
  const auto broken = std::make_shared<TriangleMesh>();
  broken->points = {{0, 0, 0}, {1, 0, 0}};
  broken->triangles = {{0, 1, 2}};
  expect_refused({{[&](Settings& s) {
                     s.surfaces.triangles = {{broken, {}, 1}};
                   },
                   "surface", "uses point 2, but there are only 2 points"}},
                 DataKind::mesh);
}

TEST(ValidSettings, ThoseOfAFrameAreFitForItsSession) {
  const FrameSettings deep{.deep = true}, layers{.peel = Peel{}};
  const auto words = [](const FrameSettings& frame, const Settings& settings, DataKind data) {
    return std::string(error_of([&] { validate(frame, settings, data); }).what());
  };
  for (const DataKind data : {DataKind::mesh, DataKind::grid}) {
    EXPECT_EQ(words(deep, {}, data), "no error");
    EXPECT_EQ(words({.deep_accuracy = 0}, {}, data), "no error") << "nothing deep is asked for";
    for (const double accuracy : {0.0, 9e-7, 1.1, double{NAN}})
      EXPECT_NE(words({.deep = true, .deep_accuracy = accuracy}, {}, data).find("`deep_accuracy`"), std::string::npos);
    EXPECT_NE(words({.peel = Peel{.threshold = 1}}, {}, data).find("below 1"), std::string::npos);
    EXPECT_NE(words({.peel = Peel{.layers = 65}}, {}, data).find("1 to 64"), std::string::npos);
    Settings steps;
    steps.integrator = {.kind = IntegratorKind::sampled, .samples = 4};
    EXPECT_EQ(words(layers, steps, data).find("`peel`: "), 0u);
    EXPECT_EQ(words(deep, steps, data).find("deep image: "), 0u);
  }
  Settings scanline;
  scanline.mesh.rasterizer = Rasterizer::scanline;
  EXPECT_NE(words(deep, scanline, DataKind::mesh).find("gaps and overlaps"), std::string::npos);
  Settings shaded;
  shaded.grid.shading.emplace();
  EXPECT_NE(words(deep, shaded, DataKind::grid).find("shading is not supported"), std::string::npos);
  EXPECT_EQ(words(layers, shaded, DataKind::grid), "no error");
}

TEST(ValidSettings, ASessionChecksThemWithItsData) {
  const Dataset mesh = Dataset::of(datasets::arrays_of(datasets::cube(2)));
  Settings settings;
  settings.threads = -1;
  EXPECT_EQ(error_of([&] { Session(mesh, settings); }).setting(), "threads");
  settings = {};
  settings.integrator.kind = IntegratorKind::sampled;
  const std::vector<float> samples(8, 0.5f);
  GridArrays arrays;
  arrays.geometry.points = {2, 2, 2};
  arrays.samples = ArrayView(samples);
  EXPECT_NO_THROW(Session(Dataset::of(arrays), settings));
  arrays.geometry.coordinates = {{{0, 1}, {0, 1}, {0, 3}}};
  EXPECT_EQ(error_of([&] { Session(Dataset::of(arrays), settings); }).setting(), "integrator");
  settings = {};
  settings.surfaces.iso = {{0.5, {}, 1}};
  EXPECT_NO_THROW(Session(Dataset::of(arrays), settings));
  arrays.geometry.association = Association::cell;
  const std::vector<float> of_cells(1, 0.5f);
  arrays.samples = ArrayView(of_cells);
  EXPECT_EQ(error_of([&] { Session(Dataset::of(arrays), settings); }).setting(), "iso");
}

}  // namespace
}  // namespace tessera::settings_test
