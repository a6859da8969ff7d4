// SPDX-License-Identifier: BSD-3-Clause
// Threads of these tests are real ones, on a machine of few cores too: scene::threads_for() gives no more than oneTBB
// does.
#include <tbb/global_control.h>

namespace tessera::frame {
namespace {

const tbb::global_control more_threads_than_cores(tbb::global_control::max_allowed_parallelism, 8);

}  // namespace
}  // namespace tessera::frame
