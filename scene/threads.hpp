#pragma once

#include <tbb/info.h>

#include <algorithm>

namespace tessera::scene {

/// The number of threads that `asked` asks for: 0 is all cores.
inline int threads_or_cores(int asked) { return asked > 0 ? asked : tbb::info::default_concurrency(); }

/// The same for work that no more threads than cores speed up.
inline int threads_for(int asked) { return std::min(threads_or_cores(asked), tbb::info::default_concurrency()); }

}  // namespace tessera::scene
