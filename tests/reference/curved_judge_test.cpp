// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "reference/curved_cells.hpp"
#include "reference/judge.hpp"
#include "reference/small_meshes.hpp"

namespace tessera::reference::curved_judge_test {
namespace {

using scene::TransferFunction;

/// A reference whose image is shifted, so that pixel centres can be placed anywhere.
class Moved final : public RayReference {
 public:
  Moved(const RayReference& of, double right, double down) : of_(&of), right_(right), down_(down) {}
  [[nodiscard]] Pixel pixel(double x, double y) const override { return of_->pixel(x + right_, y + down_); }
  [[nodiscard]] std::vector<Pixel> pixels(std::span<const PixelIndex> wanted, int) const override {
    std::vector<Pixel> result;
    for (const PixelIndex& p : wanted) result.push_back(pixel(p.x + 0.5, p.y + 0.5));
    return result;
  }
  [[nodiscard]] scene::ImageSize size() const override { return of_->size(); }

 private:
  const RayReference* of_;
  double right_, down_;
};

/// One dense cell with a round silhouette.
struct RoundCell {
  CurvedMesh mesh;
  scene::ImageSize size{128, 128};
  RoundCell() {
    TypeCase type{"", 29, 27, {}, 2};
    mesh.add(
        type,
        [](const glm::dvec3& p) {
          const glm::dvec3 q = 2.0 * p - 1.0;
          return q * (1.25 - 0.1 * (q.x * q.x + q.y * q.y + q.z * q.z));
        },
        [](const glm::dvec3& p) { return p.x; });
  }
  [[nodiscard]] CurvedReference reference() const {
    return {mesh.cells(), looking({1, 2, 5}, {0, 0, 0}, scene::ProjectionKind::perspective, 36), size,
            TransferFunction({{0, {1, 0.5, 0.2}, 20}, {1, {0.5, 1, 0.5}, 30}})};
  }
};

void set(scene::Image& image, PixelIndex at, const Pixel& p) {
  const double rgba[4] = {p.r, p.g, p.b, p.a};
  for (std::size_t c = 0; c < 4; ++c) image.rgba[4 * image.index(at.x, at.y) + c] = static_cast<float>(rgba[c]);
}

/// Ten rows in the middle of the image. In a sample of this many pixels, one pixel may be excused.
std::vector<PixelIndex> middle_rows() {
  std::vector<PixelIndex> pixels;
  for (int y = 60; y < 70; ++y)
    for (int x = 0; x < 128; ++x) pixels.push_back({x, y});
  return pixels;
}

scene::Image image_of(const RayReference& reference, std::span<const PixelIndex> wanted) {
  scene::Image image(reference.size());
  const std::vector<Pixel> pixels = reference.pixels(wanted);
  for (std::size_t i = 0; i < wanted.size(); ++i) set(image, wanted[i], pixels[i]);
  return image;
}

TEST(CurvedJudge, AnImageOfCurvedCellsRoundedToFloatPasses) {
  const RoundCell cell;
  const CurvedReference reference = cell.reference();
  const std::vector<PixelIndex> wanted = middle_rows();
  const Judgement judgement = judge(image_of(reference, wanted), reference, 1e-7, wanted);
  EXPECT_TRUE(judgement.passed);
  EXPECT_EQ(judgement.over_bound, 0u);
  EXPECT_LE(judgement.max_error, 6e-8);  // half a unit in float's last place below two
}

TEST(CurvedJudge, ExcusesARoundSilhouetteOnlyWithinAThousandthOfAPixel) {
  const RoundCell cell;
  const CurvedReference reference = cell.reference();
  // Finds where a row leaves the cell, between a ray that meets the cell and one that does not.
  const double y = 64.37;
  double in = 64, out = 128;
  ASSERT_GT(reference.pixel(in, y).length, 0);
  ASSERT_EQ(reference.pixel(out, y).length, 0);
  while (out - in > 1e-9) {
    const double middle = (in + out) / 2;
    (reference.pixel(middle, y).length > 0 ? in : out) = middle;
  }
  // The silhouette is round there: the length of a ray in the cell grows with the square root of the ray's distance
  // to the silhouette.
  const double near = reference.pixel(in - 1e-6, y).length, farther = reference.pixel(in - 4e-6, y).length;
  EXPECT_NEAR(farther / near, 2, 0.01);  // the edge is known to 1e-9

  // The centre of the pixel is a quarter of the excusing distance outside the cell.
  constexpr double excusing = 1.0 / 1024, bound = 1e-4;
  const PixelIndex at{static_cast<int>(in), static_cast<int>(y)};
  const Moved moved(reference, in + excusing / 4 - (at.x + 0.5), y - (at.y + 0.5));
  const std::vector<PixelIndex> wanted = middle_rows();
  const scene::Image right = image_of(moved, wanted);
  EXPECT_TRUE(judge(right, moved, bound, wanted).passed);
  for (const auto& [distance, excused] : {std::pair{0.5, true}, {0.9, true}, {2.0, false}, {16.0, false}}) {
    scene::Image image = right;
    set(image, at, moved.pixel(at.x + 0.5 - distance * excusing, at.y + 0.5));
    const Judgement judgement = judge(image, moved, bound, wanted);
    EXPECT_EQ(judgement.over_bound, 1u) << distance;
    EXPECT_EQ(judgement.excused, excused ? 1u : 0u) << distance;
    EXPECT_EQ(judgement.passed, excused) << distance;
  }
}

}  // namespace
}  // namespace tessera::reference::curved_judge_test
