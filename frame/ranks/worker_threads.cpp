// SPDX-License-Identifier: BSD-3-Clause
#include "frame/ranks/worker_threads.hpp"

#include "scene/start_thread.hpp"

namespace tessera::frame {

WorkerThreads::WorkerThreads(int count, std::function<void(const std::exception&)> on_error)
    : on_error_(std::move(on_error)) {
  try {
    for (int i = 0; i < count; ++i) threads_.push_back(scene::start_thread([this] { work(); }));
  } catch (...) {  // the destructor does not run after an exception here, so threads that have started must end now
    end();
    throw;
  }
}

WorkerThreads::~WorkerThreads() { end(); }

void WorkerThreads::end() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
    tasks_.clear();
  }
  changed_.notify_all();
  for (auto& thread : threads_) thread.join();
}

void WorkerThreads::run(std::function<void()> task) {
  {
    const std::lock_guard lock(mutex_);
    tasks_.push_back(std::move(task));
  }
  changed_.notify_one();
}

void WorkerThreads::work() {
  for (;;) {
    std::function<void()> task;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return ending_ || !tasks_.empty(); });
      if (ending_) return;
      task = std::move(tasks_.front());
      tasks_.pop_front();
    }
    try {
      task();
    } catch (const std::exception& error) {
      on_error_(error);
    }
  }
}

}  // namespace tessera::frame
