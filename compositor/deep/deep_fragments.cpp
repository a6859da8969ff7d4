// SPDX-License-Identifier: BSD-3-Clause
#include "compositor/deep/deep_fragments.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "compositor/deep/deep_pieces.hpp"
#include "scene/error_budget.hpp"

namespace tessera::compositor {
namespace {

/// A piece with less optical depth is treated as light only: its alpha is too small to divide by.
constexpr double least_optical_depth = 1e-30;

double alpha(double optical_depth) { return -std::expm1(-optical_depth); }

}  // namespace

bool DeepMerger::extend(const DeepSample& piece) {
  const double end = piece.back - sample_.front;
  const double joint = sample_.back - sample_.front;
  const double depth = sample_.optical_depth + piece.optical_depth;
  if (depth > most_depth_) return false;
  // The quantity in which light is linear: alpha or, if nothing absorbs, depth.
  const double alpha_at_end = absorbs_ ? alpha(depth) : 0, attenuation = 1 - alpha_;
  const double at_joint = absorbs_ ? alpha_ : joint, at_end = absorbs_ ? alpha_at_end : end;
  double slope_low = slope_low_, slope_high = slope_high_;
  if (absorbs_) {
    const double x = transmittance_error_ / (1 - last_alpha_), width = 2 * x / (2 + x);
    slope_low = std::max(slope_low, (sample_.optical_depth - width) / joint);
    slope_high = std::min(slope_high, (sample_.optical_depth + width) / joint);
    if (!(depth / end >= slope_low && depth / end <= slope_high)) return false;
  }
  std::array<double, 3> light, low = light_low_, high = light_high_;
  for (int c = 0; c < 3; ++c) {
    light[c] = sample_.light[c] + attenuation * piece.light[c];
    low[c] = std::max(low[c], (sample_.light[c] - light_error_) / at_joint);
    high[c] = std::min(high[c], (sample_.light[c] + light_error_) / at_joint);
    if (!(light[c] / at_end >= low[c] && light[c] / at_end <= high[c])) return false;
  }
  if (absorbs_) {
    const double most_light = most_ratio_ * alpha(piece.optical_depth);
    if (piece.light[0] > most_light || piece.light[1] > most_light || piece.light[2] > most_light) return false;
  }
  last_alpha_ = alpha_;
  alpha_ = alpha_at_end;
  sample_.back = piece.back;
  sample_.light = light;
  sample_.optical_depth = depth;
  slope_low_ = slope_low, slope_high_ = slope_high, light_low_ = low, light_high_ = high;
  return true;
}

void DeepMerger::add(const DeepSample& given, std::vector<DeepSample>& samples, bool surface) {
  DeepSample piece = given;
  const double most_light = std::max({piece.light[0], piece.light[1], piece.light[2]});
  const bool absorbs = piece.optical_depth >= least_optical_depth;
  if (!absorbs && most_light == 0) return;
  if (begun_) piece.front = std::max(piece.front, sample_.back), piece.back = std::max(piece.back, piece.front);
  const bool touches = !surface && begun_ && piece.front == sample_.back && sample_.back > sample_.front;
  if (!touches || absorbs != absorbs_ || !extend(piece)) {
    end(samples);
    begun_ = true;
    absorbs_ = absorbs;
    sample_ = piece;
    last_alpha_ = 0;
    alpha_ = absorbs ? alpha(piece.optical_depth) : 0;
    light_error_ = scene::error_budget::deep_merging(accuracy_) / std::max(transmittance_, 1e-300);
    most_ratio_ = absorbs ? std::max(1.0, 2 * most_light / alpha_) : 0;
    most_depth_ = most_optical_depth(accuracy_, transmittance_, most_ratio_);
    transmittance_error_ = light_error_ / (1 + most_ratio_);
    slope_low_ = 0, slope_high_ = std::numeric_limits<double>::infinity();
    light_low_.fill(0), light_high_.fill(std::numeric_limits<double>::infinity());
  }
  transmittance_ *= std::exp(-piece.optical_depth);
}

void DeepMerger::end(std::vector<DeepSample>& samples) {
  if (begun_) samples.push_back(sample_);
  begun_ = false;
}

}  // namespace tessera::compositor
