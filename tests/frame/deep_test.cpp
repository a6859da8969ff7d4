// SPDX-License-Identifier: BSD-3-Clause
#include <ImfChannelList.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineInputFile.h>
#include <ImfHeader.h>
#include <ImfPartType.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <glm/geometric.hpp>
#include <optional>

#include "datasets/boxes.hpp"
#include "datasets/modify.hpp"
#include "datasets/shapes.hpp"
#include "datasets/transfer_functions.hpp"
#include "frame/mesh/render.hpp"
#include "io/image/image_deep_exr.hpp"
#include "scene/error.hpp"
#include "support/deep_pixels.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"
#include "support/vtk_or_skip.hpp"

/// The promise of deep images: flattened they equal the image, and with an opaque plane inserted at any depth they are
/// within --deep-accuracy of a rendering with that plane.
namespace tessera::frame::deep_test {
namespace {

using scene::Camera;
using scene::DeepImage;
using scene::Image;
using scene::ImageSize;
using scene::TransferFunction;

/// Everything passes through a file, so that the data that OpenEXR reads back is judged.
DeepImage written_and_read(const DeepImage& image) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder / "a.deep.exr";
  io::write_deep_exr(image, file);
  Imf::DeepScanLineInputFile input(file.c_str(), 0);
  EXPECT_EQ(input.header().type(), Imf::DEEPSCANLINE);
  const int width = input.header().dataWindow().max.x + 1, height = input.header().dataWindow().max.y + 1;
  EXPECT_EQ((ImageSize{width, height}), image.size);
  DeepImage read;
  read.size = {width, height};
  const std::size_t pixels = static_cast<std::size_t>(width) * height;
  std::vector<unsigned int> counts(pixels);
  const char* names[] = {"Z", "ZBack", "R", "G", "B", "A"};
  std::vector<std::vector<char*>> pointers(6, std::vector<char*>(pixels));
  Imf::DeepFrameBuffer frame;
  frame.insertSampleCountSlice(Imf::Slice(Imf::UINT, reinterpret_cast<char*>(counts.data()), sizeof(unsigned int),
                                          sizeof(unsigned int) * static_cast<std::size_t>(width)));
  for (std::size_t c = 0; c < 6; ++c) {
    EXPECT_NE(input.header().channels().findChannel(names[c]), nullptr) << names[c];
    frame.insert(names[c],
                 Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(pointers[c].data()), sizeof(char*),
                                sizeof(char*) * static_cast<std::size_t>(width), sizeof(scene::DeepImageSample)));
  }
  input.setFrameBuffer(frame);
  input.readPixelSampleCounts(0, height - 1);
  read.begin.assign(1, 0);
  for (const unsigned int count : counts) read.begin.push_back(read.begin.back() + count);
  read.samples.resize(read.begin.back());
  for (std::size_t p = 0; p < pixels; ++p)
    for (std::size_t c = 0; c < 6; ++c)  // the struct's six floats are in the order of `names`
      pointers[c][p] = reinterpret_cast<char*>(read.samples.data() + read.begin[p]) + c * sizeof(float);
  input.readPixels(0, height - 1);
  return read;
}

double largest_difference(const DeepImage& deep, const Image& image, double z, const std::array<double, 3>& plane) {
  double most = 0;
  for (std::size_t p = 0; p < image.depth.size(); ++p) {
    const float* rgba = image.rgba.data() + 4 * p;
    const auto found = tests::composited(deep.pixel(p), z, plane);
    for (int c = 0; c < 4; ++c) {
      const double behind = std::isfinite(z) ? (1.0 - rgba[3]) * (c < 3 ? plane[c] : 1) : 0;
      most = std::max(most, std::abs(found[c] - (rgba[c] + behind)));
    }
  }
  return most;
}

void expect_tidy(const DeepImage& deep) {
  for (std::size_t p = 0; p + 1 < deep.begin.size(); ++p) {
    float last = -HUGE_VALF;
    for (const auto& s : deep.pixel(p)) {
      ASSERT_LE(s.z, s.z_back) << p;
      ASSERT_GE(s.z, last) << p;
      ASSERT_TRUE(s.alpha >= 0 && s.alpha <= 1 && s.red >= 0 && s.green >= 0 && s.blue >= 0);
      ASSERT_TRUE(std::isfinite(s.z_back) && std::isfinite(s.red + s.green + s.blue));
      last = s.z_back;
    }
  }
}

