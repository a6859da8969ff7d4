// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "exchange/transport.hpp"
#include "frame/grid/deep_grid.hpp"

namespace tessera::frame {

/// The deep picture of a volume by all ranks of a job: each makes a band of as many rows, rank 0 puts them one below
/// the other. The picture on rank 0, nothing elsewhere; the same bits for any number of ranks. Collective; on channel
/// `tiles`, and begins when all ranks are done with what was on it. Throws this rank's error, which the caller gives to
/// transport.fail(), or scene::FrameStopped on all ranks if one of them saw `stop` (which StopRelay carries to all).
std::optional<scene::DeepImage> deep_rows(exchange::Transport& transport, const scene::SampleSource& source,
                                          const scene::Camera& camera, scene::ImageSize size,
                                          const scene::TransferFunction& function, const DeepSettings& settings,
                                          std::int32_t number, const std::stop_token& stop);

}  // namespace tessera::frame
