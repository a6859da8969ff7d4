// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "reference/ray_reference.hpp"
#include "reference/reference.hpp"  // included for users of this header
#include "scene/image.hpp"

namespace tessera::reference {

/// How far an image deviates from the reference. Errors are absolute differences in linear premultiplied RGBA.
struct Judgement {
  double max_error = 0;              ///< over all pixels checked and all four channels, excused pixels included
  double rms_error = 0;              ///< the same
  double max_error_not_excused = 0;  ///< over all checked pixels without the excused ones
  int worst_x = 0, worst_y = 0;      ///< pixel with the error max_error
  std::array<float, 4> worst_value{};
  std::array<double, 4> worst_reference{};
  std::size_t pixels_checked = 0;
  std::size_t over_bound = 0;  ///< number of pixels with an error above the bound
  std::size_t excused = 0;     ///< number of pixels over the bound that are excused; see judge()
  bool passed = false;         ///< every pixel over the bound is excused, and the number of excused pixels is allowed
};

/// The result for one pixel.
struct PixelJudgement {
  double error = 0;  ///< largest error of the pixel's channels
  std::array<float, 4> value{};
  std::array<double, 4> truth{};
  bool over_bound = false, excused = false;
};

/// Compares pixels of an image with the reference, one by one. Of the pixels over the bound, at most `most_examined`
/// are examined for an excuse. Examination also stops when a hundred pixels were not excused. The remaining pixels
/// count as not excused. Throws like judge().
std::vector<PixelJudgement> judge_each(const scene::Image& image, const RayReference& reference, double bound,
                                       std::span<const PixelIndex> pixels, int threads, std::size_t most_examined);

/// Returns the number of excused pixels allowed in an image of `pixels` pixels, or in a random sample of that size: a
/// fraction of 1e-4, plus three standard deviations for a sample.
std::size_t most_excused(std::size_t pixels, bool sample);

/// Compares an image with the reference in `pixels`, or in all pixels if `pixels` is empty.
///
/// Excused  The image as a function of the ray is discontinuous at faces of cell data, steps of the transfer function
///          and boundary faces seen edge-on. A pixel over the bound is excused if its value is inside the range that
///          the reference has for rays within 1/1024 pixel of the pixel's centre, widened by the bound. The 41 rays are
///          on a grid over that disc and on its circumference. No other reason is an excuse.
/// Passed   at most 1e-4 of the pixels are excused. If only some pixels of the image are checked, the random sample may
///          contain more excused pixels than this fraction: three standard deviations are added, so a sample of a
///          thousand pixels may have one. At most a hundred pixels more than the allowed number of excused pixels are
///          examined.
/// NaN      or infinity in the image counts as an infinite error and is never excused.
/// Throws   scene::Error(bad_input) if the sizes differ, or a pixel is outside.
Judgement judge(const scene::Image& image, const RayReference& reference, double bound,
                std::span<const PixelIndex> pixels = {}, int threads = 0);

}  // namespace tessera::reference
