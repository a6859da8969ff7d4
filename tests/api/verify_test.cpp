// SPDX-License-Identifier: BSD-3-Clause
#include "api/queries/verify.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <random>

#include "exchange/loopback_transport.hpp"
#include "frame/mesh/render.hpp"
#include "frame/render_sort_first.hpp"
#include "reference/reference.hpp"
#include "reference/small_meshes.hpp"

namespace tessera::frame::verify_test {
namespace {

using reference::ChosenPixel;
using reference::PixelIndex;
using reference::Suspicion;
using scene::ProjectionKind;

constexpr scene::ImageSize size{256, 256};
constexpr std::size_t looked_at = 1000;
constexpr float wrong = 1e-3f;  // ten times the default's promise

/// An image and the pixels that --verify checks. If all pixels were chosen at random, a given pixel would be among the
/// thousand with a probability of 1.5 %.
struct Scene {
  scene::Image image;
  std::function<reference::Suspects(const scene::Image&)> suspects;

  [[nodiscard]] std::vector<ChosenPixel> chosen(const scene::Image& of) const {
    return reference::choose_pixels(of.size, looked_at, suspects(of));
  }
};

/// Why a pixel is checked; "" if it is not.
std::string reason(const std::vector<ChosenPixel>& chosen, PixelIndex p) {
  for (const ChosenPixel& c : chosen)
    if (c.at == p) return c.why ? name_of(*c.why) : "random";
  return "";
}

void add(scene::Image& image, PixelIndex p, float error) {
  for (std::size_t c = 0; c < 4; ++c) image.rgba[4 * image.index(p.x, p.y) + c] += error;
}

float alpha(const scene::Image& image, int x, int y) { return image.rgba[4 * image.index(x, y) + 3]; }

Scene of_mesh(scene::TetMesh mesh, const scene::Camera& camera, const scene::TransferFunction& function) {
  const auto kept = std::make_shared<const scene::TetMesh>(std::move(mesh));
  Settings settings;
  settings.threads = 2;
  Scene scene;
  scene.image = Renderer(*kept, settings).render(camera, size, function);
  scene.suspects = [=](const scene::Image& image) {
    return api::suspects(image, *kept, camera, function, settings, looked_at);
  };
  return scene;
}

scene::Camera oblique(double scale) {
  return reference::looking({2, 1.5, 4}, {0, 0, 0}, ProjectionKind::orthographic, scale);
}

double waves(const glm::dvec3& p) { return 0.5 + 0.4 * std::sin(3 * p.x + p.y) * std::cos(2 * p.z); }

scene::TransferFunction haze() { return scene::TransferFunction({{0, {0.2, 0.4, 1}, 0}, {1, {1, 0.5, 0.2}, 2}}); }

std::unique_ptr<scene::MemorySource> grid(std::int64_t n, const std::function<double(const glm::dvec3&)>& field) {
  scene::Grid grid;
  grid.geometry.points = {n, n, n};
  grid.geometry.origin = glm::dvec3(-1);
  grid.geometry.spacing = glm::dvec3(2.0 / static_cast<double>(n - 1));
  std::vector<float> values;
  for (std::int64_t k = 0; k < n; ++k)
    for (std::int64_t j = 0; j < n; ++j)
      for (std::int64_t i = 0; i < n; ++i)
        values.push_back(static_cast<float>(
            field(2.0 * glm::dvec3(double(i), double(j), double(k)) / static_cast<double>(n - 1) - 1.0)));
  return scene::MemorySource::of(grid, std::move(values));
}

Scene of_grid(std::unique_ptr<scene::MemorySource> source, const scene::Camera& camera,
              const scene::TransferFunction& function) {
  const std::shared_ptr<const scene::MemorySource> kept = std::move(source);
  volume::RenderSettings settings;
  settings.threads = 2;
  Scene scene;
  volume::Frame frame = volume::Renderer(*kept, settings).render(camera, size, function, {.error_bounds = true});
  scene.image = std::move(frame.image);
  scene.suspects = [=, error_bounds = std::move(frame.error_bounds)](const scene::Image& image) {
    return api::suspects(image, *kept, camera, function, settings, error_bounds, looked_at);
  };
  return scene;
}

/// Makes each of some pixels wrong separately; returns how many of them are checked for a reason other than chance.
int found(const Scene& scene, const std::vector<PixelIndex>& pixels, float error) {
  int count = 0;
  for (const PixelIndex& p : pixels) {
    scene::Image image = scene.image;
    add(image, p, error);
    const std::string why = reason(scene.chosen(image), p);
    count += !why.empty() && why != "random" ? 1 : 0;
  }
  return count;
}

/// Some random pixels among those for which `which` is true.
template <class Which>
std::vector<PixelIndex> some_pixels(std::size_t count, const Which& which) {
  std::vector<PixelIndex> all;
  for (const PixelIndex& p : reference::all_pixels(size))
    if (p.x >= 4 && p.y >= 4 && p.x < size.width - 4 && p.y < size.height - 4 && which(p.x, p.y)) all.push_back(p);
  std::shuffle(all.begin(), all.end(), std::mt19937(7));
  all.resize(std::min(all.size(), count));
  return all;
}

TEST(VerifyLooksAt, ASingleWrongPixelInSmoothMatter) {
  const Scene scene =
      of_mesh(reference::box_of_tets(6, glm::dvec3(-1), glm::dvec3(1), waves, 0.15), oblique(1.8), haze());
  const auto inside = some_pixels(20, [&](int x, int y) { return alpha(scene.image, x, y) > 0.2; });
  ASSERT_EQ(inside.size(), 20u);
  EXPECT_EQ(found(scene, inside, wrong), 20);
}

TEST(VerifyLooksAt, ALostBlockAtANaNBorder) {
  const auto ball = [](const glm::dvec3& p) {
    const double r = std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
    return r < 0.9 ? r : std::numeric_limits<double>::quiet_NaN();
  };
  const Scene scene =
      of_grid(grid(48, ball), oblique(1.2), scene::TransferFunction({{0, {1, 0.5, 0.2}, 0.5}, {1, {0, 0.5, 1}, 2}}));
  const auto inside =
      some_pixels(20, [&](int x, int y) { return x % 4 == 0 && y % 4 == 0 && alpha(scene.image, x, y) > 0.3; });
  ASSERT_EQ(inside.size(), 20u);
  for (const PixelIndex& p : inside) {
    scene::Image image = scene.image;
    for (int n = 0; n < 16; ++n)
      for (std::size_t c = 0; c < 4; ++c) image.rgba[4 * image.index(p.x + n % 4, p.y + n / 4) + c] = 0;
    const auto chosen = scene.chosen(image);
    EXPECT_TRUE(
        std::any_of(chosen.begin(), chosen.end(),
                    [&](const ChosenPixel& c) { return c.why && c.at.x / 4 == p.x / 4 && c.at.y / 4 == p.y / 4; }))
        << "block at (" << p.x << ", " << p.y << ")";
  }
}

TEST(VerifyLooksAt, ASmallNaNBorder) {
  // One blank sample in a smooth, thin medium: a gap of eight voxels, which covers about 60 pixels.
  const auto field = [](const glm::dvec3& p) {
    const double away = std::max({std::abs(p.x - 0.2), std::abs(p.y + 0.3), std::abs(p.z - 0.1)});
    return away < 1.0 / 47 ? std::numeric_limits<double>::quiet_NaN() : 0.5 + 0.1 * p.x;
  };
  const Scene scene = of_grid(grid(48, field), oblique(1.8), haze());
  const reference::View view(oblique(1.8), size);
  const glm::dvec3 gap = view.project({0.2, -0.3, 0.1}).homogeneous;
  int border = 0, near = 0;
  for (const ChosenPixel& c : scene.chosen(scene.image)) {
    if (c.why == Suspicion::border) {
      ++border;
      EXPECT_LT(std::hypot(c.at.x + 0.5 - gap.x, c.at.y + 0.5 - gap.y), 8);
    }
    near += std::hypot(c.at.x + 0.5 - gap.x, c.at.y + 0.5 - gap.y) < 4 ? 1 : 0;
  }
  EXPECT_GE(border, 5);  // pixels that are suspicious for two reasons count for the first
  EXPECT_GE(near, 10);   // one at random
}

TEST(VerifyLooksAt, WrongPixelsOnTheSurfaceOfAStep) {
  // Two plateaus in a small ball, whose values differ by one unit in the last place: on the transfer function's step
  // and just below it. All other values are far from the step.
  const float step = 0.7f;
  const auto saturated = [&](const glm::dvec3& p) {
    const double r = glm::length(p - glm::dvec3(0.3, 0.2, 0));
    return r < 0.2 ? step : r < 0.3 ? std::nextafter(step, 0.0f) : std::min(0.69, 0.2 / r);
  };
  const scene::TransferFunction function(
      {{0, {0, 0, 1}, 0.1}, {step, {0, 0, 1}, 0.1}, {step, {1, 0.5, 0}, 2}, {1, {1, 0.5, 0}, 2}});
  const Scene mesh =
      of_mesh(reference::box_of_tets(16, glm::dvec3(-1), glm::dvec3(1), saturated), oblique(1.8), function);
  const Scene volume = of_grid(grid(32, saturated), oblique(1.8), function);
  for (const Scene* scene : {&mesh, &volume}) {
    int step_pixels = 0, on_it = 0;
    const reference::View view(oblique(1.8), size);
    const glm::dvec3 centre = view.project({0.3, 0.2, 0}).homogeneous;
    for (const ChosenPixel& c : scene->chosen(scene->image)) {
      if (c.why != Suspicion::step) continue;
      ++step_pixels;
      on_it += std::hypot(c.at.x + 0.5 - centre.x, c.at.y + 0.5 - centre.y) < 0.45 * size.height / 3.6 ? 1 : 0;
    }
    // The ball covers 1,400 of 65,536 pixels.
    EXPECT_GE(step_pixels, 60);
    EXPECT_GE(on_it, step_pixels * 9 / 10);
  }
}

TEST(VerifyLooksAt, TiedPixels) {
  // A box with its left side in the plane of the eye and of a column of pixel centres: only the tie rule decides which
  // side is visible.
  scene::Camera camera = reference::looking({0, 0, 3}, {0, 0, 0}, ProjectionKind::perspective, 40);
  const scene::ImageSize odd{257, 257};
  const scene::TetMesh mesh = reference::box_of_tets(2, {0, -0.4, -0.4}, {0.8, 0.4, 0.4}, waves);
  const scene::TransferFunction function({{0, {1, 1, 1}, 3}});
  Settings settings;
  const scene::Image image = Renderer(mesh, settings).render(camera, odd, function);
  const auto chosen =
      reference::choose_pixels(odd, looked_at, api::suspects(image, mesh, camera, function, settings, looked_at));
  int tied = 0, column = 0;
  for (const ChosenPixel& c : chosen) tied += c.at.x == 128 && c.why ? 1 : 0;
  for (int y = 0; y < odd.height; ++y) column += alpha(image, 127, y) > 0 || alpha(image, 129, y) > 0 ? 1 : 0;
  EXPECT_GT(column, 60);
  EXPECT_GE(tied, column * 9 / 10);
}

TEST(VerifyLooksAt, PixelsOnTheWrongSideOfASilhouette) {
  const Scene scene = of_mesh(reference::box_of_tets(3, glm::dvec3(-0.5), glm::dvec3(0.5), waves), oblique(1.8),
                              scene::TransferFunction({{0, {0.2, 0.4, 1}, 3}, {1, {1, 0.5, 0.2}, 5}}));
  const auto rim = some_pixels(20, [&](int x, int y) {
    return alpha(scene.image, x, y) > 0.01 && (alpha(scene.image, x - 1, y) == 0 || alpha(scene.image, x + 1, y) == 0);
  });
  ASSERT_EQ(rim.size(), 20u);
  int found = 0;
  for (const PixelIndex& p : rim) {
    scene::Image image = scene.image;
    for (std::size_t c = 0; c < 4; ++c) image.rgba[4 * image.index(p.x, p.y) + c] = 0;
    const std::string why = reason(scene.chosen(image), p);
    found += !why.empty() && why != "random" ? 1 : 0;
  }
  EXPECT_GE(found, 15);  // of 20; 5 if nothing distinguished them from about 500 similar pixels, 0 at random
}

TEST(VerifyLooksAt, EachPlateauOfColour) {
  // Cell data of 64 colours on a box seen along its axis: 64 squares of one colour each.
  const auto mesh = reference::with_cell_data(
      reference::box_of_tets(8, {-1, -1, -0.1}, {1, 1, 0.1}, waves),
      [](const glm::dvec3& p) { return std::floor((p.x + 1) * 4) + 8 * std::floor((p.y + 1) * 4); });
  std::vector<scene::Knot> knots;
  for (int i = 0; i < 64; ++i) knots.push_back({double(i), {(i % 8) / 7.0, (i / 8) / 7.0, 0.5}, 1.0});
  const auto camera = reference::looking({0.003, 0.007, 3}, {0.003, 0.007, 0}, ProjectionKind::orthographic, 1.2);
  const Scene scene = of_mesh(mesh, camera, scene::TransferFunction(knots));
  int plateaus = 0;
  for (const ChosenPixel& c : scene.chosen(scene.image)) plateaus += c.why == Suspicion::plateau ? 1 : 0;
  EXPECT_GE(plateaus, 65);  // also the empty background
}

TEST(Verify, ACorruptedPictureFailsAndTheReasonIsNamed) {
  const scene::TetMesh mesh = reference::box_of_tets(4, glm::dvec3(-1), glm::dvec3(1), waves, 0.15);
  const scene::Camera camera = oblique(1.8);
  const scene::ImageSize small{96, 96};
  Settings settings;
  scene::Image image = Renderer(mesh, settings).render(camera, small, haze());
  const auto good = api::verify(image, mesh, camera, haze(), settings, 300);
  EXPECT_TRUE(good.met());
  EXPECT_EQ(good.judgement.pixels_checked, 300u);
  EXPECT_GE(good.random.pixels, 100u);
  add(image, {50, 40}, wrong);
  const auto bad = api::verify(image, mesh, camera, haze(), settings, 300);
  EXPECT_FALSE(bad.met());
  EXPECT_EQ(bad.judgement.worst_x, 50);
  EXPECT_EQ(bad.judgement.worst_y, 40);
  EXPECT_EQ(bad.worst, Suspicion::outlier);
  EXPECT_EQ(bad.chosen[static_cast<std::size_t>(Suspicion::outlier)].over_bound, 1u);
  EXPECT_EQ(bad.random.over_bound, 0u);
}

TEST(Verify, ChecksTheSamePixelsOnAnyNumberOfRanksAndThreads) {
  const auto field = [](const glm::dvec3& p) { return std::exp(-4 * (p.x * p.x + p.y * p.y + p.z * p.z)); };
  const auto source = grid(24, field);
  const scene::TransferFunction function(
      {{0, {0, 0, 1}, 0}, {0.4999, {0, 1, 1}, 0}, {0.5, {1, 1, 0}, 500}, {0.5001, {0, 1, 1}, 0}, {1, {1, 1, 1}, 1}});
  const std::vector<VolumeJob> jobs{{oblique(1.6), {101, 67}}};
  std::vector<std::vector<ChosenPixel>> choices;
  std::vector<std::vector<float>> error_bounds;
  for (const int ranks : {1, 3})
    for (const int threads : {1, 3})
      exchange::run_ranks(ranks, [&](exchange::Transport& transport) {
        volume::RenderSettings settings;
        settings.threads = threads;
        volume::Renderer renderer(*source, settings);
        const auto choose = [&](const FinishedVolumeFrame& frame) {
          choices.push_back(reference::choose_pixels(
              {101, 67}, 500,
              api::suspects(frame.image, *source, jobs[0].camera, function, settings, frame.error_bounds, 500)));
          error_bounds.push_back(frame.error_bounds);
        };
        render_sort_first(transport, settings, jobs, function, renderer, choose, {.keep_uncertainty = true});
      });
  ASSERT_EQ(choices.size(), 4u);
  EXPECT_GT(*std::max_element(error_bounds[0].begin(), error_bounds[0].end()), 0.0f);
  for (std::size_t i = 1; i < choices.size(); ++i) {
    EXPECT_EQ(error_bounds[i], error_bounds[0]);
    ASSERT_EQ(choices[i].size(), choices[0].size());
    for (std::size_t n = 0; n < choices[0].size(); ++n) {
      EXPECT_EQ(choices[i][n].at, choices[0][n].at);
      EXPECT_EQ(choices[i][n].why, choices[0][n].why);
    }
  }
}

}  // namespace
}  // namespace tessera::frame::verify_test
