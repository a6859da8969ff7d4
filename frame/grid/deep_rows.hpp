// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "exchange/transport.hpp"
#include "frame/grid/deep_grid.hpp"

namespace tessera::frame {

/// The deep image of a volume, rendered by all ranks of a job: each renders a band of rows of equal height, and rank 0
/// joins the bands. Returns the image on rank 0, nothing on others; the same bits for any number of ranks. Collective.
/// Uses channel `tiles`, after all ranks have finished their earlier messages on it. Throws this rank's error, which
/// the caller passes to transport.fail(), or scene::FrameStopped on all ranks if `stop` reached one of them (StopRelay
/// passes it to all).
std::optional<scene::DeepImage> deep_rows(exchange::Transport& transport, const scene::SampleSource& source,
                                          const scene::Camera& camera, scene::ImageSize size,
                                          const scene::TransferFunction& function, const DeepSettings& settings,
                                          std::int32_t number, const std::stop_token& stop);

}  // namespace tessera::frame