Settings exact(Emission emission = Emission::absorption) {
  Settings settings;
  settings.integrator.kind = IntegratorKind::exact;
  settings.emission = emission;
  return settings;
}

/// Flattens, and inserts white, black and coloured planes at `depths`.
void expect_promise(const scene::TetMesh& mesh, const Camera& camera, ImageSize size, const TransferFunction& function,
                    const Settings& settings, double accuracy, const std::vector<double>& depths) {
  DeepImage made;
  Renderer renderer(mesh, settings);
  renderer.set_frame({.deep_accuracy = accuracy});
  const Image image = renderer.render(camera, size, function, nullptr, &made);
  const DeepImage deep = written_and_read(made);
  expect_tidy(deep);
  EXPECT_GT(deep.samples.size(), 0u);
  double brightest = 1;  // with independent emission, light may exceed 1, and rounding grows with it
  for (const float v : image.rgba) brightest = std::max(brightest, static_cast<double>(v));
  EXPECT_LT(largest_difference(deep, image, HUGE_VAL, {}), 1e-5 * brightest);
  for (std::size_t p = 0; p < image.depth.size(); ++p)
    if (image.rgba[4 * p + 3] > 0 && settings.emission == Emission::absorption) {
      EXPECT_EQ(deep.pixel(p).empty() ? HUGE_VALF : deep.pixel(p).front().z, image.depth[p]) << p;
    }
  for (const double z : depths) {
    Camera before = camera;
    before.clipping_range = scene::ClippingRange{0, z};
    const Image clipped = renderer.render(before, size, function);
    for (const auto& plane : {std::array{1.0, 1.0, 1.0}, std::array{0.0, 0.0, 0.0}, std::array{0.2, 1.0, 0.6}})
      EXPECT_LT(largest_difference(deep, clipped, z, plane), accuracy + 1e-5 * brightest) << "z " << z;
  }
}

Camera oblique(scene::ProjectionKind kind = scene::ProjectionKind::orthographic) {
  Camera camera;
  camera.position = {3.1, 2.3, 4.2};
  camera.parallel_scale = 1.8;
  camera.projection = kind;
  camera.view_angle = 35;
  return camera;
}

const ImageSize small{48, 40};
const double middle = glm::length(glm::dvec3(3.1, 2.3, 4.2));  // distance of the mesh's centre from oblique()

TEST(Deep, KeepsItsPromiseForPointAndCellDataViewsAndThickness) {
  const scene::TetMesh points = datasets::cube(8, 0.2), cells = datasets::with_cell_data(points, 6);
  const TransferFunction functions[] = {datasets::smooth_knots(6), datasets::step_knots(7),
                                        datasets::benchmark_transfer_function()};
  std::size_t n = 0;
  for (const scene::TetMesh* mesh : {&points, &cells})
    for (const auto kind : {scene::ProjectionKind::orthographic, scene::ProjectionKind::perspective})
      for (const TransferFunction& function : functions) {
        const double thickness = std::array{0.05, 1.0, 300.0}[n % 3], accuracy = std::array{1e-3, 1e-2}[n % 2];
        SCOPED_TRACE(testing::Message() << n++ << ": thickness " << thickness << ", accuracy " << accuracy);
        for (const bool lattice : {true, false}) {
          SCOPED_TRACE(lattice);
          Settings settings = exact();
          settings.use.lattice = lattice;
          expect_promise(*mesh, oblique(kind), small, datasets::scaled(function, thickness), settings, accuracy,
                         {middle - 0.9, middle - 0.31, middle, middle + 0.4});
        }
      }
}

TEST(Deep, KeepsItsPromiseForLitMatter) {
  Settings settings = exact();
  for (const scene::Shading& shading : {scene::Shading{}, scene::Shading{1, 2, 3, 2}})
    for (const auto kind : {scene::ProjectionKind::orthographic, scene::ProjectionKind::perspective})
      for (const double thickness : {0.2, 20.0}) {
        SCOPED_TRACE(testing::Message() << shading.specular << ", " << thickness);
        settings.mesh.shading = shading;
        expect_promise(datasets::cube(7, 0.2), oblique(kind), small,
                       datasets::scaled(datasets::smooth_knots(6), thickness), settings, 1e-3,
                       {middle - 0.5, middle, middle + 0.5});
      }
}

