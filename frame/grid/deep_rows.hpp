// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "exchange/transport.hpp"
#include "frame/grid/deep_grid.hpp"

namespace tessera::frame {

/// Renders the deep image of a volume with all ranks of a job: each rank renders a band of rows, all bands have equal
/// height, and rank 0 joins them. Returns the image on rank 0 and nothing on other ranks. The bits of the image are the
/// same for any number of ranks. Collective. Uses channel `tiles`, after all ranks have finished their earlier messages
/// on this channel. Throws this rank's error, which the caller passes to transport.fail(). Throws scene::FrameStopped
/// on all ranks if `stop` was requested on one of them (StopRelay passes the request to all).
std::optional<scene::DeepImage> deep_rows(exchange::Transport& transport, const scene::SampleSource& source,
                                          const scene::Camera& camera, scene::ImageSize size,
                                          const scene::TransferFunction& function, const DeepSettings& settings,
                                          std::int32_t number, const std::stop_token& stop);

}  // namespace tessera::frame
