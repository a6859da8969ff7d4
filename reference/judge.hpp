// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "reference/ray_reference.hpp"
#include "reference/reference.hpp"  // what most who judge need
#include "scene/image.hpp"

namespace tessera::reference {

/// How far an image is from the reference. Errors are absolute differences in linear premultiplied RGBA.
struct Judgement {
  double max_error = 0;              ///< over all pixels checked and all four channels, excused pixels included
  double rms_error = 0;              ///< the same
  double max_error_not_excused = 0;  ///< over all pixels checked but the excused ones
  int worst_x = 0, worst_y = 0;      ///< where max_error is
  std::array<float, 4> worst_value{};
  std::array<double, 4> worst_reference{};
  std::size_t pixels_checked = 0;
  std::size_t over_bound = 0;  ///< pixels with an error above the bound
  std::size_t excused = 0;     ///< those of them that are excused, see judge()
  bool passed = false;         ///< every pixel over the bound is excused, and not too many are
};

/// What is found of one pixel.
struct PixelJudgement {
  double error = 0;  ///< largest of its channels
  std::array<float, 4> value{};
  std::array<double, 4> truth{};
  bool over_bound = false, excused = false;
};

/// Compares pixels of an image with the reference, one by one. Of those over the bound no more than `most_examined` are
/// examined for an excuse, and no more once a hundred have none; the others count as not excused. Throws what judge()
/// throws.
std::vector<PixelJudgement> judge_each(const scene::Image& image, const RayReference& reference, double bound,
                                       std::span<const PixelIndex> pixels, int threads, std::size_t most_examined);

/// How many excused pixels a picture may have, or a sample of so many of its pixels taken at random: 1e-4 of them, and
/// in a sample three standard deviations more.
std::size_t most_excused(std::size_t pixels, bool sample);

/// Compares an image with the reference in `pixels`, or everywhere if there are none named.
///
/// Excused  The image is discontinuous in the ray at faces of cell data, steps of the transfer function and boundary
///          faces seen edge-on. A pixel over the bound is excused if its value lies inside the reference's range over
///          rays within 1/1024 pixel of its centre, widened by the bound: 41 rays, on a grid over that disc and on its
///          rim. Nothing else is excused.
/// Passed   at most 1e-4 of the pixels excused. If only some pixels of the image are checked, a sample may hold more
///          than its share: three standard deviations are granted, so one in a thousand pixels still passes.
///          Once so many are over the bound that the image has failed anyway, only the first hundred more are
///          examined for an excuse.
/// NaN      or infinity in the image counts as an infinite error, never excused.
/// Throws   scene::Error(bad_input) if the sizes differ, or a pixel lies outside.
Judgement judge(const scene::Image& image, const RayReference& reference, double bound,
                std::span<const PixelIndex> pixels = {}, int threads = 0);

}  // namespace tessera::reference
