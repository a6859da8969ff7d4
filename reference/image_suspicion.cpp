// SPDX-License-Identifier: BSD-3-Clause
#include "reference/image_suspicion.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <map>

#include "scene/threads.hpp"

namespace tessera::reference {
namespace {

using Colour = std::array<float, 4>;
constexpr float broken = 1e30f;  // score of pixels that are not finite

class Picture {
 public:
  explicit Picture(const scene::Image& image) : image_(image) {}

  [[nodiscard]] bool has(int x, int y) const { return x >= 0 && y >= 0 && x < width() && y < height(); }
  [[nodiscard]] int width() const { return image_.size.width; }
  [[nodiscard]] int height() const { return image_.size.height; }
  [[nodiscard]] std::size_t index(int x, int y) const { return image_.index(x, y); }
  [[nodiscard]] Colour at(int x, int y) const {
    const float* const p = &image_.rgba[4 * image_.index(x, y)];
    return {p[0], p[1], p[2], p[3]};
  }

  /// Returns the largest difference to a neighbour.
  [[nodiscard]] float edge(int x, int y) const {
    const Colour here = at(x, y);
    float largest = 0;
    for (const float c : here)
      if (!std::isfinite(c)) return broken;
    for (int j = -1; j <= 1; ++j)
      for (int i = -1; i <= 1; ++i) {
        if (!has(x + i, y + j)) continue;
        const Colour there = at(x + i, y + j);
        for (std::size_t c = 0; c < 4; ++c)
          if (const float d = std::abs(here[c] - there[c]); d > largest) largest = d;
      }
    return largest;
  }

  struct Misfit {
    float least = 0;  ///< smallest over the directions
    float alike = 0;  ///< ratio of mean to spread, which is high if the directions agree and the neighbours are smooth
  };

  /// Returns the deviation of the pixel from the cubic through its four neighbours along a line, for four directions.
  /// Along a straight edge, the smallest of the four deviations is small; for a single wrong pixel, all four are
  /// similar. Differences up to `least` are negligible.
  [[nodiscard]] Misfit misfit(int x, int y, float least) const {
    constexpr std::array<std::array<int, 2>, 4> directions{{{1, 0}, {0, 1}, {1, 1}, {1, -1}}};
    std::array<Colour, 4> off{};
    Colour bend{};  // third difference of the neighbours, without the pixel: nonzero at a step, but not around a single
                    // wrong pixel
    std::size_t count = 0;
    Misfit misfit{std::numeric_limits<float>::infinity(), 0};
    for (const auto& [i, j] : directions) {
      if (!has(x - 2 * i, y - 2 * j) || !has(x + 2 * i, y + 2 * j)) continue;
      const Colour a = at(x - 2 * i, y - 2 * j), b = at(x - i, y - j), here = at(x, y), c = at(x + i, y + j),
                   d = at(x + 2 * i, y + 2 * j);
      float largest = 0;
      for (std::size_t n = 0; n < 4; ++n) {
        off[count][n] = here[n] - (4 * (b[n] + c[n]) - (a[n] + d[n])) / 6;
        largest = std::max(largest, std::abs(off[count][n]));
        bend[n] = std::max(bend[n], std::abs(c[n] - b[n] - (d[n] - a[n]) / 2));
      }
      if (!(largest > least)) return {largest, 0};
      ++count;
      misfit.least = std::min(misfit.least, largest);
    }
    if (!std::isfinite(misfit.least)) return {};
    for (std::size_t n = 0; n < 4 && count > 1; ++n) {
      // At a step, bend and misfit are equal; with a quarter of the bend, the ratio stays below four at a step. An
      // image that varies smoothly with wave number k has a bend of k^3 times its amplitude, so the full bend would
      // hide larger errors.
      float mean = 0, spread = bend[n] / 4;
      for (std::size_t i = 0; i < count; ++i) mean += off[i][n] / static_cast<float>(count);
      for (std::size_t i = 0; i < count; ++i) spread = std::max(spread, std::abs(off[i][n] - mean));
      misfit.alike = std::max(misfit.alike, std::abs(mean) / (spread + least / 4));
    }
    return misfit;
  }

  /// Returns the jump across one side of a 4x4 block, averaged over the side: the difference of the two pixels at the
  /// side minus the mean of the slopes on both sides. The side begins at (x, y) and has the direction (along_x,
  /// along_y); the pixels of the block are in the direction (in_x, in_y).
  [[nodiscard]] float jump(int x, int y, int along_x, int along_y, int in_x, int in_y) const {
    Colour sum{};
    for (int n = 0; n < 4; ++n) {
      const int px = x + n * along_x, py = y + n * along_y;
      if (!has(px - 2 * in_x, py - 2 * in_y) || !has(px + in_x, py + in_y)) return 0;
      const Colour a = at(px - 2 * in_x, py - 2 * in_y), b = at(px - in_x, py - in_y), c = at(px, py),
                   d = at(px + in_x, py + in_y);
      for (std::size_t i = 0; i < 4; ++i) sum[i] += (c[i] - b[i] - (d[i] - c[i] + b[i] - a[i]) / 2) / 4;
    }
    float largest = 0;
    for (const float s : sum) largest = std::max(largest, std::abs(s));
    return largest;
  }

