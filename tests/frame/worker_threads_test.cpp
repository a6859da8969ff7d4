// SPDX-License-Identifier: BSD-3-Clause
#include "frame/ranks/worker_threads.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <new>
#include <stdexcept>
#include <string>
#include <thread>

#include "scene/error.hpp"
#include "scene/start_thread.hpp"

namespace tessera::frame::worker_threads_test {
namespace {

TEST(WorkerThreads, RunAllTasksAndForwardTheirExceptions) {
  std::atomic<int> done = 0, failed = 0;
  {
    WorkerThreads workers(3, [&](const std::exception&) { ++failed; });
    for (int i = 0; i < 300; ++i)
      workers.run([&, i] {
        ++done;
        if (i % 3 == 0) throw std::runtime_error("a third");
      });
    while (done < 300) std::this_thread::yield();
  }
  EXPECT_EQ(failed, 100);
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // sanitizers take all address space

/// Leaves this process enough memory for a few threads.
void limit_memory() {
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const rlim_t bytes = pages * 4096 + (rlim_t{48} << 20);
  const rlimit limit{bytes, bytes};
  setrlimit(RLIMIT_AS, &limit);
}

/// Ends the process with 7 if `start` throws an error for the user.
template <class Start>
void judge(const Start& start) {
  limit_memory();
  try {
    start();
  } catch (const scene::Error& error) {
    const bool has_remedy = std::string(error.what()).find("lower `threads`") != std::string::npos;
    std::_Exit(error.code() == scene::ErrorCode::system_failure && has_remedy ? 7 : 1);
  }
  std::_Exit(0);
}

TEST(WorkerThreadsDeathTest, RefusedByTheSystemAreAnErrorWithARemedy) {
  ::testing::GTEST_FLAG(death_test_style) = "threadsafe";
  EXPECT_EXIT(judge([] { const WorkerThreads workers(64, [](const std::exception&) {}); }),
              ::testing::ExitedWithCode(7), "");
}

#endif

TEST(StartThread, RecognizesExceptionsOfLibrariesThatRunOutOfThreads) {
  const std::system_error of_std(std::make_error_code(std::errc::resource_unavailable_try_again));
  const std::runtime_error of_tbb("pthread_create has failed: Resource temporarily unavailable");
  EXPECT_TRUE(scene::thread_fault(of_std).has_value());
  EXPECT_TRUE(scene::thread_fault(of_tbb).has_value());
  EXPECT_FALSE(scene::thread_fault(std::runtime_error("something else")).has_value());
  EXPECT_FALSE(scene::thread_fault(std::bad_alloc()).has_value());
}

}  // namespace
}  // namespace tessera::frame::worker_threads_test
