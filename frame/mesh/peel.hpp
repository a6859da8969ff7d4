// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "scene/deep_image.hpp"
#include "scene/image.hpp"
#include "tessera/settings.hpp"
#include "tessera/sink.hpp"

/// Layers of a frame (integrals/ray_layers.hpp) are transported like a deep image, one sample each: sinks and casters
/// make them instead of its samples, and the rank that assembles the frame makes images from them.
namespace tessera::frame {

/// Throws Error(system_failure) if half the memory budget does not hold this number of images.
void check_peel(const Peel& peel, scene::ImageSize size, std::uint64_t memory_bytes);

/// The name of the requested result in messages: `peel` or "deep picture".
inline const char* deep_word(bool peeled) { return peeled ? "`peel`" : "deep image"; }

/// Image n contains sample n of each pixel.
std::vector<scene::Image> layer_images(const scene::DeepImage& layers, int count);

/// Makes layers valid samples of a deep image: if several points have the same depth, each after the first moves behind
/// the previous one by the smallest difference of floats.
void make_tidy(scene::DeepImage& layers);

/// Stores the result of a deep pass in its frame, according to the settings.
void put_deep(scene::DeepImage&& made, const FrameSettings& settings, RenderedFrame& frame);

}  // namespace tessera::frame
