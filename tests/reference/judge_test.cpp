// SPDX-License-Identifier: BSD-3-Clause
#include "reference/judge.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "reference/reference.hpp"
#include "reference/small_meshes.hpp"
#include "scene/error.hpp"

namespace tessera::reference::judge_test {
namespace {

using scene::ProjectionKind;
using scene::TransferFunction;

/// Two materials of cell data, which meet at x = 0, seen along z. Column `column` of the window is centred on x = 0.
struct TwoMaterials {
  scene::TetMesh mesh;
  scene::ImageSize size;
  Reference reference;

  TwoMaterials(int width, int height, double offset)
      : mesh(with_cell_data(box_of_tets(2, {-1, -1, -1}, {1, 1, 1}, side), side)),
        size{width, height},
        reference(mesh, looking({offset, 0.013, 4}, {offset, 0.013, 0}, ProjectionKind::orthographic, 0.7), size,
                  TransferFunction({{-1, {1, 0, 0}, 0.3}, {0, {1, 0, 0}, 0.3}, {0, {0, 1, 0}, 2}, {1, {0, 1, 0}, 2}})) {
  }

  static double side(const glm::dvec3& p) { return p.x < 0 ? -1.0 : 1.0; }

  [[nodiscard]] scene::Image image() const {
    scene::Image image(size);
    const std::vector<Pixel> truth = reference.image();
    for (std::size_t i = 0; i < truth.size(); ++i) set(image, i, truth[i]);
    return image;
  }

