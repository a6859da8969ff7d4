// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "reference/ray_reference.hpp"
#include "reference/reference.hpp"  // most users need it
#include "scene/image.hpp"

namespace tessera::reference {

/// How far an image deviates from the reference. Errors are absolute differences in linear premultiplied RGBA.
struct Judgement {
  double max_error = 0;              ///< over all pixels checked and all four channels, excused pixels included
  double rms_error = 0;              ///< the same
  double max_error_not_excused = 0;  ///< over all checked pixels without the excused ones
  int worst_x = 0, worst_y = 0;      ///< where max_error is
  std::array<float, 4> worst_value{};
  std::array<double, 4> worst_reference{};
  std::size_t pixels_checked = 0;
  std::size_t over_bound = 0;  ///< pixels with an error above the bound
  std::size_t excused = 0;     ///< number of these that are excused, see judge()
  bool passed = false;         ///< every pixel over the bound is excused, and not too many are
};

/// The result for one pixel.
struct PixelJudgement {
  double error = 0;  ///< largest over its channels
  std::array<float, 4> value{};
  std::array<double, 4> truth{};
  bool over_bound = false, excused = false;
};

/// Compares pixels of an image with the reference, one by one. At most `most_examined` of those over the bound are
/// examined for an excuse, and none after a hundred were not excused; the others count as not excused. Throws like
/// judge().
std::vector<PixelJudgement> judge_each(const scene::Image& image, const RayReference& reference, double bound,
                                       std::span<const PixelIndex> pixels, int threads, std::size_t most_examined);

/// The number of excused pixels allowed in an image of `pixels` pixels, or in a random sample of that size: 1e-4 of
/// them, plus three standard deviations for a sample.
std::size_t most_excused(std::size_t pixels, bool sample);

/// Compares an image with the reference in `pixels`, or everywhere if none are named.
///
/// Excused  The image is discontinuous in the ray at faces of cell data, steps of the transfer function and boundary
///          faces seen edge-on. A pixel over the bound is excused if its value is inside the reference's range over
///          rays within 1/1024 pixel of its centre, widened by the bound: 41 rays, on a grid over that disc and on its
///          circumference. Nothing else is excused.
/// Passed   at most 1e-4 of the pixels are excused. If only some pixels of the image are checked, a sample may have
///          more than its share: three standard deviations are allowed, so one in a thousand pixels still passes. At
///          most a hundred pixels more than may be excused are examined.
/// NaN      or infinity in the image counts as an infinite error and is never excused.
/// Throws   scene::Error(bad_input) if the sizes differ, or a pixel is outside.
Judgement judge(const scene::Image& image, const RayReference& reference, double bound,
                std::span<const PixelIndex> pixels = {}, int threads = 0);

}  // namespace tessera::reference