TEST(Deep, NothingIsMissingBehindAnOpaqueRayOfACoarseImage) {
  Settings coarse;
  coarse.integrator.accuracy = 0.04;
  for (const bool lattice : {true, false}) {
    coarse.use.lattice = lattice;
    DeepImage deep;
    Renderer(datasets::cube(6), coarse)
        .render(oblique(), small, datasets::scaled(datasets::smooth_knots(6), 20), nullptr, &deep);
    double most = 0;  // of the light of a white object behind the ray that is seen
    const Image whole =
        Renderer(datasets::cube(6), exact()).render(oblique(), small, datasets::scaled(datasets::smooth_knots(6), 20));
    for (std::size_t p = 0; p < whole.depth.size(); ++p)
      most =
          std::max(most, std::abs(tests::composited(deep.pixel(p), HUGE_VAL, {})[3] - double{whole.rgba[4 * p + 3]}));
    EXPECT_LT(most, 1e-3);
  }
}

// A colour of zero that is computed from a slope must not become slightly negative.
TEST(Deep, SamplesOfAPureColorAreNotNegativeAndMerge) {
  for (const double value : {0.3, 0.37, 0.41, 0.477, 0.6}) {
    scene::TetMesh mesh = datasets::cube(5);
    for (double& scalar : mesh.scalars) scalar = value;
    mesh.scalars.front() = 0, mesh.scalars.back() = 1;
    const TransferFunction peak({{0, {0.9, 0.7, 0}, 0}, {value, {0, 0, 1}, 3}, {1, {0.3, 0.9, 0.2}, 0.1}});
    DeepImage deep;
    FrameStatistics statistics;
    Renderer(mesh, exact()).render(oblique(), small, peak, &statistics, &deep);
    EXPECT_TRUE(statistics.on_lattice);
    expect_tidy(deep);
    EXPECT_LT(deep.samples.size(), 4u * small.width * small.height) << value;
  }
}

TEST(Deep, IsMadeOnTheLatticeUnlessThatIsNotAccurateEnough) {
  const scene::TetMesh mesh = datasets::cube(4);
  const auto on_lattice = [&](const Settings& settings, double accuracy) {
    Renderer renderer(mesh, settings);
    renderer.set_frame({.deep_accuracy = accuracy});
    FrameStatistics statistics;
    DeepImage deep;
    renderer.render(oblique(), small, datasets::smooth_knots(6), &statistics, &deep);
    EXPECT_GT(deep.samples.size(), 0u);
    return statistics.on_lattice;
  };
  EXPECT_TRUE(on_lattice(exact(), 1e-3));
  EXPECT_TRUE(on_lattice({}, 1e-3));
  EXPECT_FALSE(on_lattice(exact(), 1e-4));
  EXPECT_FALSE(on_lattice(exact(Emission::independent), 1e-3));
  Settings accurate;
  accurate.integrator.accuracy = 1e-6;
  EXPECT_FALSE(on_lattice(accurate, 1e-3));
  Settings with_surface;
  with_surface.surfaces.iso = {{0.5, glm::dvec3(1), 0.5}};
  EXPECT_FALSE(on_lattice(with_surface, 1e-3));
}

TEST(Deep, KeepsItsPromiseForIndependentEmission) {
  const scene::TetMesh mesh = datasets::cube(6, 0.2);
  for (const double thickness : {0.0, 0.01, 1.0, 100.0})
    for (const auto kind : {scene::ProjectionKind::orthographic, scene::ProjectionKind::perspective}) {
      SCOPED_TRACE(testing::Message() << "thickness " << thickness);
      expect_promise(mesh, oblique(kind), small, datasets::scaled(datasets::smooth_knots(6), thickness),
                     exact(Emission::independent), 1e-3, {middle - 0.5, middle, middle + 0.5});
    }
}

