#include "reference/judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "scene/error.hpp"

namespace tessera::reference {
namespace {

constexpr double excusing_distance = 1.0 / 1024;  // pixel
constexpr double excusable_share = 1e-4;          // of the pixels

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

/// Offsets of the rays around a pixel's centre: a grid over the disc, and its rim.
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

Judgement judge(const scene::Image& image, const RayReference& reference, double bound,
                std::span<const PixelIndex> pixels, int threads) {
  const scene::ImageSize size = reference.size();
  if (image.size != size)
    throw scene::bad_input(fmt::format("judge: the image is {}x{}, its reference {}x{}; render both at one size",
                                       image.size.width, image.size.height, size.width, size.height));
  for (const PixelIndex& p : pixels)
    if (p.x < 0 || p.y < 0 || p.x >= size.width || p.y >= size.height)
      throw scene::bad_input(
          fmt::format("judge: pixel ({}, {}) lies outside the {}x{} image", p.x, p.y, size.width, size.height));
  std::vector<PixelIndex> everywhere;
  if (pixels.empty()) {
    everywhere = all_pixels(size);
    pixels = everywhere;
  }

  const std::vector<Pixel> truths = reference.pixels(pixels, threads);
  Judgement judgement;
  judgement.pixels_checked = pixels.size();
  double sum_of_squares = 0;
  std::vector<std::size_t> over_bound;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const std::array<double, 4> truth = rgba(truths[i]);
    const std::array<float, 4> value = rgba(image, pixels[i]);
    const double error = largest_difference(value, truth);
    for (int c = 0; c < 4; ++c) sum_of_squares += (value[c] - truth[c]) * (value[c] - truth[c]);
    if (i == 0 || error > judgement.max_error) {
      judgement.max_error = error;
      judgement.worst_x = pixels[i].x, judgement.worst_y = pixels[i].y;
      judgement.worst_value = value, judgement.worst_reference = truth;
    }
    if (error > bound)
      over_bound.push_back(i);
    else
      judgement.max_error_not_excused = std::max(judgement.max_error_not_excused, error);
  }
  judgement.rms_error = std::sqrt(sum_of_squares / (4 * static_cast<double>(pixels.size())));

  const double share = excusable_share * static_cast<double>(pixels.size());
  const bool sample = pixels.size() < image.depth.size();
  const auto most_excused = static_cast<std::size_t>(sample ? share + 3 * std::sqrt(share) : share);
  judgement.over_bound = over_bound.size();
  for (std::size_t n = 0; n < over_bound.size(); ++n) {
    const PixelIndex at = pixels[over_bound[n]];
    const std::array<float, 4> value = rgba(image, at);
    if (n < most_excused + 100 && excusable(value, reference, at, bound))
      ++judgement.excused;
    else
      judgement.max_error_not_excused =
          std::max(judgement.max_error_not_excused, largest_difference(value, rgba(truths[over_bound[n]])));
  }
  judgement.passed = judgement.over_bound == judgement.excused && judgement.excused <= most_excused;
  return judgement;
}

}  // namespace tessera::reference