  static void set(scene::Image& image, std::size_t i, const Pixel& p) {
    const double rgba[4] = {p.r, p.g, p.b, p.a};
    for (std::size_t c = 0; c < 4; ++c) image.rgba[4 * i + c] = static_cast<float>(rgba[c]);
  }
};

TEST(Judge, AnImageRoundedToFloatPasses) {
  const TwoMaterials scene(20, 10, 0.03);
  const Judgement judgement = judge(scene.image(), scene.reference, 1e-7);
  EXPECT_TRUE(judgement.passed);
  EXPECT_EQ(judgement.pixels_checked, 200u);
  EXPECT_EQ(judgement.over_bound, 0u);
  EXPECT_GT(judgement.max_error, 0);
  EXPECT_LE(judgement.max_error, 3e-8);  // half a unit in float's last place below one
  EXPECT_LE(judgement.rms_error, judgement.max_error);
}

TEST(Judge, OneWrongChannelOfOnePixelFailsAndIsNamed) {
  const TwoMaterials scene(20, 10, 0.03);
  scene::Image image = scene.image();
  image.rgba[4 * image.index(3, 7) + 2] += 1e-3f;
  const Judgement judgement = judge(image, scene.reference, 1e-5);
  EXPECT_FALSE(judgement.passed);
  EXPECT_EQ(judgement.over_bound, 1u);
  EXPECT_EQ(judgement.excused, 0u);
  EXPECT_EQ(judgement.worst_x, 3);
  EXPECT_EQ(judgement.worst_y, 7);
  EXPECT_NEAR(judgement.max_error, 1e-3, 1e-8);
  EXPECT_NEAR(judgement.max_error_not_excused, 1e-3, 1e-8);
  EXPECT_NEAR(judgement.rms_error, 1e-3 / std::sqrt(800.0), 1e-7);
  EXPECT_NEAR(judgement.worst_value[2] - judgement.worst_reference[2], 1e-3, 1e-8);
}

TEST(Judge, NotANumberAndInfinityAreInfinitelyWrong) {
  const TwoMaterials scene(20, 10, 0.03);
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    scene::Image image = scene.image();
    image.rgba[4 * image.index(5, 5)] = bad;
    const Judgement judgement = judge(image, scene.reference, 1e6);
    EXPECT_FALSE(judgement.passed);
    EXPECT_TRUE(std::isinf(judgement.max_error));
    EXPECT_EQ(judgement.excused, 0u);
  }
}

TEST(Judge, ExcusesTheOtherSideOfAFaceOnlyNearbyAndRarely) {
  // The pixel column in the window's middle is centred on the face between the materials, with an offset of `away`
  // pixels.
  const auto judged = [](double away, int width, int height, int wrong_pixels) {
    const double pixel = 1.4 / height;
    const TwoMaterials scene(width, height, away * pixel);
    scene::Image image = scene.image();
    const int column = width / 2;
    const Pixel other = scene.reference.pixel(column + 0.5 - 2 * away, height / 2 + 0.5);  // the first material
    for (int i = 0; i < wrong_pixels; ++i) TwoMaterials::set(image, image.index(column, 10 + 7 * i), other);
    return judge(image, scene.reference, 1e-5);
  };
  const Judgement near_face = judged(1.0 / 3000, 101, 101, 1);
  EXPECT_TRUE(near_face.passed);
  EXPECT_EQ(near_face.over_bound, 1u);
  EXPECT_EQ(near_face.excused, 1u);
  EXPECT_GT(near_face.max_error, 0.1);
  EXPECT_LT(near_face.max_error_not_excused, 1e-7);

  const Judgement too_far = judged(1.0 / 500, 101, 101, 1);
  EXPECT_FALSE(too_far.passed);
  EXPECT_EQ(too_far.excused, 0u);

  const Judgement too_many = judged(1.0 / 3000, 101, 101, 2);  // 1e-4 of 10,201 pixels is one
  EXPECT_FALSE(too_many.passed);
  EXPECT_EQ(too_many.excused, 2u);

  const Judgement too_small = judged(1.0 / 3000, 99, 99, 1);
  EXPECT_FALSE(too_small.passed);
  EXPECT_EQ(too_small.excused, 1u);
}

TEST(Judge, ChecksOnlyTheGivenPixels) {
  const TwoMaterials scene(20, 10, 0.03);
  scene::Image image = scene.image();
  image.rgba[4 * image.index(3, 7)] += 0.5f;
  const std::vector<PixelIndex> good{{2, 7}, {4, 7}}, bad{{2, 7}, {3, 7}};
  EXPECT_TRUE(judge(image, scene.reference, 1e-6, good).passed);
  EXPECT_FALSE(judge(image, scene.reference, 1e-6, bad).passed);
  EXPECT_EQ(judge(image, scene.reference, 1e-6, bad).pixels_checked, 2u);
}

TEST(Judge, RefusesAnImageOfAnotherSizeAndPixelsOutside) {
  const TwoMaterials scene(20, 10, 0.03);
  EXPECT_THROW(judge(scene::Image({10, 20}), scene.reference, 1e-5), scene::Error);
  const std::vector<PixelIndex> outside{{20, 0}};
  EXPECT_THROW(judge(scene::Image({20, 10}), scene.reference, 1e-5, outside), scene::Error);
}

TEST(RandomPixels, AreDifferentInsideAndRepeatable) {
  const scene::ImageSize size{50, 30};
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{700}, std::size_t{1499}}) {
    const std::vector<PixelIndex> pixels = random_pixels(size, count, 5);
    std::set<std::pair<int, int>> different;
    for (const PixelIndex& p : pixels) {
      EXPECT_TRUE(p.x >= 0 && p.x < 50 && p.y >= 0 && p.y < 30);
      different.insert({p.x, p.y});
    }
    EXPECT_EQ(different.size(), count);
    EXPECT_EQ(pixels, random_pixels(size, count, 5));
  }
  EXPECT_EQ(random_pixels(size, 5000, 1), all_pixels(size));
  EXPECT_NE(random_pixels(size, 100, 1), random_pixels(size, 100, 2));
}

TEST(RandomPixels, CoverTheImageEvenly) {
  // Each sample has 3 of the 12 pixels, so each pixel is in a quarter of the samples.
  std::array<int, 12> count{};
  const int samples = 4000;
  for (int seed = 0; seed < samples; ++seed)
    for (const PixelIndex& p : random_pixels({4, 3}, 3, static_cast<std::uint64_t>(seed)))
      ++count[static_cast<std::size_t>(p.y * 4 + p.x)];
  for (const int n : count) EXPECT_NEAR(n, samples / 4, 5 * std::sqrt(samples * 0.25 * 0.75));
}

}  // namespace
}  // namespace tessera::reference::judge_test
