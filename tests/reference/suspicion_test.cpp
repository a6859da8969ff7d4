// SPDX-License-Identifier: BSD-3-Clause
#include "reference/suspicion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "reference/image_suspicion.hpp"
#include "reference/light_error.hpp"
#include "reference/mesh/edge_walk.hpp"
#include "reference/verification.hpp"

namespace tessera::reference::suspicion_test {
namespace {

constexpr scene::ImageSize size{64, 48};
constexpr std::size_t pixels = 64 * 48;

SuspicionMap nothing_suspicious() { return SuspicionMap(pixels, 0.0f); }

std::size_t at(int x, int y) { return static_cast<std::size_t>(y) * 64 + static_cast<std::size_t>(x); }

std::set<std::pair<int, int>> places(const std::vector<ChosenPixel>& chosen) {
  std::set<std::pair<int, int>> all;
  for (const ChosenPixel& c : chosen) all.insert({c.at.x, c.at.y});
  return all;
}

std::size_t count(const std::vector<ChosenPixel>& chosen, std::optional<Suspicion> why) {
  return static_cast<std::size_t>(
      std::count_if(chosen.begin(), chosen.end(), [&](const ChosenPixel& c) { return c.why == why; }));
}

TEST(ChoosePixels, TakesAThirdAtRandomAndTheRestFromTheSuspectsByTurns) {
  Suspects suspects;
  for (int i = 0; i < 40; ++i) suspects[static_cast<std::size_t>(Suspicion::edge)].push_back({i, 3});
  for (int i = 0; i < 400; ++i) suspects[static_cast<std::size_t>(Suspicion::tie)].push_back({i % 64, 10 + i / 64});
  const std::vector<ChosenPixel> chosen = choose_pixels(size, 300, suspects);
  EXPECT_EQ(chosen.size(), 300u);
  EXPECT_EQ(places(chosen).size(), 300u);  // all different
  EXPECT_EQ(count(chosen, std::nullopt), 100u);
  EXPECT_GE(count(chosen, Suspicion::edge), 30u);  // pixels already chosen at random are not counted again
  EXPECT_EQ(count(chosen, Suspicion::edge) + count(chosen, Suspicion::tie), 200u);
  const std::vector<ChosenPixel> again = choose_pixels(size, 300, suspects);
  for (std::size_t i = 0; i < chosen.size(); ++i) EXPECT_EQ(chosen[i].at, again[i].at);
}

TEST(ChoosePixels, TakesMoreRandomPixelsForFewSuspectsAndAllOfASmallImage) {
  Suspects suspects;
  suspects[static_cast<std::size_t>(Suspicion::step)] = {{5, 5}, {5, 5}, {6, 5}};
  const std::vector<ChosenPixel> chosen = choose_pixels(size, 300, suspects);
  EXPECT_EQ(places(chosen).size(), 300u);
  EXPECT_LE(count(chosen, Suspicion::step), 2u);
  EXPECT_GE(count(chosen, std::nullopt), 298u);
  int lower_half = 0;
  for (const ChosenPixel& c : chosen) lower_half += c.at.y >= 24 ? 1 : 0;
  EXPECT_NEAR(lower_half, 150, 5 * std::sqrt(75.0));
  EXPECT_EQ(choose_pixels(size, pixels, suspects).size(), pixels);
  EXPECT_EQ(count(choose_pixels(size, 10 * pixels, suspects), std::nullopt), pixels);
  EXPECT_TRUE(choose_pixels(size, 0, suspects).empty());
}

TEST(Ranked, StartsWithTheMostSuspiciousPixelsSpreadOverTheImage) {
  SuspicionMap map = nothing_suspicious();
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) map[at(x, y)] = 1 + 0.001f * static_cast<float>(x);  // a large suspicious corner
  map[at(40, 40)] = 0.5f;
  for (int x = 20; x < 60; ++x) map[at(x, 30)] = 1e-4f;
  const std::vector<PixelIndex> order = ranked(map, size, 60);
  EXPECT_EQ(order.size(), 60u);
  const auto place = [&](PixelIndex p) { return std::find(order.begin(), order.end(), p) - order.begin(); };
  EXPECT_LT(place({40, 40}), 12);  // its 8x8 block is the fifth; every third turn takes another block
  EXPECT_EQ(std::count_if(order.begin(), order.begin() + 8, [](PixelIndex p) { return p.y == 30; }) <= 4, true);
  EXPECT_GE(std::count_if(order.begin(), order.end(), [](PixelIndex p) { return p.y == 30; }), 1);
  EXPECT_EQ(ranked(map, size, 10000).size(), 16u * 16 + 1 + 40);
  EXPECT_TRUE(ranked(nothing_suspicious(), size, 10).empty());
}

/// Smooth, with one straight edge.
scene::Image smooth_picture() {
  scene::Image image(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      for (std::size_t c = 0; c < 4; ++c)
        image.rgba[4 * at(x, y) + c] =
            static_cast<float>(0.4 + 0.1 * std::sin(0.05 * x + 0.03 * y + double(c)) + (x > 2 * y ? 0.3 : 0));
  return image;
}

TEST(ImageSuspicion, AnIsolatedPixelStandsOut) {
  scene::Image image = smooth_picture();
  for (const PixelIndex p : {PixelIndex{20, 40}, PixelIndex{50, 5}, PixelIndex{10, 30}}) {
    scene::Image wrong = image;
    wrong.rgba[4 * at(p.x, p.y) + 1] += 1e-3f;
    const ImageSuspicion found = suspect(wrong, 1e-4);
    const std::vector<PixelIndex> order = ranked(found.outlier, size, 16);
    EXPECT_NE(std::find(order.begin(), order.end(), p), order.end()) << p.x << " " << p.y;
  }
  const ImageSuspicion none = suspect(image, 1e-4);
  EXPECT_GT(none.edge[at(40, 20)], 0.25f);
  EXPECT_EQ(none.outlier[at(20, 40)], 0.0f);
}

TEST(ImageSuspicion, ALostBlockStandsOut) {
  scene::Image image = smooth_picture();
  for (int y = 32; y < 36; ++y)
    for (int x = 16; x < 20; ++x)
      for (std::size_t c = 0; c < 4; ++c) image.rgba[4 * at(x, y) + c] -= 0.01f;
  const ImageSuspicion found = suspect(image, 1e-4);
  float in_block = 0;
  for (int n = 0; n < 16; ++n) in_block = std::max(in_block, found.block[at(16 + n % 4, 32 + n / 4)]);
  EXPECT_NEAR(in_block, 0.01f, 1e-3f);
}

TEST(ImageSuspicion, APixelThatIsNotFiniteIsTheMostSuspicious) {
  scene::Image image = smooth_picture();
  image.rgba[4 * at(9, 9)] = std::numeric_limits<float>::quiet_NaN();
  const ImageSuspicion found = suspect(image, 1e-4);
  EXPECT_EQ(ranked(found.edge, size, 1).front(), (PixelIndex{9, 9}));
}

TEST(ImageSuspicion, EachColourOfAPlateauHasOnePixel) {
  scene::Image image(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) image.rgba[4 * at(x, y)] = static_cast<float>(x / 16 + 4 * (y / 16));
  const ImageSuspicion found = suspect(image, 1e-4);
  std::set<float> colours;
  for (std::size_t i = 0; i < pixels; ++i)
    if (found.plateau[i] > 0) {
      EXPECT_TRUE(colours.insert(image.rgba[4 * i]).second);
    }
  EXPECT_EQ(colours.size(), 12u);
}

TEST(LightError, IsTheJumpWhereAStepIsTouchedAndLessTheSteeperTheFieldCrossesIt) {
  const double noise = 1e-6;
  const LightError light(
      scene::TransferFunction({{0, {1, 1, 1}, 1}, {0.5, {1, 1, 1}, 1}, {0.5, {1, 1, 1}, 3}, {1, {1, 1, 1}, 3}}),
      scene::Emission::absorption, noise);
  const auto error = [&](std::array<double, 4> corners) { return light.per_length(corners); };
  EXPECT_EQ(error({0.1, 0.2, 0.3, 0.4}), 0);
  EXPECT_NEAR(error({0.5, 0.5, 0.5, 0.5}), 2, 1e-9);
  EXPECT_NEAR(error({0.5, 0.3, 0.2, 0.1}), 0.5, 1e-9);  // a quarter of the corners is on the step
  EXPECT_NEAR(error({0.4, 0.6, 0.4, 0.6}), 2 * noise / 0.2, 1e-7);
  EXPECT_EQ(light.most_per_length(0.1, 0.4), 0);
  EXPECT_EQ(light.most_per_length(0.1, 0.6), 2);
  EXPECT_EQ(light.densest(0.1, 0.4), 1);
  EXPECT_EQ(light.densest(0.1, 0.6), 3);
}

TEST(LightError, IsTheSlopeTimesTheNoiseOnARamp) {
  const LightError light(
      scene::TransferFunction({{0, {1, 1, 1}, 0}, {0.4, {1, 1, 1}, 0}, {0.41, {1, 1, 1}, 5}, {1, {1, 1, 1}, 5}}),
      scene::Emission::absorption, 1e-6);
  EXPECT_NEAR(light.per_length(std::array{0.3, 0.405}), 500 * 1e-6, 1e-9);
  EXPECT_EQ(light.per_length(std::array{0.5, 0.6}), 0);
}

TEST(EdgeWalk, FindsTheCentresOnAnEdgeAndNoOthers) {
  const SuspicionMap edge(pixels, 1.0f);
  SuspicionMap tie = nothing_suspicious();
  raise_ties({2 * 10.5, 2 * 5.5, 2}, {3 * 10.5, 3 * 40.25, 3}, size, edge, tie);  // a column, in perspective
  int tied = 0;
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      if (!(tie[at(x, y)] > 0.5f)) continue;
      EXPECT_TRUE(x == 10 && y >= 5 && y < 40);
      ++tied;
    }
  EXPECT_EQ(tied, 35);

  tie = nothing_suspicious();
  raise_ties({3.5, 3.5, 1}, {23.5, 13.5, 1}, size, edge, tie);  // a line through every second centre along x
  EXPECT_EQ(std::count_if(tie.begin(), tie.end(), [](float t) { return t > 0.5f; }), 11);

  tie = nothing_suspicious();
  // The second vertex is behind the eye: the line goes from 5.5 down or up.
  raise_ties({10.5, 5.5, 1}, {10.5, -7, -1}, size, edge, tie);
  EXPECT_GT(std::count_if(tie.begin(), tie.end(), [](float t) { return t > 0; }), 0);
  raise_ties({1, 1, -1}, {4, 1, -1}, size, edge, tie);  // behind the eye
}

/// A reference whose rays see a half-plane, right of a line next to the centres of a column.
class HalfPlane final : public RayReference {
 public:
  explicit HalfPlane(double x) : x_(x) {}
  [[nodiscard]] Pixel pixel(double x, double /*y*/) const override {
    Pixel p;
    if (x > x_) p.r = p.g = p.b = p.a = 0.5;
    return p;
  }
  [[nodiscard]] std::vector<Pixel> pixels(std::span<const PixelIndex> wanted, int /*threads*/) const override {
    std::vector<Pixel> result;
    for (const PixelIndex& p : wanted) result.push_back(pixel(p.x + 0.5, p.y + 0.5));
    return result;
  }
  [[nodiscard]] scene::ImageSize size() const override { return suspicion_test::size; }

