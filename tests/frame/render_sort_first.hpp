// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <span>
#include <utility>

#include "frame/grid/sort_first.hpp"
#include "scene/error.hpp"

namespace tessera::frame {

/// Renders a list of images of one volume. Each rank calls this with the same arguments except `done`, which runs on
/// rank 0, in order. Throws the run's error, on every rank.
inline void render_sort_first(exchange::Transport& transport, const Settings& settings, std::span<const VolumeJob> jobs,
                              const scene::TransferFunction& function, volume::Renderer& renderer,
                              const std::function<void(FinishedVolumeFrame)>& done, const FrameSettings& frame = {}) {
  try {
    SortFirst run(transport, settings, frame);
    for (std::size_t number = 0; number < jobs.size(); ++number)
      if (auto finished = run.render(renderer, function, jobs[number], number)) done(std::move(*finished));
  } catch (const scene::Error& error) {
    transport.fail(error);
  }
  transport.check();
}

}  // namespace tessera::frame
