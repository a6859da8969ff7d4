// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tbb/global_control.h>
#include <tbb/info.h>

#include <algorithm>

namespace tessera::scene {

/// How many threads work gets that asks for so many; 0 asks for all cores. No more than oneTBB gives this process: its
/// cores, unless a tbb::global_control of the caller's says otherwise. oneTBB warns on stderr of an arena that asks for
/// more, and no work here gains by more threads than cores.
inline int threads_for(int asked) {
  const auto most = static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
  return std::min(asked > 0 ? asked : tbb::info::default_concurrency(), most);
}

}  // namespace tessera::scene
