// SPDX-License-Identifier: BSD-3-Clause
#include "reference/judge.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "scene/error.hpp"
#include "scene/threads.hpp"

namespace tessera::reference {
namespace {

constexpr double excusing_distance = 1.0 / 1024;  // pixel
constexpr double excusable_share = 1e-4;          // fraction of the pixels

std::array<double, 4> rgba(const Pixel& p) { return {p.r, p.g, p.b, p.a}; }

std::array<float, 4> rgba(const scene::Image& image, PixelIndex at) {
  std::array<float, 4> value;
  for (std::size_t i = 0; i < 4; ++i) value[i] = image.rgba[4 * image.index(at.x, at.y) + i];
  return value;
}

double largest_difference(const std::array<float, 4>& value, const std::array<double, 4>& truth) {
  double largest = 0;
  for (int i = 0; i < 4; ++i) {
    if (!std::isfinite(value[i])) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, std::abs(value[i] - truth[i]));
  }
  return largest;
}

/// Offsets of the rays around a pixel's centre: a grid over the disc, and its circumference.
std::vector<std::array<double, 2>> nearby_offsets() {
  std::vector<std::array<double, 2>> offsets;
  constexpr int half = 2;
  for (int j = -half; j <= half; ++j)
    for (int i = -half; i <= half; ++i) offsets.push_back({excusing_distance * i / half, excusing_distance * j / half});
  std::erase_if(offsets, [](const auto& o) { return std::hypot(o[0], o[1]) > excusing_distance; });
  constexpr int rim = 28;
  for (int i = 0; i < rim; ++i) {
    const double angle = 2 * std::numbers::pi * (i + 0.5) / rim;
    offsets.push_back({excusing_distance * std::cos(angle), excusing_distance * std::sin(angle)});
  }
  return offsets;
}

bool excusable(const std::array<float, 4>& value, const RayReference& reference, PixelIndex at, double bound) {
  std::array<double, 4> low, high;
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(-std::numeric_limits<double>::infinity());
  for (const auto& [dx, dy] : nearby_offsets()) {
    const std::array<double, 4> truth = rgba(reference.pixel(at.x + 0.5 + dx, at.y + 0.5 + dy));
    for (int i = 0; i < 4; ++i) low[i] = std::min(low[i], truth[i]), high[i] = std::max(high[i], truth[i]);
  }
  for (int i = 0; i < 4; ++i)
    if (!(low[i] - bound <= value[i] && value[i] <= high[i] + bound)) return false;
  return true;
}

}  // namespace

std::vector<PixelJudgement> judge_each(const scene::Image& image, const RayReference& reference, double bound,
                                       std::span<const PixelIndex> pixels, int threads, std::size_t most_examined) {
  const scene::ImageSize size = reference.size();
  if (image.size != size)
    throw scene::bad_input(fmt::format("judge: the image is {}x{}, its reference {}x{}; render both at one size",
                                       image.size.width, image.size.height, size.width, size.height));
  for (const PixelIndex& p : pixels)
    if (p.x < 0 || p.y < 0 || p.x >= size.width || p.y >= size.height)
      throw scene::bad_input(
          fmt::format("judge: pixel ({}, {}) is outside the {}x{} image", p.x, p.y, size.width, size.height));
  const std::vector<Pixel> truths = reference.pixels(pixels, threads);
  std::vector<PixelJudgement> judged(pixels.size());
  std::vector<std::size_t> over_bound;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    PixelJudgement& pixel = judged[i];
    pixel.value = rgba(image, pixels[i]), pixel.truth = rgba(truths[i]);
    pixel.error = largest_difference(pixel.value, pixel.truth);
    pixel.over_bound = pixel.error > bound;
    if (pixel.over_bound) over_bound.push_back(i);
  }

  constexpr std::size_t enough = 100, together = 64;
  over_bound.resize(std::min(over_bound.size(), most_examined));
  tbb::task_arena arena(scene::threads_for(threads));
  std::size_t without_excuse = 0;
  for (std::size_t begin = 0; begin < over_bound.size() && without_excuse < enough; begin += together) {
    const std::size_t end = std::min(begin + together, over_bound.size());
    arena.execute([&] {
      tbb::parallel_for(begin, end, [&](std::size_t n) {
        PixelJudgement& pixel = judged[over_bound[n]];
        pixel.excused = excusable(pixel.value, reference, pixels[over_bound[n]], bound);
      });
    });
    for (std::size_t n = begin; n < end; ++n) without_excuse += judged[over_bound[n]].excused ? 0 : 1;
  }
  return judged;
}

std::size_t most_excused(std::size_t pixels, bool sample) {
  const double share = excusable_share * static_cast<double>(pixels);
  return static_cast<std::size_t>(sample ? share + 3 * std::sqrt(share) : share);
}

Judgement judge(const scene::Image& image, const RayReference& reference, double bound,
                std::span<const PixelIndex> pixels, int threads) {
  std::vector<PixelIndex> everywhere;
  if (pixels.empty()) {
    everywhere = all_pixels(reference.size());
    pixels = everywhere;
  }
  const std::size_t most = most_excused(pixels.size(), pixels.size() < image.depth.size());
  Judgement judgement;
  judgement.pixels_checked = pixels.size();
  double sum_of_squares = 0;
  const std::vector<PixelJudgement> judged = judge_each(image, reference, bound, pixels, threads, most + 100);
  for (std::size_t i = 0; i < judged.size(); ++i) {
    const PixelJudgement& pixel = judged[i];
    for (std::size_t c = 0; c < 4; ++c)
      sum_of_squares += (pixel.value[c] - pixel.truth[c]) * (pixel.value[c] - pixel.truth[c]);
    if (i == 0 || pixel.error > judgement.max_error) {
      judgement.max_error = pixel.error;
      judgement.worst_x = pixels[i].x, judgement.worst_y = pixels[i].y;
      judgement.worst_value = pixel.value, judgement.worst_reference = pixel.truth;
    }
    judgement.over_bound += pixel.over_bound ? 1 : 0;
    judgement.excused += pixel.excused ? 1 : 0;
    if (!pixel.excused) judgement.max_error_not_excused = std::max(judgement.max_error_not_excused, pixel.error);
  }
  judgement.rms_error = std::sqrt(sum_of_squares / (4 * static_cast<double>(judged.size())));
  judgement.passed = judgement.over_bound == judgement.excused && judgement.excused <= most;
  return judgement;
}

}  // namespace tessera::reference
