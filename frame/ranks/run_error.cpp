// SPDX-License-Identifier: BSD-3-Clause
#include "frame/ranks/run_error.hpp"

#include <fmt/format.h>

#include <new>

#include "scene/start_thread.hpp"

namespace tessera::frame {

scene::Error run_error(const exchange::Transport& transport, const std::exception& fault) {
  if (const auto* known = dynamic_cast<const scene::Error*>(&fault)) return *known;
  const auto of_this_rank = [&](const std::string& words) {
    return scene::Error(scene::ErrorCode::system_failure,
                        fmt::format("rank {} of {}: {}", transport.rank(), transport.size(), words));
  };
  if (dynamic_cast<const std::bad_alloc*>(&fault) != nullptr)
    return of_this_rank("it needs more memory than is available; use more ranks, or lower `memory`");
  if (const auto of_threads = scene::thread_fault(fault)) return of_this_rank(of_threads->what());
  return of_this_rank(fmt::format("unexpected: {}; please report", fault.what()));
}

}  // namespace tessera::frame
