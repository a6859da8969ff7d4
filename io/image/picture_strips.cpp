// SPDX-License-Identifier: BSD-3-Clause
#include "io/image/picture_strips.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <exception>
#include <vector>

#include "scene/threads.hpp"

namespace tessera::io {

void for_each_strip(int height, int rows, int threads, const std::function<void(std::size_t, int, int)>& make) {
  std::vector<std::exception_ptr> thrown(static_cast<std::size_t>((height + rows - 1) / rows));
  tbb::task_arena arena(scene::threads_for(threads));
  arena.execute([&] {
    tbb::parallel_for(std::size_t{0}, thrown.size(), [&](std::size_t strip) {
      try {
        const int begin = static_cast<int>(strip) * rows;
        make(strip, begin, std::min(begin + rows, height));
      } catch (...) {
        thrown[strip] = std::current_exception();
      }
    });
  });
  for (const std::exception_ptr& error : thrown)
    if (error) std::rethrow_exception(error);
}

}  // namespace tessera::io
