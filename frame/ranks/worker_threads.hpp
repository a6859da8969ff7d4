// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace tessera::frame {

/// A few threads that start tasks in the order of run(). They are separate from oneTBB's threads, because projection on
/// the same rank may occupy all of oneTBB's workers while it waits for the results of these threads.
class WorkerThreads {
 public:
  /// When a task throws, `on_error` is called with the exception on the thread of that task; later tasks still run.
  /// Throws Error(system_failure) if the system does not provide `count` threads.
  WorkerThreads(int count, std::function<void(const std::exception&)> on_error);
  /// Drops tasks that have not begun and waits for tasks that have begun.
  ~WorkerThreads();
  WorkerThreads(const WorkerThreads&) = delete;
  WorkerThreads& operator=(const WorkerThreads&) = delete;

  void run(std::function<void()> task);

 private:
  void work();
  void end();

  std::function<void(const std::exception&)> on_error_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> tasks_;
  bool ending_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace tessera::frame
