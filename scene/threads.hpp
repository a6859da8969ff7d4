#pragma once

#include <tbb/info.h>

#include <algorithm>

namespace tessera::scene {

/// Threads for work that no more of them than cores speeds up, where `asked` are asked for (0: all cores).
inline int threads_for(int asked) {
  const int cores = tbb::info::default_concurrency();
  return asked > 0 ? std::min(asked, cores) : cores;
}

}  // namespace tessera::scene