TEST(Deep, OneTetWithASharpTransferFunctionIsCutAsFinelyAsItNeeds) {
  // All matter is within a hundredth of the range of the cell's scalars, and is optically thick.
  const TransferFunction sharp({{0.30, {1, 0, 0}, 0},
                                {0.31, {0, 1, 0}, 400},
                                {0.32, {0, 0, 1}, 0},
                                {0.6, {1, 1, 1}, 0.2},
                                {0.6, {1, 1, 0}, 30},
                                {0.9, {0, 1, 1}, 3}});
  Camera camera;
  camera.position = {0.31, 0.29, 5};
  camera.focal_point = {0.31, 0.29, 0};
  camera.parallel_scale = 0.6;
  for (const double accuracy : {1e-2, 1e-3, 1e-4})
    expect_promise(datasets::single_tet(), camera, small, sharp, exact(), accuracy,
                   {4.2, 4.5, 4.7, 4.733, 4.8, 4.9, 4.99});
}

TEST(Deep, OxygenPostCutInItsMiddle) {
  TESSERA_VTK_OR_SKIP();
  const std::filesystem::path file =
      std::filesystem::path(TESSERA_SOURCE_DIR) / "../shared/data/oxygen-post/postxyz.bin";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no " << file;
  const scene::TetMesh mesh = io::read_mesh(file).mesh;
  const ImageSize size{96, 96};
  const Camera camera = scene::frame_box(scene::bounds(mesh), size);
  const double centre = glm::length(camera.focal_point - camera.position);
  const TransferFunction function =
      datasets::smooth_knots(12, scene::scalar_range(mesh), 6 / scene::mean_thickness(mesh));
  for (const double accuracy : {1e-3, 1e-2})
    expect_promise(mesh, camera, size, function, exact(), accuracy, {centre - 4, centre, centre + 4});
}

TEST(Deep, GivesTheSameSamplesForAnyThreadsTilesAndMemory) {
  const scene::TetMesh mesh = datasets::cube(10, 0.2);
  const ImageSize size{71, 53};
  const TransferFunction function = datasets::smooth_knots(6);
  DeepImage expected;
  const Image image = Renderer(mesh, exact()).render(oblique(), size, function, nullptr, &expected);
  const Image alone = Renderer(mesh, exact()).render(oblique(), size, function);
  EXPECT_EQ(image.rgba, alone.rgba);
  EXPECT_EQ(image.depth, alone.depth);
  for (const int threads : {1, 3})
    for (const int tile : {5, 32, 128})
      for (const std::uint64_t memory : {64ull << 20, 16ull << 20}) {
        Settings settings = exact();
        settings.threads = threads;
        settings.mesh.tile_size = tile;
        settings.memory_bytes = memory;
        DeepImage deep;
        Renderer(mesh, settings).render(oblique(), size, function, nullptr, &deep);
        ASSERT_EQ(deep.begin, expected.begin) << threads << " threads, tile " << tile << ", memory " << memory;
        ASSERT_EQ(std::memcmp(deep.samples.data(), expected.samples.data(),
                              deep.samples.size() * sizeof(scene::DeepImageSample)),
                  0);
      }
}

TEST(Deep, AnEmptyPictureHasNoSamples) {
  DeepImage deep;
  Renderer(scene::TetMesh{}, exact()).render(oblique(), {9, 7}, datasets::smooth_knots(3), nullptr, &deep);
  const DeepImage read = written_and_read(deep);
  EXPECT_EQ(read.begin, std::vector<std::uint64_t>(64, 0));
}

TEST(Deep, ReportsThatItsSamplesExceedTheBudget) {
  Settings settings = exact();
  settings.memory_bytes = 16 << 20;
  const scene::TetMesh mesh = datasets::cube(12, 0.2);
  Renderer renderer(mesh, settings);
  renderer.set_frame({.deep_accuracy = 1e-6});
  DeepImage deep;
  try {
    renderer.render(oblique(), {400, 400}, datasets::smooth_knots(12), nullptr, &deep);
    ADD_FAILURE() << "the samples fit";
  } catch (const scene::Error& error) {
    EXPECT_EQ(error.code(), scene::ErrorCode::system_failure) << error.what();
  }
}

}  // namespace
}  // namespace tessera::frame::deep_test