  /// Returns the score of the block whose first pixel is (x, y).
  [[nodiscard]] float block(int x, int y) const {
    std::array<float, 4> sides{jump(x, y, 0, 1, 1, 0), jump(x + 3, y, 0, 1, -1, 0), jump(x, y, 1, 0, 0, 1),
                               jump(x, y + 3, 1, 0, 0, -1)};
    std::sort(sides.begin(), sides.end());
    return sides[2];
  }

 private:
  const scene::Image& image_;
};

/// Returns the pixel's misfit relative to the median misfit on a surrounding ring, which the pixel does not affect.
/// Needed because an image is rough in one place and smooth in another.
float standing_out(const SuspicionMap& misfit, const Picture& picture, int x, int y, float least) {
  constexpr int reach = 4, step = 2;
  std::array<float, 16> ring{};
  std::size_t count = 0;
  for (int j = -reach; j <= reach; j += step)
    for (int i = -reach; i <= reach; i += step)
      if (std::max(std::abs(i), std::abs(j)) == reach && picture.has(x + i, y + j))
        ring[count++] = misfit[picture.index(x + i, y + j)];
  std::nth_element(ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(count / 2),
                   ring.begin() + static_cast<std::ptrdiff_t>(count));
  constexpr float most = 32;  // larger values carry no more information
  return std::min(most, misfit[picture.index(x, y)] / (least + (count == 0 ? 0 : ring[count / 2])));
}

/// Marks one pixel of each colour that fills at least 3x3 pixels.
SuspicionMap plateaus(const Picture& picture) {
  struct Plateau {
    float pixels = 0;
    std::size_t at = 0;
    double hash = 2;
  };
  std::map<std::array<std::uint32_t, 4>, Plateau> plateaus;
  for (int y = 1; y + 1 < picture.height(); ++y)
    for (int x = 1; x + 1 < picture.width(); ++x) {
      const Colour here = picture.at(x, y);
      bool flat = true;
      for (int n = 0; n < 9 && flat; ++n) flat = picture.at(x - 1 + n % 3, y - 1 + n / 3) == here;
      if (!flat) continue;
      Plateau& plateau = plateaus[std::bit_cast<std::array<std::uint32_t, 4>>(here)];
      ++plateau.pixels;
      const std::size_t at = picture.index(x, y);
      if (const double hash = hashed(at, 4); hash < plateau.hash) plateau.at = at, plateau.hash = hash;
    }
  SuspicionMap map(static_cast<std::size_t>(picture.width()) * static_cast<std::size_t>(picture.height()), 0.0f);
  for (const auto& [colour, plateau] : plateaus) map[plateau.at] = plateau.pixels;
  return map;
}

}  // namespace

ImageSuspicion suspect(const scene::Image& image, double least, int threads) {
  const Picture picture(image);
  const std::size_t pixels = image.depth.size();
  const auto floor = static_cast<float>(least);
  ImageSuspicion result;
  for (SuspicionMap* map : {&result.edge, &result.outlier, &result.block}) map->assign(pixels, 0.0f);
  SuspicionMap misfit(pixels), alike(pixels);
  const auto for_all = [&](int step, const auto& score) {
    tbb::parallel_for(0, (picture.height() + step - 1) / step, [&](int row) {
      for (int x = 0; x < picture.width(); x += step) score(x, row * step);
    });
  };
  tbb::task_arena arena(scene::threads_for(threads));
  arena.execute([&] {
    for_all(1, [&](int x, int y) {
      const float edge = picture.edge(x, y);
      if (!(edge > floor)) return;
      result.edge[picture.index(x, y)] = edge;
      const Picture::Misfit off = picture.misfit(x, y, floor);
      misfit[picture.index(x, y)] = off.least;
      alike[picture.index(x, y)] = off.alike;
    });
    for_all(1, [&](int x, int y) {
      if (misfit[picture.index(x, y)] > floor)
        result.outlier[picture.index(x, y)] =
            standing_out(misfit, picture, x, y, floor) * (1 + alike[picture.index(x, y)] * alike[picture.index(x, y)]);
    });
    for_all(4, [&](int x, int y) {
      const float score = picture.block(x, y);
      if (!(score > floor)) return;
      const double hash = hashed(picture.index(x, y), 5);
      const int n = static_cast<int>(16 * hash);
      result.block[picture.index(std::min(x + n % 4, picture.width() - 1), std::min(y + n / 4, picture.height() - 1))] =
          score;
    });
    result.plateau = plateaus(picture);
  });
  return result;
}

}  // namespace tessera::reference