 private:
  double x_;
};

TEST(Verification, ExcusesSuspectsButLimitsExcusesOfRandomPixels) {
  const HalfPlane reference(20.5 + 1.0 / 3000);  // the centres of column 20 see nothing, those of column 21 everything
  scene::Image image(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 20; x < size.width; ++x)  // column 20 has the other side's colour
      for (std::size_t c = 0; c < 4; ++c) image.rgba[4 * at(x, y) + c] = 0.5f;
  Suspects suspects;
  for (int y = 0; y < size.height; ++y) suspects[static_cast<std::size_t>(Suspicion::tie)].push_back({20, y});
  const Verification found = verify(image, reference, 1e-4, 72, suspects);
  EXPECT_EQ(found.chosen[static_cast<std::size_t>(Suspicion::tie)].excused,
            found.chosen[static_cast<std::size_t>(Suspicion::tie)].pixels);
  EXPECT_GE(found.judgement.excused, 40u);
  EXPECT_EQ(found.judgement.over_bound, found.judgement.excused);
  EXPECT_EQ(found.met(), found.random.excused == 0);
  EXPECT_EQ(found.judgement.max_error_not_excused, 0);
  EXPECT_EQ(found.worst == Suspicion::tie || found.random.excused > 0, true);
  // If all pixels are checked, 48 of 3,072 would be excused, which is too many.
  const Verification all = verify(image, reference, 1e-4, pixels, suspects);
  EXPECT_EQ(all.random.pixels, pixels);
  EXPECT_EQ(all.judgement.excused, 48u);
  EXPECT_FALSE(all.met());

  // A pixel in a column further away is not excused, however it was chosen.
  for (std::size_t c = 0; c < 4; ++c) image.rgba[4 * at(19, 7) + c] = 0.5f;
  suspects[static_cast<std::size_t>(Suspicion::edge)] = {{19, 7}};
  const Verification wrong = verify(image, reference, 1e-4, 72, suspects);
  EXPECT_FALSE(wrong.met());
  EXPECT_NEAR(wrong.judgement.max_error_not_excused, 0.5, 1e-12);
}

}  // namespace
}  // namespace tessera::reference::suspicion_test
