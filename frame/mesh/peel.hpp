// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "scene/deep_image.hpp"
#include "scene/image.hpp"
#include "tessera/settings.hpp"
#include "tessera/sink.hpp"

/// Layers of a frame (integrals/ray_layers.hpp) are transported like a deep image whose samples are the layers. Sinks
/// and casters produce layers instead of samples, and the rank that assembles the frame makes one image of each layer.
namespace tessera::frame {

/// Throws Error(system_failure) if this number of images does not fit in half of the memory budget.
void check_peel(const Peel& peel, scene::ImageSize size, std::uint64_t memory_bytes);

/// The name of the requested result in messages.
inline const char* deep_word(bool peeled) { return peeled ? "`peel`" : "deep image"; }

/// Returns `count` images; image n contains sample n of each pixel.
std::vector<scene::Image> layer_images(const scene::DeepImage& layers, int count);

/// Makes layers valid samples of a deep image. If several samples of a pixel have the same depth, each of them after
/// the first is moved behind the previous one by the smallest difference between floats.
void make_tidy(scene::DeepImage& layers);

/// Stores the result of a deep pass in its frame, as a deep image or as layers, depending on the settings.
void put_deep(scene::DeepImage&& made, const FrameSettings& settings, RenderedFrame& frame);

}  // namespace tessera::frame
