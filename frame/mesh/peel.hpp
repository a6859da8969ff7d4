// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "scene/deep_image.hpp"
#include "scene/image.hpp"
#include "tessera/settings.hpp"
#include "tessera/sink.hpp"

/// Layers of a frame (integrals/ray_layers.hpp) travel as a deep picture does, a sample each: sinks and casters make
/// them in place of its own samples, and the rank that assembles the frame makes images of them.
namespace tessera::frame {

/// Throws Error(system_failure) if half the memory budget does not hold so many images.
void check_peel(const Peel& peel, scene::ImageSize size, std::uint64_t memory_bytes);

/// What is asked for, for messages: `peel` or a deep picture.
inline const char* deep_word(bool peeled) { return peeled ? "`peel`" : "deep picture"; }

/// Image n has the sample n of each pixel.
std::vector<scene::Image> layer_images(const scene::DeepImage& layers, int count);

/// Makes of layers what a deep picture holds: of points at one depth each but the first is moved behind by the least
/// that a float tells.
void make_tidy(scene::DeepImage& layers);

/// Puts what was made in place of a deep picture into its frame, as the settings want it.
void put_deep(scene::DeepImage&& made, const FrameSettings& settings, RenderedFrame& frame);

}  // namespace tessera::frame
