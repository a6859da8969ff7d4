// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace tessera::scene {

/// Returns the number of threads that are used if `asked` are requested; 0 requests all cores. The result is at most
/// the number of threads that oneTBB allows this process: its cores, unless the caller has set a tbb::global_control.
/// oneTBB prints a warning on stderr for a larger arena, and more threads than cores are never faster here.
inline int threads_for(int asked) {
  const auto most = static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
  return std::min(asked > 0 ? asked : tbb::info::default_concurrency(), most);
}

/// Runs `work`, with everything that it does in parallel, on threads_for(asked) threads.
template <class Work>
auto with_threads(int asked, const Work& work) {
  return tbb::task_arena(threads_for(asked)).execute(work);
}

}  // namespace tessera::scene
