// SPDX-License-Identifier: BSD-3-Clause
// These tests use several threads even on a machine with few cores: scene::threads_for() does not exceed oneTBB's
// limit.
#include <tbb/global_control.h>

namespace tessera::frame {
namespace {

const tbb::global_control more_threads_than_cores(tbb::global_control::max_allowed_parallelism, 8);

}  // namespace
}  // namespace tessera::frame
